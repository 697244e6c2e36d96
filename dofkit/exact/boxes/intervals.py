"""Closed intervals of real numbers with floating point ends, every operation rounded outward.

IEEE additions, products, quotients and square roots are correctly rounded, so the next float outward is a bound; other
functions are evaluated by balls. A number that the interval of a value does not contain is proved not to be a value.
Balls cannot replace these intervals: conditions and positive parameters have half-lines as their ranges.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction

from flint import arb

Interval = tuple[float, float]
INF = math.inf
LARGEST = 1.7976931348623157e308
WHOLE: Interval = (-INF, INF)
NON_NEGATIVE: Interval = (0.0, INF)
#: Products are exact between whole numbers of this size.
_WHOLE_BITS = 2.0**53


class EmptyError(Exception):
    """No real number is left."""


def down(x: float) -> float:
    """Return a lower bound of the number that was rounded to ``x``."""
    return LARGEST if x == INF else math.nextafter(x, -INF)


def up(x: float) -> float:
    """Return an upper bound of the number that was rounded to ``x``."""
    return -LARGEST if x == -INF else math.nextafter(x, INF)


def meet(a: Interval, b: Interval) -> Interval:
    """Return the intersection. Raises EmptyError where it is empty."""
    low, high = max(a[0], b[0]), min(a[1], b[1])
    if low > high:
        raise EmptyError
    return low, high


def hull(parts: Iterable[Interval | None]) -> Interval:
    """Return the smallest interval that contains all parts. Raises EmptyError where there is no part."""
    intervals = [p for p in parts if p is not None]
    if not intervals:
        raise EmptyError
    return min(p[0] for p in intervals), max(p[1] for p in intervals)


def number(value: Fraction) -> Interval:
    """Return an interval that contains a rational number."""
    try:
        x = value.numerator / value.denominator
    except OverflowError:
        return (LARGEST, INF) if value > 0 else (-INF, -LARGEST)
    return (x, x) if Fraction(x) == value else (down(x), up(x))


def _exact_sum(a: float, b: float, s: float) -> bool:
    """Return whether s = a + b without a rounding error, by Knuth's two-sum."""
    back = s - a
    return (a - (s - back)) + (b - back) == 0.0


def _sum_low(a: float, b: float) -> float:
    s = a + b
    if s in (-INF, INF):
        return -INF if -INF in (a, b) else down(s)
    return s if _exact_sum(a, b, s) else down(s)


def _sum_high(a: float, b: float) -> float:
    return -_sum_low(-a, -b)


def add(a: Interval, b: Interval) -> Interval:
    """Return the sums of numbers of two intervals, rounded outward."""
    return _sum_low(a[0], b[0]), _sum_high(a[1], b[1])


def negative(a: Interval) -> Interval:
    """Return the negatives of the numbers of an interval."""
    return -a[1], -a[0]


def minus(a: Interval, b: Interval) -> Interval:
    """Return the differences of numbers of two intervals."""
    return add(a, negative(b))


def _product(a: float, b: float) -> tuple[float, bool]:
    """Return the rounded product, with 0 times infinity as 0, and whether it is exact."""
    if a == 0.0 or b == 0.0:
        return 0.0, True
    p = a * b
    if abs(a) == 1.0 or abs(b) == 1.0 or INF in (abs(a), abs(b)):
        return p, True
    return p, abs(p) < _WHOLE_BITS and a.is_integer() and b.is_integer()


def mul(a: Interval, b: Interval) -> Interval:
    """Return the products of numbers of two intervals, rounded outward."""
    lows, highs = [], []
    for x in a:
        for y in b:
            p, exact = _product(x, y)
            lows.append(p if exact else down(p))
            highs.append(p if exact else up(p))
    return min(lows), max(highs)


def inverse(b: Interval) -> list[Interval]:
    """Return 1/y for y in ``b`` without 0, as one or two intervals."""
    parts: list[Interval] = []
    if b[1] > 0:
        low = max(b[0], 0.0)
        parts.append((_quotient_low(1.0, b[1]), INF if low == 0.0 else -_quotient_low(-1.0, low)))
    if b[0] < 0:
        parts += [negative(p) for p in inverse((-min(b[1], 0.0), -b[0]))]
    return parts


def _quotient_low(a: float, b: float) -> float:
    """Return a lower bound of a/b, b > 0: the quotient itself where it is a whole number exactly.

    C's fmod has no rounding error, while q b = a may hold in rounded arithmetic only: 1/(1/3 in 53 bits) is not 3.
    """
    if b == INF:
        return 0.0
    q = a / b
    return q if b == 1.0 or (abs(q) < _WHOLE_BITS and math.fmod(a, b) == 0.0) else down(q)


def solve_product(x: Interval, y: Interval, result: Interval) -> Interval:
    """Return the part of ``x`` for which x y can be in ``result``. Raises EmptyError."""
    if contains_zero(y):
        if contains_zero(result):
            return x
        return hull(meet_or_none(x, mul(result, p)) for p in inverse(y))
    return meet(x, mul(result, inverse(y)[0]))


def meet_or_none(a: Interval, b: Interval) -> Interval | None:
    """Return the intersection, or None where it is empty."""
    low, high = max(a[0], b[0]), min(a[1], b[1])
    return None if low > high else (low, high)


def contains_zero(a: Interval) -> bool:
    """Return whether the interval contains 0."""
    return a[0] <= 0.0 <= a[1]


def _power_of(x: float, n: int, high: bool) -> float:
    """Return a bound of x^n for x >= 0."""
    total = 1.0
    for _ in range(n):
        p, exact = _product(total, x)
        total = p if exact else (up(p) if high else down(p))
        total = max(total, 0.0)
    return total


def integer_power(a: Interval, n: int) -> Interval:
    """Return a^n for n > 0."""
    if n % 2:
        low = _power_of(a[0], n, False) if a[0] >= 0 else -_power_of(-a[0], n, True)
        return low, (_power_of(a[1], n, True) if a[1] >= 0 else -_power_of(-a[1], n, False))
    size = absolute(a)
    return _power_of(size[0], n, False), _power_of(size[1], n, True)


def absolute(a: Interval) -> Interval:
    """Return the absolute values of the numbers of an interval."""
    if contains_zero(a):
        return 0.0, max(-a[0], a[1])
    return a if a[0] > 0 else negative(a)


def solve_even(x: Interval, size: Interval) -> Interval:
    """Return the part of ``x`` whose absolute value is in ``size`` (>= 0). Raises EmptyError."""
    return hull((meet_or_none(x, size), meet_or_none(x, negative(size))))


def root(a: Interval, degree: int) -> Interval:
    """Return the real roots; of an even degree only where ``a`` is not negative. Raises EmptyError."""
    if degree % 2 == 0:
        a = meet(a, NON_NEGATIVE)
    return _root_bounds(a[0], degree)[0], _root_bounds(a[1], degree)[1]


def _root_bounds(x: float, degree: int) -> Interval:
    if x in (0.0, INF, -INF):
        return x, x
    if x < 0:
        return negative(_root_bounds(-x, degree))
    if degree == 2:
        s = math.sqrt(x)
        return (s, s) if s.is_integer() and s * s == x and x < _WHOLE_BITS else (down(s), up(s))
    return bounds(arb(x).root(degree))


def bounds(value: arb) -> Interval:
    """Return an interval that contains a ball."""
    if not value.is_finite():
        return WHOLE
    if value.is_exact() and arb(float(value)) == value:
        return float(value), float(value)
    return down(down(float(value.lower()))), up(up(float(value.upper())))


def middle(a: Interval) -> float:
    """Return a number inside the interval, finite also where an end is not."""
    if a == WHOLE:
        return 0.0
    if a[0] == -INF:
        return min(2 * a[1], a[1] - 1.0, -1.0) if a[1] > -LARGEST / 4 else a[1]
    if a[1] == INF:
        return max(2 * a[0], a[0] + 1.0, 1.0) if a[0] < LARGEST / 4 else a[0]
    center = a[0] / 2 + a[1] / 2
    return min(max(center, a[0]), a[1])
