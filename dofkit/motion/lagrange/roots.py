"""Roots of squares: the length of a spring along a guide is u or -u, whichever is positive in the drawing."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon, divided
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import HALF, Expr
from dofkit.motion.lagrange.term_order import ordered


def without_roots(
    e: Expr, positive: frozenset[Expr], reference: Mapping[Expr, Expr] | None
) -> tuple[Expr, tuple[str, ...]]:
    """sqrt(u^2) replaced by u where u is positive at the reference configuration, with a note that it is so there.

    Without a reference, or where u is 0 or not a number there, the root stays.
    """
    if reference is None:
        return e, ()
    notes: list[str] = []
    memo: dict[Expr, Expr] = {}
    for node in ex.nodes(e):
        new = ex.rebuild(node, tuple(memo[child] for child in ex.children(node)))
        if new.op == "pow" and new.args[1] == HALF and any(s.args[0] == "coordinate" for s in new.symbols):
            root = _root(new.args[0], positive)
            here = None if root is None else _figure(substitute(root, {**reference, ex.TIME: ex.ZERO}))
            if root is not None and here:
                new = ordered(root if here > 0 else -root)
                notes.append(f"The equations are valid while {to_text(new)} > 0, as in the reference configuration.")
        memo[node] = new
    return memo[e], tuple(dict.fromkeys(notes))


def _root(e: Expr, positive: frozenset[Expr]) -> Expr | None:
    """u with u^2 = e identically, a polynomial; None where there is none."""
    ring = Ring([e], positive)
    try:
        node = ring.node(e)
        canon = Canon(ring)
        top, bottom = canon.quotient(node)
        if top == 0 or not bottom.is_constant():
            return None
        factors = canon.factors(top)
        content = divided(top.factor()[0], bottom.leading_coefficient())
    except NoValueError:
        return None
    number = ex.sqrt(ex.num(Fraction(int(content.p), int(content.q)))) if content > 0 else ex.ZERO
    if number.op != "num" or number.is_zero or any(k % 2 for _, k in factors):
        return None
    return ex.mul(number, *(ex.power(canon.to_expr(f), ex.num(k // 2)) for f, k in factors))


def _figure(e: Expr) -> float | None:
    try:
        return approximate(e)
    except (ArithmeticError, ValueError):
        return None
