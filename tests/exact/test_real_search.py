"""A search for real points measures relations by their gradients."""

from __future__ import annotations

import pytest

from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import coordinate

X, Y = coordinate("x"), coordinate("y")


def test_where_a_gradient_is_too_large_for_a_float_the_search_ends() -> None:
    relation = parse_expression("10^10*(y*sinh(x)) - 1", Names(coordinates=frozenset("xy")))
    ring = Ring([relation])
    search = RealSearch(ring, [ring.node(relation)], [X, Y], frozenset())
    assert search.descend({X: 709.5, Y: 0.0}, 1) is None


@pytest.mark.parametrize("power", [0, 6, 12, 24])
def test_a_small_factor_changes_no_distance(power: int) -> None:
    relation = parse_expression(f"(x^2 + y^2 - 1)/10^{power}", Names(coordinates=frozenset("xy")))
    ring = Ring([relation])
    search = RealSearch(ring, [ring.node(relation)], [X, Y], frozenset())
    symbols = {X: 1.5, Y: 0.25}
    assert search.descend(symbols, 1) is not None
    assert abs(symbols[X] ** 2 + symbols[Y] ** 2 - 1) < 1e-9
