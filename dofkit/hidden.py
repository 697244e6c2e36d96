"""Hidden finite relations: where dt lies in the span of the rows, motion is confined to a locus.

If lambda A = 0 for the coordinates' columns A and lambda b is not 0 for the time column b, the rows imply
(lambda b) dt = 0, so motion through an interval of time needs lambda b = 0: a finite relation that nobody wrote
(x + y = t with xdot + ydot = z forces z = 1). Prolongation in the sense of Cartan.
"""

from __future__ import annotations

from flint import arb
from flint.utils.flint_exceptions import DomainError

from dofkit import expr as ex
from dofkit.exact.canon import Canon, TooLargeError
from dofkit.exact.program import values
from dofkit.exact.ring import ADD, MUL, NUM, Point, Ring, Scalar, reachable
from dofkit.expr import Expr
from dofkit.forms import Rows


def hidden_relation(rows: Rows, n: int, point: Point) -> Expr:
    """lambda b as an expression, by elimination, in lowest terms (a pivot is no factor of it); zero is decided
    at a generic point of the variety.

    ``n`` is the number of coordinate columns; time is column n. Returns 0 where the relation grows too large.
    """
    ring = rows.ring
    zero = ring.emit(NUM, ex.ZERO.args[0])
    work = [[row.get(c, zero) for c in range(n + 1)] for row in rows.entries]
    left = list(range(len(work)))
    for c in range(n):
        at = values(ring, point)
        candidates = [r for r in left if _nonzero(at[work[r][c]])]
        if not candidates:
            continue
        pivot = min(candidates, key=lambda r: _size(ring, work[r][c]))
        left.remove(pivot)
        for r in left:
            if r in candidates:
                work[r] = [_reduced(ring, work[r][k], work[r][c], work[pivot][k], work[pivot][c]) for k in range(n + 1)]
    at = values(ring, point)
    found = [work[r][n] for r in left if _nonzero(at[work[r][n]])]
    if not found:
        return ex.ZERO
    node = min(found, key=lambda i: _size(ring, i))
    try:
        canon = Canon(ring)
        top, bottom = canon.quotient(node)
        return canon.to_expr(top / top.gcd(bottom))
    except (TooLargeError, ZeroDivisionError, DomainError):
        return ex.ZERO


def _nonzero(value: Scalar) -> bool:
    """Not 0 in GF(p); or a ball that excludes 0."""
    return not value.contains(0) if isinstance(value, arb) else bool(value != 0)


def _reduced(ring: Ring, b: int, factor: int, d: int, pivot: int) -> int:
    """b - factor d / pivot, with the plain cases kept plain."""
    zero, one = ring.emit(NUM, ex.ZERO.args[0]), ring.emit(NUM, ex.ONE.args[0])
    if zero in (factor, d):
        return b
    parts = [part for part in (factor, d) if part != one]
    if pivot != one:
        parts.append(ring.power_node(pivot, -1))
    taken = ring.emit(MUL, (ring.emit(NUM, ex.MINUS_ONE.args[0]), *parts))
    return taken if b == zero else ring.emit(ADD, (b, taken))


def _size(ring: Ring, node: int) -> int:
    return len(reachable(ring, [node], through_generators=False))
