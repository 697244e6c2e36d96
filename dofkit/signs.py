"""Absolute values, and roots of squares: relations that hold on a whole region for one sign of the argument."""

from __future__ import annotations

from itertools import product as cartesian

from dofkit import expr as ex
from dofkit.exact.identity import is_zero
from dofkit.expr import Expr
from dofkit.zeros import never_holds

#: Arguments whose signs are tried.
MAX_ARGUMENTS = 4


def holds_on_a_region(e: Expr, positive: frozenset[Expr]) -> bool:
    """Is ``e`` identically 0 for some signs of the arguments of its absolute values (x + abs(x) for x <= 0)?"""
    arguments = [node.args[1] for node in ex.nodes(e) if node.op == "fn" and node.args[0] == "abs"]
    arguments += [node.args[0].args[0] for node in ex.nodes(e) if _root_of_square(node)]
    different = list(dict.fromkeys(arguments))
    if not different or len(different) > MAX_ARGUMENTS:
        return False
    for signs in cartesian((1, -1), repeat=len(different)):
        mapping = dict(zip(different, signs, strict=True))
        if is_zero(_signed(e, mapping), positive) and not any(
            never_holds(u if s == 1 else -u, True, positive) for u, s in mapping.items()
        ):
            return True
    return False


def _root_of_square(node: Expr) -> bool:
    """sqrt(u^2) and the like."""
    if node.op != "pow" or node.args[1].op != "num" or node.args[1].args[0].denominator != 2:
        return False
    inner = node.args[0]
    return bool(inner.op == "pow" and inner.args[1].op == "num" and inner.args[1].args[0] == 2)


def _signed(e: Expr, signs: dict[Expr, int]) -> Expr:
    """``e`` with every absolute value replaced by its argument times the given sign."""
    if e.op == "fn" and e.args[0] == "abs":
        return _signed(e.args[1], signs) * signs[e.args[1]]
    if _root_of_square(e):
        inner = e.args[0].args[0]
        return ex.power(_signed(inner, signs) * signs[inner], ex.num(2 * e.args[1].args[0]))
    parts = ex.children(e)
    return ex.rebuild(e, tuple(_signed(part, signs) for part in parts)) if parts else e
