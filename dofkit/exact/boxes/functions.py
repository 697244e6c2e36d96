"""Elementary functions of intervals, rounded outward, and their inverses on intervals."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import chain

from flint import arb

from dofkit.exact.boxes.intervals import (
    INF,
    NON_NEGATIVE,
    WHOLE,
    EmptyError,
    Interval,
    absolute,
    add,
    bounds,
    hull,
    meet,
    meet_or_none,
    minus,
    mul,
    negative,
    solve_even,
)

#: Beyond this an angle is not reduced.
MAX_ANGLE = 1e9
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
    """Return an interval that contains pi or E."""
    return bounds(arb.pi() if name == "pi" else arb.const_e())


def _increasing(name: str, a: Interval) -> Interval:
    domain, values = _INCREASING[name]
    a = meet(a, domain)
    if name == "log" and a[1] == 0.0:
        raise EmptyError
    low = values[0] if a[0] == domain[0] else bounds(_AT[name](arb(a[0])))[0]
    high = values[1] if a[1] == domain[1] else bounds(_AT[name](arb(a[1])))[1]
    return meet((low, high), values)


def function(name: str, a: Interval) -> Interval:
    """Return all values of a function of one argument. Raises EmptyError where it has none."""
    if name in _INCREASING:
        return _increasing(name, a)
    if name == "acos":
        low, high = _increasing("asin", a)
        half = constant("pi")[0] / 2, constant("pi")[1] / 2
        return meet(minus(half, (low, high)), (0.0, 3.1415926535897936))
    if name == "cosh":
        size = absolute(a)
        high = INF if size[1] == INF else bounds(arb(size[1]).cosh())[1]
        return max(1.0, bounds(arb(size[0]).cosh())[0] if size[0] < INF else 1.0), high
    if name == "abs":
        return absolute(a)
    return _circular(name, a)


def _circular(name: str, a: Interval) -> Interval:
    """Return the values of sin, cos or tan."""
    if name == "tan":
        if not _bounded_angle(a) or a[1] - a[0] > 3.2 or _meets_grid(a, 0.5, 1.0):
            return WHOLE
        return bounds(arb(a[0]).tan())[0], bounds(arb(a[1]).tan())[1]
    if not _bounded_angle(a) or a[1] - a[0] > 6.3:
        return -1.0, 1.0
    shift = 0.5 if name == "sin" else 0.0
    ends = [bounds(_AT[name](arb(x))) for x in a]
    low = -1.0 if _meets_grid(a, shift + 1.0, 2.0) else min(e[0] for e in ends)
    high = 1.0 if _meets_grid(a, shift, 2.0) else max(e[1] for e in ends)
    return max(low, -1.0), min(high, 1.0)


def _bounded_angle(a: Interval) -> bool:
    return max(-a[0], a[1]) < MAX_ANGLE


def _meets_grid(a: Interval, offset: float, step: float) -> bool:
    """Return whether a number pi (offset + k step) may lie in ``a``; True where one is close."""
    slack = 1e-6
    return math.floor((a[1] / math.pi - offset) / step + slack) >= math.ceil((a[0] / math.pi - offset) / step - slack)


def solve_function(name: str, x: Interval, result: Interval) -> Interval:
    """Return the part of ``x`` whose value can be in ``result``. Raises EmptyError."""
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
        low = -INF if a[0] <= -half else bounds(arb(a[0]).tan())[0]
        return low, INF if a[1] >= half else bounds(arb(a[1]).tan())[1]
    return _increasing(name, a) if name in _INCREASING else _circular(name, a)


def _solve_circular(name: str, x: Interval, result: Interval) -> Interval:
    """Return the part of ``x`` whose sine, cosine or tangent can be in ``result``, period by period."""
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
    moved = chain.from_iterable(
        (meet_or_none(x, add(p, mul(period, (float(k), float(k))))) for p in parts) for k in turns
    )
    return hull(moved)
