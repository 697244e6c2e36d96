"""Random curves: what holds identically holds along them, and what is independent stays so."""

from __future__ import annotations

from flint import nmod_mat

from dofkit.exact.points.field import field_point
from dofkit.exact.points.series import RandomCurve
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

X, Y = ex.coordinate("x"), ex.coordinate("y")
ORDER = 12


def along(*expressions: Expr) -> tuple[list[list[int]], int]:
    """The coefficients of expressions along one curve, and the prime."""
    ring = Ring(expressions)
    nodes = [ring.node(e) for e in expressions]
    base = field_point([ring], 3)
    at = values(ring, RandomCurve(base, ORDER))
    return [[int(at[n].coefficient(k)) for k in range(ORDER)] for n in nodes], base.p


def test_identities_hold_to_every_order() -> None:
    """The last: 8 c^3 - 4 c^2 - 4 c + 1 = 0 for c = cos(pi/7)."""
    sine, cosine, seventh = ex.fn("sin", X), ex.fn("cos", X), ex.fn("cos", ex.PI / 7)
    zero = [
        sine * sine + cosine * cosine - ex.ONE,
        ex.fn("sin", X + Y) - sine * ex.fn("cos", Y) - cosine * ex.fn("sin", Y),
        ex.fn("exp", X + Y) - ex.fn("exp", X) * ex.fn("exp", Y),
        ex.sqrt(X + Y) * ex.sqrt(X + Y) * X - X * X - X * Y,
        8 * seventh**3 - 4 * seventh**2 - 4 * seventh + 1,
    ]
    assert along(*zero)[0] == [[0] * ORDER] * len(zero)


def test_independent_functions_have_independent_series() -> None:
    functions = [ex.ONE, X, Y, X * Y, ex.fn("sin", X), X * ex.fn("cos", X), ex.fn("exp", Y), ex.fn("log", Y)]
    rows, p = along(*functions, ex.sqrt(X))
    assert nmod_mat(rows, p).rank() == len(rows)
    dependent = [(a + 2 * b) % p for a, b in zip(rows[3], rows[4], strict=True)]
    assert nmod_mat([*rows, dependent], p).rank() == len(rows)
