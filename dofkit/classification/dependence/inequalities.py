"""Inequalities: do two of them leave the same side of the same boundary?"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence

from flint import arb

from dofkit.classification.dependence.implication import follows
from dofkit.exact.errors import NoValueError
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.pieces import Finite, Inequality, Normal
from dofkit.relations.setting import Setting

#: Random points at which signs are compared, and how far out they lie.
POINTS, SCALES = 24, (1, 1, 10, 1000)


def same_side(a: Inequality, b: Inequality, others: Sequence[Normal], setting: Setting) -> bool | None:
    """Do a >= 0 and b >= 0 hold at the same configurations that the others allow? None where that was not decided.

    The signs differ at some point (a ball proves it), or agree at all that are drawn and the boundaries are the same.
    Where the others leave the boundary only, all of space is looked at.
    """
    if a.expr == b.expr:
        return True
    finite = [p.expr for n in others for p in n.pieces if isinstance(p, Finite)]
    seen = list(_signs(a.expr, b.expr, finite, setting))
    if not seen and others:
        return same_side(a, b, (), setting)
    if any(one != other for one, other in seen):
        return False
    sides = [follows(_boundary(x), [*others, _boundary(y)], setting) for x, y in ((a, b), (b, a))]
    if False in sides:
        return False
    return True if seen and all(sides) else None


def _boundary(q: Inequality) -> Normal:
    return Normal(((Finite(q.expr),),))


def _signs(a: Expr, b: Expr, finite: Sequence[Expr], setting: Setting) -> Iterator[tuple[bool, bool]]:
    """(a > 0, b > 0) at random points, where both are certain."""
    ring = Ring([a, b, *finite], setting.positive, {})
    nodes = [ring.node(g) for g in finite]
    first, second = ring.node(a), ring.node(b)
    symbols = sorted({s for e in (a, b, *finite) for s in e.symbols}, key=repr)
    for k in range(POINTS):
        point = _point(ring, nodes, symbols, setting, k)
        try:
            at = None if point is None else values(ring, point)
        except (NoValueError, OverflowError, ValueError):
            continue
        if at is not None and not at[first].contains(0) and not at[second].contains(0):
            yield bool(at[first] > 0), bool(at[second] > 0)


def _point(ring: Ring, nodes: Sequence[int], symbols: Sequence[Expr], setting: Setting, seed: int) -> BallPoint | None:
    if nodes:
        moving = [s for s in symbols if s.args[0] != "parameter"]
        found = RealSearch(ring, nodes, moving, setting.positive).search(seed)
        return None if found is None else found.point
    rng = random.Random(f"dofkit side {seed}")
    scale = SCALES[seed % len(SCALES)]

    def drawn(s: Expr) -> arb:
        size = rng.randint(1, 2**20)
        number = arb(size if s in setting.positive or rng.random() < 0.5 else -size) / 2**19
        return number if s.args[0] == "parameter" else number * scale

    return BallPoint({s: drawn(s) for s in symbols}, seed)
