"""The order in which terms and factors are read: accelerations first; parameters before what moves."""

from __future__ import annotations

from dofkit.expressions import tree as ex
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr

_KINDS = {"parameter": 0, "time": 1, "coordinate": 2, "velocity": 4, "acceleration": 5}


def ordered(e: Expr) -> Expr:
    """The same expression with its terms and factors in a steady order that people expect."""
    memo: dict[Expr, Expr] = {}
    for node in ex.nodes(e):
        parts = tuple(memo[child] for child in ex.children(node))
        if node.op == "add":
            memo[node] = Expr("add", tuple(sorted(parts, key=_term)))
        elif node.op == "mul":
            memo[node] = Expr("mul", tuple(sorted(parts, key=_factor)))
        else:
            memo[node] = ex.rebuild(node, parts)
    return memo[e]


def _orders(e: Expr, kind: str) -> int:
    return sum(s.args[0] == kind for s in e.symbols)


def _term(e: Expr) -> tuple[bool, bool, bool, tuple[object, ...]]:
    """Accelerations, then velocities, then the rest; what is positive before what is negative."""
    key = tuple(to_text(part) for part in (e.args if e.op == "mul" else (e,)))
    negative = e.op == "mul" and e.args[0].op == "num" and e.args[0].args[0] < 0
    return not _orders(e, "acceleration"), not _orders(e, "velocity"), negative, key


def _factor(e: Expr) -> tuple[int, str]:
    """Numbers, parameters, coordinates, functions and sums, velocities, accelerations."""
    base = e.args[0] if e.op == "pow" else e
    if base.op == "num":
        return -1, ""
    if base.op == "sym":
        return _KINDS.get(base.args[0], 6), base.args[1]
    fixed = all(s.args[0] == "parameter" for s in base.symbols)
    return (0 if fixed else 3), to_text(base)
