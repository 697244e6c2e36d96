"""Candidates for exact zeros of analytic functions of one coordinate: short numbers and multiples of pi."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from dofkit.base.deadline import check
from dofkit.exact.analyticity import is_analytic
from dofkit.expressions import tree as ex
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.tree import Expr

#: Where zeros are looked for: up to this size, at so many places to a unit; steps to halve an interval.
REACH, PLACES, HALVINGS = 10, 8, 40
#: Zeros that are tried have at most this denominator, or are such a multiple of pi.
MAX_DENOMINATOR = 24


def is_analytic_in_coordinates(e: Expr, *, poles: bool) -> bool:
    """Return whether ``e`` holds coordinates only, is no unknown function and is analytic in them."""
    known = all(s.args[0] == "coordinate" for s in e.symbols) and "call" not in e.functions
    return known and is_analytic(e, e.symbols, poles=poles)


def candidates(relations: Sequence[Expr], s: Expr) -> Iterator[Expr]:
    """Short numbers, and multiples of pi, near which all of the relations are small."""
    grid = [Fraction(k, PLACES) for k in range(-REACH * PLACES, REACH * PLACES + 1)]
    sizes = [_size(relations, s, x) for x in grid]
    seen = set[Expr]()
    for k in sorted(range(1, len(grid) - 1), key=lambda k: (abs(grid[k]), grid[k] < 0)):
        check()
        if sizes[k] > min(sizes[k - 1], sizes[k + 1]):
            continue
        least = _least(relations, s, grid[k - 1], grid[k + 1])
        turns = least / Fraction(314159265358979, 10**14)
        for value in (_short(least), _short(turns) * ex.PI):
            if value not in seen:
                seen.add(value)
                yield value


def _short(x: Fraction) -> Expr:
    return ex.num(x.limit_denominator(MAX_DENOMINATOR))


def _size(relations: Sequence[Expr], s: Expr, x: Fraction) -> float:
    result = [interval_of(g, {s: x}) for g in relations]
    return sum(float("inf") if ball is None else abs(float(ball.mid())) for ball in result)


def _least(relations: Sequence[Expr], s: Expr, low: Fraction, high: Fraction) -> Fraction:
    """Where the relations are smallest between two places, by thirds."""
    for _ in range(HALVINGS):
        third = (high - low) / 3
        first, second = (x.limit_denominator(10**12) for x in (low + third, high - third))
        if _size(relations, s, first) <= _size(relations, s, second):
            high = second
        else:
            low = first
    return (low + high) / 2
