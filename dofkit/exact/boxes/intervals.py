"""Closed intervals of real numbers with floating point ends, every operation rounded outward.

IEEE additions, products, quotients and square roots are correctly rounded, so the next float outward is a bound; other
functions go through balls. What an interval of a value leaves out is proved not to be taken.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from fractions import Fraction
from itertools import chain

from flint import arb, fmpq

Interval = tuple[float, float]
INF = math.inf
LARGEST = 1.7976931348623157e308
WHOLE: Interval = (-INF, INF)
NON_NEGATIVE: Interval = (0.0, INF)
#: Beyond this an angle is not reduced.
MAX_ANGLE = 1e9
#: Products are exact between whole numbers of this size.
_WHOLE_BITS = 2.0**53


class EmptyError(Exception):
    """No real value is left."""


def down(x: float) -> float:
    """A bound from below of what was rounded to ``x``."""
    return LARGEST if x == INF else math.nextafter(x, -INF)


def up(x: float) -> float:
    """A bound from above of what was rounded to ``x``."""
    return -LARGEST if x == -INF else math.nextafter(x, INF)


def meet(a: Interval, b: Interval) -> Interval:
    """Raises EmptyError where they have no number in common."""
    low, high = max(a[0], b[0]), min(a[1], b[1])
    if low > high:
        raise EmptyError
    return low, high


def hull(parts: Iterable[Interval | None]) -> Interval:
    """The smallest interval that holds all; raises EmptyError where there is none."""
    found = [p for p in parts if p is not None]
    if not found:
        raise EmptyError
    return min(p[0] for p in found), max(p[1] for p in found)


def number(value: Fraction) -> Interval:
    """An interval that holds a rational number."""
    try:
        x = value.numerator / value.denominator
    except OverflowError:
        return (LARGEST, INF) if value > 0 else (-INF, -LARGEST)
    return (x, x) if Fraction(x) == value else (down(x), up(x))


def _exact_sum(a: float, b: float, s: float) -> bool:
    """Knuth's two-sum without a remainder."""
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
    return _sum_low(a[0], b[0]), _sum_high(a[1], b[1])


def negative(a: Interval) -> Interval:
    return -a[1], -a[0]


def minus(a: Interval, b: Interval) -> Interval:
    return add(a, negative(b))


def _product(a: float, b: float) -> tuple[float, bool]:
    """(the rounded product, is it exact?), with 0 times infinity as 0."""
    if a == 0.0 or b == 0.0:
        return 0.0, True
    p = a * b
    if abs(a) == 1.0 or abs(b) == 1.0 or INF in (abs(a), abs(b)):
        return p, True
    return p, abs(p) < _WHOLE_BITS and a.is_integer() and b.is_integer()


def mul(a: Interval, b: Interval) -> Interval:
    lows, highs = [], []
    for x in a:
        for y in b:
            p, exact = _product(x, y)
            lows.append(p if exact else down(p))
            highs.append(p if exact else up(p))
    return min(lows), max(highs)


def inverse(b: Interval) -> list[Interval]:
    """1/y for y in ``b`` without 0, as one or two pieces."""
    parts: list[Interval] = []
    if b[1] > 0:
        low = max(b[0], 0.0)
        parts.append((_quotient_low(1.0, b[1]), INF if low == 0.0 else -_quotient_low(-1.0, low)))
    if b[0] < 0:
        parts += [negative(p) for p in inverse((-min(b[1], 0.0), -b[0]))]
    return parts


def _quotient_low(a: float, b: float) -> float:
    """A bound from below of a/b, b > 0: the quotient itself where it is a whole number exactly.

    C's fmod has no rounding error, while q b = a may hold in rounded arithmetic only: 1/(1/3 in 53 bits) is not 3.
    """
    if b == INF:
        return 0.0
    q = a / b
    return q if b == 1.0 or (abs(q) < _WHOLE_BITS and math.fmod(a, b) == 0.0) else down(q)


def solve_product(x: Interval, y: Interval, result: Interval) -> Interval:
    """The part of ``x`` for which x y can be in ``result``. Raises EmptyError."""
    if contains_zero(y):
        if contains_zero(result):
            return x
        return hull(_meet(x, mul(result, p)) for p in inverse(y))
    return meet(x, mul(result, inverse(y)[0]))


def _meet(a: Interval, b: Interval) -> Interval | None:
    low, high = max(a[0], b[0]), min(a[1], b[1])
    return None if low > high else (low, high)


def contains_zero(a: Interval) -> bool:
    return a[0] <= 0.0 <= a[1]


def _power_of(x: float, n: int, high: bool) -> float:
    """A bound of x^n for x >= 0."""
    total = 1.0
    for _ in range(n):
        p, exact = _product(total, x)
        total = p if exact else (up(p) if high else down(p))
        total = max(total, 0.0)
    return total


def integer_power(a: Interval, n: int) -> Interval:
    """a^n for n > 0."""
    if n % 2:
        low = _power_of(a[0], n, False) if a[0] >= 0 else -_power_of(-a[0], n, True)
        return low, (_power_of(a[1], n, True) if a[1] >= 0 else -_power_of(-a[1], n, False))
    size = absolute(a)
    return _power_of(size[0], n, False), _power_of(size[1], n, True)


def absolute(a: Interval) -> Interval:
    if contains_zero(a):
        return 0.0, max(-a[0], a[1])
    return a if a[0] > 0 else negative(a)


def solve_even(x: Interval, size: Interval) -> Interval:
    """The part of ``x`` whose absolute value is in ``size`` (>= 0). Raises EmptyError."""
    return hull((_meet(x, size), _meet(x, negative(size))))


def root(a: Interval, degree: int) -> Interval:
    """The real root; of an even degree only where ``a`` is not negative. Raises EmptyError."""
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
    return _bounds(arb(x).root(degree))


def _bounds(value: arb) -> Interval:
    """The ends of a ball as floats."""
    if not value.is_finite():
        return WHOLE
    if value.is_exact() and arb(float(value)) == value:
        return float(value), float(value)
    return down(down(float(value.lower()))), up(up(float(value.upper())))


_AT: dict[str, Callable[[arb], arb]] = {
    "exp": arb.exp, "log": arb.log, "sin": arb.sin, "cos": arb.cos, "tan": arb.tan, "asin": arb.asin,
    "acos": arb.acos, "atan": arb.atan, "sinh": arb.sinh, "cosh": arb.cosh, "tanh": arb.tanh,
    "asinh": arb.asinh, "acosh": arb.acosh, "atanh": arb.atanh,
}  # fmt: skip

#: The values at the ends of the domain of increasing functions, and that domain.
_INCREASING: dict[str, tuple[Interval, Interval]] = {
    "exp": (WHOLE, (0.0, INF)),
    "log": ((0.0, INF), WHOLE),
    "asin": ((-1.0, 1.0), (-1.5707963267948968, 1.5707963267948968)),
    "atan": (WHOLE, (-1.5707963267948968, 1.5707963267948968)),
    "sinh": (WHOLE, WHOLE),
    "tanh": (WHOLE, (-1.0, 1.0)),
    "asinh": (WHOLE, WHOLE),
    "acosh": ((1.0, INF), (0.0, INF)),
    "atanh": ((-1.0, 1.0), WHOLE),
}
#: The inverse function on the whole range, for the increasing functions that texts may hold.
_INVERSE = {"exp": "log", "log": "exp", "asin": "sin", "atan": "tan", "sinh": "asinh", "tanh": "atanh"}


def constant(name: str) -> Interval:
    """pi and E."""
    return _bounds(arb.pi() if name == "pi" else arb.const_e())


def _increasing(name: str, a: Interval) -> Interval:
    domain, values = _INCREASING[name]
    a = meet(a, domain)
    if name == "log" and a[1] == 0.0:
        raise EmptyError
    low = values[0] if a[0] == domain[0] else _bounds(_AT[name](arb(a[0])))[0]
    high = values[1] if a[1] == domain[1] else _bounds(_AT[name](arb(a[1])))[1]
    return meet((low, high), values)


def function(name: str, a: Interval) -> Interval:
    """All values of a function of one argument. Raises EmptyError where it has none."""
    if name in _INCREASING:
        return _increasing(name, a)
    if name == "acos":
        low, high = _increasing("asin", a)
        half = constant("pi")[0] / 2, constant("pi")[1] / 2
        return meet(minus(half, (low, high)), (0.0, 3.1415926535897936))
    if name == "cosh":
        size = absolute(a)
        high = INF if size[1] == INF else _bounds(arb(size[1]).cosh())[1]
        return max(1.0, _bounds(arb(size[0]).cosh())[0] if size[0] < INF else 1.0), high
    if name == "abs":
        return absolute(a)
    return _circular(name, a)


def _circular(name: str, a: Interval) -> Interval:
    """sin, cos or tan."""
    if name == "tan":
        if not _bounded_angle(a) or a[1] - a[0] > 3.2 or _meets_grid(a, 0.5, 1.0):
            return WHOLE
        return _bounds(arb(a[0]).tan())[0], _bounds(arb(a[1]).tan())[1]
    if not _bounded_angle(a) or a[1] - a[0] > 6.3:
        return -1.0, 1.0
    shift = 0.5 if name == "sin" else 0.0
    ends = [_bounds(_AT[name](arb(x))) for x in a]
    low = -1.0 if _meets_grid(a, shift + 1.0, 2.0) else min(e[0] for e in ends)
    high = 1.0 if _meets_grid(a, shift, 2.0) else max(e[1] for e in ends)
    return max(low, -1.0), min(high, 1.0)


def _bounded_angle(a: Interval) -> bool:
    return max(-a[0], a[1]) < MAX_ANGLE


def _meets_grid(a: Interval, offset: float, step: float) -> bool:
    """May a number pi (offset + k step) lie in ``a``? Where it is close, yes."""
    slack = 1e-6
    return math.floor((a[1] / math.pi - offset) / step + slack) >= math.ceil((a[0] / math.pi - offset) / step - slack)


def solve_function(name: str, x: Interval, result: Interval) -> Interval:
    """The part of ``x`` whose value can be in ``result``. Raises EmptyError."""
    if name in _INVERSE:
        return meet(x, _increasing_or_circular(_INVERSE[name], meet(result, _INCREASING[name][1])))
    if name == "acos":
        return meet(x, _circular("cos", meet(result, (0.0, 3.1415926535897936))))
    if name == "cosh":
        return solve_even(x, _increasing("acosh", meet(result, (1.0, INF))))
    if name == "abs":
        return solve_even(x, meet(result, NON_NEGATIVE))
    return _solve_circular(name, x, result)


def _increasing_or_circular(name: str, a: Interval) -> Interval:
    if name == "tan":
        half = 1.5707963267948966
        low = -INF if a[0] <= -half else _bounds(arb(a[0]).tan())[0]
        return low, INF if a[1] >= half else _bounds(arb(a[1]).tan())[1]
    return _increasing(name, a) if name in _INCREASING else _circular(name, a)


def _solve_circular(name: str, x: Interval, result: Interval) -> Interval:
    """The pieces of the inverse, one a period, that meet ``x``."""
    if not _bounded_angle(x) or x[1] - x[0] > 30.0:
        if name != "tan":
            meet(result, (-1.0, 1.0))
        return x
    pi = constant("pi")
    if name == "tan":
        first = _increasing("atan", result)
        parts: list[Interval] = [first]
        period = pi
    else:
        first = _increasing("asin", meet(result, (-1.0, 1.0)))
        if name == "cos":
            first = minus((pi[0] / 2, pi[1] / 2), first)
            parts = [first, negative(first)]
        else:
            parts = [first, minus(pi, first)]
        period = (2 * pi[0], 2 * pi[1])
    turns = range(math.floor(x[0] / period[0]) - 2, math.ceil(x[1] / period[0]) + 3)
    moved = chain.from_iterable((_meet(x, add(p, mul(period, (float(k), float(k))))) for p in parts) for k in turns)
    return hull(moved)


def middle(a: Interval) -> float:
    """A number well inside, finite also where an end is not."""
    if a == WHOLE:
        return 0.0
    if a[0] == -INF:
        return min(2 * a[1], a[1] - 1.0, -1.0) if a[1] > -LARGEST / 4 else a[1]
    if a[1] == INF:
        return max(2 * a[0], a[0] + 1.0, 1.0) if a[0] < LARGEST / 4 else a[0]
    found = a[0] / 2 + a[1] / 2
    return min(max(found, a[0]), a[1])


def ball(value: Fraction) -> arb:
    """A rational number as a ball."""
    return arb(fmpq(value.numerator, value.denominator))
