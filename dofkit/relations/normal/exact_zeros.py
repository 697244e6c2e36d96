"""Exact zeros of analytic functions of one coordinate, and those that have no other: x = sin(x) says x = 0.

Where its derivative has one sign a function that is not constant is monotone, so it has one zero at most; and so it has
where it and its derivative vanish at one place and the derivative nowhere else, for then it is monotone on both sides
[IsolatedZeros].
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from dofkit.base.deadline import check
from dofkit.exact.analyticity import ENTIRE, is_analytic
from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.semidefinite import Signs, weak_sign
from dofkit.relations.normal.zero_set import never_vanishes

SOLE_NOTE = (
    "it is satisfied at one value only, where its gradient may vanish: it is replaced by the equation that "
    "the coordinate has this value"
)
#: Functions beside which an equation of one coordinate is no polynomial.
TRANSCENDENTAL = ENTIRE | {"atan"}
#: Where zeros are looked for: up to this size, at so many places to a unit; steps to halve an interval.
REACH, PLACES, HALVINGS = 10, 8, 40
#: Zeros that are tried have at most this denominator, or are such a multiple of pi.
MAX_DENOMINATOR = 24
#: Derivatives that are looked at until one has one sign.
ORDERS = 4


def sole_zero(e: Expr) -> Expr | None:
    """The value of its only coordinate at which ``e`` vanishes, and it does so nowhere else; None where not seen."""
    if len(e.symbols) != 1 or not e.functions & TRANSCENDENTAL or not is_analytic_in_coordinates(e, poles=False):
        return None
    (s,) = e.symbols
    derivatives = [e]
    while len(derivatives) <= ORDERS:
        derivatives.append(diff(derivatives[-1], s))
        if _has_one_sign(derivatives[-1]):
            break
    else:
        return None
    vanishing = derivatives[:-1]
    for value in candidates([e], s):
        if all(is_proved_zero(substitute(d, {s: value}), frozenset()) for d in vanishing):
            return value
    return None


def _has_one_sign(e: Expr) -> bool:
    """Is it proved to be nowhere negative, or nowhere positive, and is it not 0 everywhere?"""
    if e.is_zero:
        return False
    try:
        ring = Ring([e])
        node = ring.node(e)
        canon = Canon(ring)
        top, bottom = canon.quotient(node)
        if bottom.is_constant() and top != 0 and weak_sign(canon, Signs(canon, frozenset()), top):
            return True
    except NoValueError:
        return False
    return never_vanishes(e, frozenset())


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
    found = [interval_of(g, {s: x}) for g in relations]
    return sum(float("inf") if ball is None else abs(float(ball.mid())) for ball in found)


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
