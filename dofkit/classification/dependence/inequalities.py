"""Inequalities beside an answer: do two of them leave the same side, and do they exclude the branch that a root loses?

a sqrt(P) + b = 0 is one branch of b^2 = a^2 P; on the other one b = a sqrt(P), so a b >= 0 there. Where the others say
that a b <= 0 the root loses nothing: `sqrt(x^2 + y^2) = c z` is all of x^2 + y^2 = c^2 z^2 above z = 0.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence

from flint import arb

from dofkit.classification.dependence.implication import follows
from dofkit.exact.errors import NoValueError
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, replace_nodes, substitute
from dofkit.expressions.tree import HALF, MINUS_ONE, ZERO, Expr
from dofkit.relations.normal.pieces import Finite, Inequality, Normal, Reduced
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
        result = RealSearch(ring, nodes, moving, setting.positive).search(seed)
        return None if result is None else result.point
    rng = random.Random(f"dofkit side {seed}")
    scale = SCALES[seed % len(SCALES)]

    def drawn(s: Expr) -> arb:
        size = rng.randint(1, 2**20)
        number = arb(size if s in setting.positive or rng.random() < 0.5 else -size) / 2**19
        return number if s.args[0] == "parameter" else number * scale

    return BallPoint({s: drawn(s) for s in symbols}, seed)


_ROOT = ex.parameter("value of a root")


def bounds(wanted: Sequence[Normal], others: Sequence[Reduced]) -> list[Inequality]:
    """The inequalities of others about coordinates of what is wanted."""
    symbols = {s for n in wanted for p in n.pieces if isinstance(p, Finite) for s in p.expr.symbols}
    moving = {s for s in symbols if s.args[0] == "coordinate"}
    return [q for r in others for q in r.inequalities if moving & q.expr.symbols]


def unsound(given: Sequence[Reduced], sound: Sequence[bool | None]) -> list[Expr]:
    """The equations as written that do not follow; none where they are not one for each relation."""
    written = [relation.expr for r in given for relation in r.constraint.relations]
    return [e for e, s in zip(written, sound, strict=True) if not s] if len(written) == len(sound) else []


def loses_nothing(
    e: Expr, wanted: Sequence[Normal], others: Sequence[Normal], sides: Iterable[Inequality], setting: Setting
) -> bool:
    """Is e = 0, with one root in it, all that is ``wanted`` where the inequalities hold? False says nothing."""
    parts = _by_root(e)
    if parts is None:
        return False
    a, b, under = parts
    squared = Normal(((Finite(b * b - a * a * under),),))
    if follows(squared, [*others, *wanted], setting) is not True:
        return False
    allowed = Inequality(ex.mul(MINUS_ONE, a, b))
    return any(same_side(allowed, side, others, setting) for side in sides)


def _by_root(e: Expr) -> tuple[Expr, Expr, Expr] | None:
    """(a, b, P) where e is a sqrt(P) + b, with no other root."""
    roots = {n for n in ex.nodes(e) if n.op == "pow" and n.args[1] == HALF}
    if len(roots) != 1:
        return None
    (root,) = roots
    named = replace_nodes(e, {root: _ROOT})
    slope = diff(named, _ROOT)
    if _ROOT in slope.symbols or slope.is_zero:
        return None
    return slope, substitute(named, {_ROOT: ZERO}), root.args[0]
