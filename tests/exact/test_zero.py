"""Numbers that are nearly 0, and points that make a zero probable."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import identity
from dofkit.exact.zero.constants import proved_zero
from dofkit.exact.zero.independence import doubt
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import coordinate

#: Sums of arcs that are 0.
ARCS = ["asin(3/5 + {e}) + asin(4/5) - pi/2", "2*asin(3/5 + {e}) - asin(24/25)", "atan(1/2 + {e}) + atan(1/3) - pi/4"]


@pytest.mark.parametrize("arcs", ARCS)
def test_arcs_that_nearly_close_do_not(arcs: str) -> None:
    """10^-120 is less than the bits that are looked at first tell from 0."""
    for e, consistent in (("0", True), ("1/(10^60*10^60)", False), ("-1/(10^60*10^60)", False)):
        report = dofkit.classify({"coordinates": ["x"], "constraints": ["x = 0", f"x + {arcs.format(e=e)} = 0"]})
        assert report.consistent in (consistent, None), e


@pytest.mark.parametrize("arcs", ARCS)
def test_arcs_that_close_are_proved_to(arcs: str) -> None:
    """The product of exp(i theta_k)^n_k is real, and the sum is small."""
    for e, closed in (("0", True), ("1/(10^60*10^60)", False), ("-1/(10^60*10^60)", False)):
        assert proved_zero(parse_expression(arcs.format(e=e), Names())) is closed


def test_three_points_make_a_zero_probable(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[Any] = []
    point = identity.field_point
    monkeypatch.setattr(identity, "field_point", lambda rings, seed: drawn.append(seed) or point(rings, seed))
    x = coordinate("x")
    ring = Ring([x])
    assert identity._zero_at_points(ring, ring.node(x - x)) is True
    assert len(drawn) == 3


@pytest.mark.parametrize("arcs", ARCS)
def test_a_form_with_a_coefficient_that_is_nearly_zero_does_not_integrate(arcs: str) -> None:
    """dz + c y dx is a contact form wherever c is not 0, however small; and z = C where it is."""
    for e, holonomic in (("0", True), ("1/(10^60*10^60)", False)):
        form = f"dz + ({arcs.format(e=e)}) y dx = 0"
        report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": [form]})
        assert report.constraints[0].holonomic is holonomic
        assert report.dof == (2 if holonomic else 3)
        scene = {"coordinates": ["x", "y", "z"], "constraints": [form]}
        assert dofkit.ask(scene, "dof").value == report.dof
        assert dofkit.ask(scene, "integrability").value == {"c1": holonomic}
        same = dofkit.ask({**scene, "constraints": ["dz = 0"]}, "equivalence", {"constraint": "c1", "text": form})
        assert same.value in (holonomic, None)
        assert dofkit.derived_flag(scene) in ([1] if holonomic else [1, 0], None)


@pytest.mark.parametrize(
    ("texts", "independent"),
    [
        (["sqrt(1 + x^2)", "sqrt(2 + y)", "sqrt(3 + z)"], True),
        (["sqrt(1 + x)", "sqrt(2 + x)", "sqrt(3 + x + z)"], True),
        (["sqrt(1 + x)", "sqrt(2 + y)", "sqrt(2 + 2 x + y + x y)"], False),
        (["log(1 + x)", "log(2 + y)", "log(2 + 2 x + y + x y)"], False),
    ],
)
def test_roots_of_coprime_arguments_are_independent(texts: list[str], independent: bool) -> None:
    names = Names(coordinates=frozenset("xyz"))
    relations = [parse_expression(text, names) for text in texts]
    ring = Ring(relations)
    assert all(ring.node(e) is not None for e in relations)
    assert doubt(ring) == (None if independent else "functions")
