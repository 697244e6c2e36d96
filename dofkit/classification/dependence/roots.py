"""Roots in an answer: the branch that a root loses, where inequalities beside it leave that branch out anyway.

a sqrt(P) + b = 0 is one branch of b^2 = a^2 P; on the other one b = a sqrt(P), so a b >= 0 there. Where the others say
that a b <= 0 the root loses nothing: `sqrt(x^2 + y^2) = c z` is all of x^2 + y^2 = c^2 z^2 above z = 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from dofkit.classification.dependence.implication import follows
from dofkit.classification.dependence.inequalities import same_side
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, replace_nodes, substitute
from dofkit.expressions.tree import HALF, MINUS_ONE, ZERO, Expr
from dofkit.relations.normal.pieces import Finite, Inequality, Normal, Reduced
from dofkit.relations.setting import Setting

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
