"""Relations are put into each other while they stay short."""

from __future__ import annotations

import dofkit
from dofkit.configuration.cases import MAX_NODES, _linear
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


def test_a_case_is_a_part_of_the_set_and_says_nothing_of_what_passes_through_its_point() -> None:
    """x = 5, e = 0 and y = 0 leave u, v, w free. The case w = -26 of y (w + y^2 + 26) = 0 is a part of that."""
    scene = {
        "coordinates": ["x", "e", "y", "u1", "v1", "w1"],
        "constraints": [
            "y*(y^2 + x^2 + 1) = e",
            "(sqrt(1 + (x - 5)) - 1)*v1 = y*w1 + e",
            "(x - 5)^4 + e^6 + (e - x + 5)^2 = 0",
            "(sqrt(1 + (x - 5)) - 1)*u1 = y*v1",
        ],
    }
    report = dofkit.classify(scene)
    assert report.dof in (None, 3)
