"""Degrees of a program's values as quotients of polynomials: what the chance of an error over GF(p) is bounded by."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.exact.ring.instructions import ADD, MUL, NUM, POW, VAR, reachable
from dofkit.exact.ring.ring import Ring

#: Bits of the primes, less one; of what is looked for among arguments of exponentials and angles (see `characters`).
PRIME, RELATIONS = 60, 30


#: The degrees of a numerator and of a denominator.
Degrees = tuple[int, int]


def degree_bound(ring: Ring, nodes: Sequence[int]) -> int:
    """A bound of the degrees of numerators and denominators, in symbols and independent values of functions.

    Sines and cosines are functions on a curve of the second degree, a root is the power of another root.
    """
    most: dict[int, Degrees] = {}
    for i in reversed(reachable(ring, nodes, through_generators=False)):
        op, payload = ring.code[i]
        if op == NUM:
            most[i] = (0, 0)
        elif op == VAR:
            var = ring.vars[payload]
            most[i] = (2 if var.kind in ("cos", "sin") else max(1, var.degree), 0)
        elif op == ADD:
            most[i] = _of_sum([most[j] for j in payload])
        elif op == MUL:
            most[i] = (sum(most[j][0] for j in payload), sum(most[j][1] for j in payload))
        elif op == POW:
            top, bottom = most[payload[0]]
            k = abs(payload[1])
            most[i] = (top * k, bottom * k) if payload[1] > 0 else (bottom * k, top * k)
    return max((max(most[node]) for node in nodes), default=0)


def _of_sum(parts: Sequence[Degrees]) -> Degrees:
    """Over the product of all denominators."""
    below = sum(bottom for _, bottom in parts)
    return max(top + below - bottom for top, bottom in parts), below


def error_bits(ring: Ring, nodes: Sequence[int], size: int) -> int:
    """b with a chance below 2^-b that a minor, not 0, is 0 at a random point over GF(p) [SchwartzZippel].

    Of ``size`` rows of the nodes' derivatives it has at most so many times twice their degree. Where several
    exponentials or angles occur, relations among their arguments are found by chance with 2^-30.
    """
    own = PRIME - (2 * max(1, size) * max(1, degree_bound(ring, nodes))).bit_length()
    several = sum(var.kind in ("exp", "cos") for var in ring.vars) > 1
    return max(1, min(own, RELATIONS) if several else own)
