"""Is an expression identically zero?"""

from __future__ import annotations

from flint.utils.flint_exceptions import DomainError

from dofkit.exact.canon import Canon, TooLargeError
from dofkit.exact.field import NoPointError, field_point
from dofkit.exact.program import values
from dofkit.exact.ring import Ring
from dofkit.expr import Expr


def is_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Zero identically: in the canonical ring (a proof), or else at random points over GF(p)."""
    if e.is_zero:
        return True
    ring = Ring([e], positive)
    node = ring.node(e)
    try:
        return Canon(ring).is_zero(node)
    except (TooLargeError, ZeroDivisionError, DomainError):
        return _zero_at_points(ring, node)


def _zero_at_points(ring: Ring, node: int) -> bool:
    seen = 0
    for seed in range(60):
        try:
            if values(ring, field_point([ring], seed))[node] != 0:
                return False
        except (ZeroDivisionError, NoPointError):
            continue
        seen += 1
        if seen == 3:
            return True
    return False
