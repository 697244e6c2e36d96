"""Derivatives of canonical quotients, against those of the expressions."""

from __future__ import annotations

import pytest

from dofkit.classification.special.derivatives import Derivation
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import coordinate


@pytest.mark.parametrize(
    ("text", "slope"),
    [
        ("x^3/(1 + y)", "3*x^2/(1 + y)"),
        ("x*abs(x)", "2*abs(x)"),
        ("abs(x)", "abs(x)/x"),
        ("sin(x^2)*y", "2*x*y*cos(x^2)"),
        ("cos(x y)", "-y*sin(x y)"),
        ("exp(3 x)", "3*exp(3 x)"),
        ("log(1 + x^2)", "2*x/(1 + x^2)"),
        ("sqrt(1 + x^2)", "x/sqrt(1 + x^2)"),
        ("atan(2 x)", "2/(1 + 4*x^2)"),
    ],
)
def test_the_derivative_by_a_symbol(text: str, slope: str) -> None:
    names = Names(coordinates=frozenset("xy"))
    e, wanted = (parse_expression(t, names) for t in (text, slope))
    ring = Ring([e, wanted])
    nodes = ring.node(e), ring.node(wanted)
    canon = Canon(ring)
    top, bottom = Derivation(canon).of(canon.quotient(nodes[0]), coordinate("x"))
    above, below = canon.quotient(nodes[1])
    assert canon.reduce(top * below - above * bottom) == 0
