"""Relations are put into each other while they stay short; forms that are not known say nothing."""

from __future__ import annotations

from dofkit.configuration.cases import MAX_NODES, _linear
from dofkit.configuration.local.initial_forms import InitialForms, have_no_common_zero
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import coordinate

X, Y = coordinate("x"), coordinate("y")


def test_a_coordinate_is_not_put_into_a_long_relation() -> None:
    names = Names(coordinates=frozenset("xy"))
    short = parse_expression("y - x", names)
    other = parse_expression("y^2 x^2 - 1", names)
    long = parse_expression(" + ".join(f"(x^2 + {k}*y^2)^3" for k in range(1, MAX_NODES // 3)), names)
    moving = frozenset({X, Y})
    assert {(g, s) for _, g, s, _ in _linear([short, other], moving)} == {(short, X), (short, Y)}
    assert list(_linear([short, long], moving)) == []


def test_no_forms_at_all_are_no_forms_without_a_common_zero() -> None:
    assert not have_no_common_zero(InitialForms([[1, 0], [0, 1]], [], {}))
