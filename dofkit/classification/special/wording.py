"""Conditions and what they change, as a student reads them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from dofkit.classification.special.common_zeros import Leaf
from dofkit.exact.ring.canonical import Canon, Poly
from dofkit.expressions import tree as ex
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.system import System


def where(canon: Canon, leaf: Leaf, order: Mapping[Expr, int]) -> str:
    """``x = 0 and y = 0``, by the symbols' ``order``."""
    last = len(order)
    solved = []
    for i, value in leaf.solved:
        left, right = canon.ring.var_expr[i], canon.to_expr(value)
        if right.op == "sym" and order.get(right, last) < order.get(left, last):
            left, right = right, left
        solved.append((_first(left, order), f"{to_text(left)} = {to_text(right)}"))
    return " and ".join([text for _, text in sorted(solved)] + [_equation(canon, poly, order) for poly in leaf.others])


def order_of(system: System) -> dict[Expr, int]:
    """Parameters and coordinates as they were declared."""
    declared = [*map(ex.parameter, system.parameters), *(ex.coordinate(c.name) for c in system.coordinates)]
    return {s: i for i, s in enumerate(declared)}


def _equation(canon: Canon, poly: Poly, order: Mapping[Expr, int]) -> str:
    """``x*y = 1``, with the number on the right, or ``a = b`` for two terms of opposite signs."""
    e = canon.to_expr(poly / poly.leading_coefficient())
    terms: Sequence[Expr] = e.args if e.op == "add" else (e,)
    number = next((term for term in terms if term.op == "num"), ex.ZERO)
    if len(terms) == 2 and sorted(poly.coeffs()) == [-1, 1] and number.is_zero:
        left, right = sorted((t if _positive(t) else -t for t in terms), key=lambda t: _first(t, order))
        return f"{to_text(left)} = {to_text(right)}"
    return f"{to_text(e - number)} = {to_text(-number)}"


def in_order(e: Expr, order: Mapping[Expr, int]) -> Expr:
    """Return a sum with its terms in the order in which their symbols are declared."""
    return ex.add(*sorted(e.args, key=lambda term: _first(term, order))) if e.op == "add" else e


def _positive(term: Expr) -> bool:
    return not (term.op == "mul" and term.args[0].op == "num" and term.args[0].args[0] < 0)


def _first(term: Expr, order: Mapping[Expr, int]) -> int:
    return min((order.get(s, len(order)) for s in term.symbols), default=len(order))


def drop(rank: int, by: int, velocities: int, moves: bool) -> str:
    """What it means that ``by`` rows of ``rank`` depend on the others."""
    if not moves:
        return "no velocity satisfies the constraints there"
    return (
        f"the rank of the constraints drops from {rank} to {rank - by} there, and the instantaneous freedom is "
        f"{velocities + by} instead of {velocities}"
    )


def flag(
    scene: Sequence[int] | None, own: Sequence[int] | None, there: Sequence[int], vanishes: bool
) -> tuple[str, bool]:
    """(what it means that the curvature vanishes or shrinks, whether the growth vector is told).

    ``own`` and ``there`` are the block's dimensions; the scene's have as many more as it has other coordinates.
    """
    told = f"the first Lie brackets add {'no direction' if vanishes else 'fewer directions'} there"
    if not scene or not own or there[-1] != own[-1] or [g + scene[0] - own[0] for g in own] != list(scene):
        return told, False
    special = [g + scene[0] - own[0] for g in there]
    return f"{told}: the growth vector is {tuple_of(special)} instead of {tuple_of(scene)}", True


def tuple_of(numbers: Sequence[int]) -> str:
    """``(2, 3, 4)``."""
    return f"({', '.join(map(str, numbers))})"
