"""Newton's method around a point solves for the same unknown functions that stand there."""

from __future__ import annotations

import numpy as np
from flint import arb, ctx

from dofkit.configuration.local.neighbourhood import Neighbourhood
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import coordinate

X, Y = coordinate("x"), coordinate("y")


def test_newton_solves_for_the_functions_of_the_neighbourhood() -> None:
    relation = parse_expression("2 y - h(x)", Names(coordinates=frozenset("xy"), functions={"h": 1}))
    ring = Ring([relation])
    node, column = ring.node(relation), ring.var_index(Y)
    assert column is not None
    here = Neighbourhood.__new__(Neighbourhood)
    here.ring, here.columns, here.keys, here.scales = ring, [column], [Y], np.array([1.0])
    with ctx.workprec(256):
        found = here.newton({X: arb(0.5), Y: arb(0.25)}, [node], [0])
        assert found is not None
        assert abs(values(ring, BallPoint(found, 0))[node]) < arb(2) ** -150
