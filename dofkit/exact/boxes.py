"""Bounds of expressions over boxes, forward and backward, rounded outward by balls (arb).

What running expressions forward leaves out of a box is proved to be no value there [Moore1966]. Running them backward
narrows the arguments of every step to those for which it can have its result (hull consistency). An interval has
floating point ends, which may be infinite: conditions and positive parameters have half-lines as their ranges, and no
ball is one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction

from flint import arb, fmpq

from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

Interval = tuple[float, float]
Box = list[Interval]
INF = math.inf
WHOLE: Interval = (-INF, INF)
NON_NEGATIVE: Interval = (0.0, INF)
UNIT: Interval = (-1.0, 1.0)
#: The largest floating point number.
LARGEST = 1.7976931348623157e308
#: Sweeps over one box, and the share of some width that a sweep has to remove for another to follow.
SWEEPS, WORTH = 12, 0.05
_QUARTER_TURNS: Interval = (-1.5707963267948968, 1.5707963267948968)
_HALF_TURNS: Interval = (-3.1415926535897936, 3.1415926535897936)
#: Increasing functions, with their domain and their range.
_INCREASING: dict[str, tuple[Interval, Interval]] = {
    "exp": (WHOLE, NON_NEGATIVE), "log": (NON_NEGATIVE, WHOLE), "asin": (UNIT, _QUARTER_TURNS),
    "atan": (WHOLE, _QUARTER_TURNS), "sinh": (WHOLE, WHOLE), "asinh": (WHOLE, WHOLE), "tanh": (WHOLE, UNIT),
    "atanh": (UNIT, WHOLE), "cosh": (NON_NEGATIVE, (1.0, INF)), "acosh": ((1.0, INF), NON_NEGATIVE),
}  # fmt: skip
#: The function that takes a value back to the argument, for those that have one.
_INVERSE = {"exp": "log", "log": "exp", "asin": "sin", "acos": "cos", "atan": "tan", "sinh": "asinh", "tanh": "atanh"}


class EmptyError(Exception):
    """No real number is left."""


# -- intervals -------------------------------------------------------------------------------------


def bounds(value: arb) -> Interval:
    """Return an interval that contains a ball."""
    return (_below(value), -_below(-value)) if value.is_finite() else WHOLE


def _below(value: arb) -> float:
    """Return a floating point number that is at most every number of a finite ball."""
    end = value.lower()
    low = min(float(end), LARGEST)
    return low if arb(low) <= end else math.nextafter(low, -INF)


def _low_sum(a: float, b: float) -> float:
    """Return a lower bound of a sum: the sum itself where it has no rounding error, by Knuth's two-sum."""
    if -INF in (a, b):
        return -INF
    total = a + b
    back = total - a
    return total if (a - (total - back)) + (b - back) == 0.0 else math.nextafter(total, -INF)


def add(a: Interval, b: Interval) -> Interval:
    """Return the sums of numbers of two intervals."""
    return _low_sum(a[0], b[0]), -_low_sum(-a[1], -b[1])


def negative(a: Interval) -> Interval:
    """Return the negatives of the numbers of an interval."""
    return -a[1], -a[0]


def mul(a: Interval, b: Interval) -> Interval:
    """Return the products of numbers of two intervals."""
    corners = [_corner(x, y) for x in a for y in b]
    return min(low for low, _ in corners), max(high for _, high in corners)


def _corner(x: float, y: float) -> Interval:
    """Return bounds of a product, where 0 times infinity is 0."""
    if x == 0.0 or y == 0.0:
        return 0.0, 0.0
    is_exact = abs(x) in (1.0, INF) or abs(y) in (1.0, INF)
    return (x * y, x * y) if is_exact else bounds(arb(x) * arb(y))


def meet(a: Interval, b: Interval) -> Interval:
    """Return the intersection. Raises EmptyError where it is empty."""
    return _hull([_meet_or_none(a, b)])


def _meet_or_none(a: Interval, b: Interval) -> Interval | None:
    low, high = max(a[0], b[0]), min(a[1], b[1])
    return None if low > high else (low, high)


def _hull(pieces: Iterable[Interval | None]) -> Interval:
    """Return the smallest interval that contains all parts. Raises EmptyError where there is none."""
    intervals = [p for p in pieces if p is not None]
    if not intervals:
        raise EmptyError
    return min(p[0] for p in intervals), max(p[1] for p in intervals)


def contains_zero(a: Interval) -> bool:
    """Return whether the interval contains 0."""
    return a[0] <= 0.0 <= a[1]


def inverses(b: Interval) -> list[Interval]:
    """Return 1/y for y in ``b`` without 0, as one or two intervals, or none."""
    intervals: list[Interval] = []
    if b[1] > 0:
        low = max(b[0], 0.0)
        ends = (0.0 if b[1] == INF else _below(1 / arb(b[1])), INF if low == 0.0 else -_below(-1 / arb(low)))
        intervals.append(ends)
    if b[0] < 0:
        intervals += [negative(part) for part in inverses((-min(b[1], 0.0), -b[0]))]
    return intervals


def _absolute(a: Interval) -> Interval:
    if contains_zero(a):
        return 0.0, max(-a[0], a[1])
    return a if a[0] > 0 else negative(a)


def _of_size(x: Interval, size: Interval) -> Interval:
    """Return the part of ``x`` whose absolute value is in ``size``. Raises EmptyError."""
    size = meet(size, NON_NEGATIVE)
    return _hull((_meet_or_none(x, size), _meet_or_none(x, negative(size))))


def _powers(a: Interval, power: int, root: int = 1) -> Interval:
    """Return x^(power/root) for x in ``a``, either of them 1. Raises EmptyError where there is no real root."""
    if power % 2 == 0:
        a = _absolute(a)
    elif root % 2 == 0:
        a = meet(a, NON_NEGATIVE)
    return _power_of(a[0], power, root)[0], _power_of(a[1], power, root)[1]


def _power_of(x: float, power: int, root: int) -> Interval:
    """Return bounds of x^(power/root), where x is not negative or both are odd."""
    if math.isinf(x):
        return x, x
    size = arb(abs(x)).root(root) if root > 1 else arb(abs(x)) ** power
    return bounds(size if x >= 0 else -size)


def function(name: str, a: Interval) -> Interval:
    """Return all values of an elementary function of one argument. Raises EmptyError where it has none."""
    if name == "acos":
        return add(bounds(arb.pi() / 2), negative(function("asin", a)))
    if name == "abs":
        return _absolute(a)
    if name == "cosh":
        a = _absolute(a)
    if name in _INCREASING:
        domain, values = _INCREASING[name]
        a = meet(a, domain)
        if name == "log" and a[1] == 0.0:
            raise EmptyError
        low = values[0] if a[0] == domain[0] else bounds(getattr(arb, name)(arb(a[0])))[0]
        high = values[1] if a[1] == domain[1] else bounds(getattr(arb, name)(arb(a[1])))[1]
        return meet((low, high), values)
    values = WHOLE if name == "tan" else UNIT
    return values if INF in (-a[0], a[1]) else meet(bounds(getattr(arb, name)(arb(a[0]).union(arb(a[1])))), values)


def middle(a: Interval) -> float:
    """Return a number inside the interval, finite also where an end is not."""
    if a == WHOLE:
        return 0.0
    if a[0] == -INF:
        return min(2 * a[1], a[1] - 1.0, -1.0) if a[1] > -LARGEST / 4 else a[1]
    if a[1] == INF:
        return -middle(negative(a))
    return min(max(a[0] / 2 + a[1] / 2, a[0]), a[1])


# -- expressions over boxes ------------------------------------------------------------------------


class BoxProgram:
    """Expressions, each of which must lie in a given interval, over boxes of their ``variables``.

    Symbols are variables; so is every value of an unknown function, which may be anything.
    """

    def __init__(self, wanted: Sequence[tuple[Expr, Interval]]) -> None:
        self.wanted = wanted
        self.nodes = list(dict.fromkeys(node for e, _ in wanted for node in ex.nodes(e)))
        self.variables = [node for node in self.nodes if node.op in ("sym", "call")]
        self._numbers = {node: _number(node) for node in self.nodes if node.op in ("num", "const")}
        self.work = 0

    def forward(self, box: Sequence[Interval]) -> dict[Expr, Interval]:
        """Return the values of all steps over a box. Raises EmptyError where one has none."""
        at = self._numbers | dict(zip(self.variables, box, strict=True))
        self.work += len(self.nodes)
        for node in self.nodes:
            if node not in at:
                at[node] = _value(node, at)
        return at

    def contract(self, box: Box) -> Box:
        """Return the part of the box that running forward and backward leaves. Raises EmptyError where that is nothing.

        Every solution in the box is in what is returned, so that EmptyError is a proof that there is none.
        """
        for _ in range(SWEEPS):
            at = self.forward(box)
            for e, interval in self.wanted:
                at[e] = meet(at[e], interval)
            for node in reversed(self.nodes):
                _narrow(node, at)
            narrower = [at[v] for v in self.variables]
            if not _is_worth_another(box, narrower):
                return narrower
            box = narrower
        return box


def _number(node: Expr) -> Interval:
    if node.op == "const":
        return bounds(arb.pi() if node.args[0] == "pi" else arb.const_e())
    value: Fraction = node.args[0]
    return bounds(arb(fmpq(value.numerator, value.denominator)))


def _value(node: Expr, at: dict[Expr, Interval]) -> Interval:
    """Return all values of a step. Raises EmptyError where it has none."""
    if node.op in ("add", "mul"):
        combine = add if node.op == "add" else mul
        total = at[node.args[0]]
        for part in node.args[1:]:
            total = combine(total, at[part])
        return total
    if node.op == "pow":
        base, exponent = node.args
        if exponent.op != "num":
            return function("exp", mul(at[exponent], function("log", at[base])))
        value = exponent.args[0]
        power = _powers(_powers(at[base], 1, value.denominator), abs(value.numerator))
        return power if value > 0 else _hull(inverses(power))
    name, argument = node.args[0], at[node.args[1]]
    if name == "atan2":
        return _HALF_TURNS
    if name not in ("cot", "sec", "csc"):
        return function(name, argument)
    below = _hull(inverses(function("cos" if name == "sec" else "sin", argument)))
    return mul(function("cos", argument), below) if name == "cot" else below


def _narrow(node: Expr, at: dict[Expr, Interval]) -> None:
    """Narrow the arguments of a step to those for which it can have its result. Raises EmptyError."""
    if node.op in ("add", "mul"):
        _narrow_parts(node, at)
    elif node.op == "pow" and node.args[1].op == "num":
        base, value = node.args[0], node.args[1].args[0]
        result = at[node] if value > 0 else _hull(inverses(at[node]))
        p, q = abs(value.numerator), value.denominator
        if p % 2 and q % 2:
            at[base] = meet(at[base], _powers(_powers(result, 1, p), q))
        else:
            size = _powers(_powers(meet(result, NON_NEGATIVE), 1, p), q)
            at[base] = _of_size(at[base], size) if q % 2 else meet(at[base], size)
    elif node.op == "fn":
        name, u = node.args[0], node.args[1]
        if name in _INVERSE:
            values = function(name, WHOLE)
            at[u] = meet(at[u], function(_INVERSE[name], meet(at[node], values)))
        elif name in ("abs", "cosh"):
            at[u] = _of_size(at[u], at[node] if name == "abs" else function("acosh", at[node]))


def _narrow_parts(node: Expr, at: dict[Expr, Interval]) -> None:
    """Narrow each term or factor by the result and the others."""
    is_sum = node.op == "add"
    combine, neutral = (add, (0.0, 0.0)) if is_sum else (mul, (1.0, 1.0))
    after = [neutral]
    for part in reversed(node.args[1:]):
        after.append(combine(after[-1], at[part]))
    before = neutral
    for part, following in zip(node.args, reversed(after), strict=True):
        others = combine(before, following)
        old = at[part]
        if is_sum:
            at[part] = meet(old, add(at[node], negative(others)))
        elif not (contains_zero(others) and contains_zero(at[node])):
            at[part] = _hull(_meet_or_none(old, mul(at[node], p)) for p in inverses(others))
        before = combine(before, old)


def _is_worth_another(old: Box, new: Box) -> bool:
    """Return whether some interval lost a share of its width, or became finite."""
    for (a, b), (c, d) in zip(old, new, strict=True):
        if (a == -INF and c > a) or (b == INF and d < b):
            return True
        if b - a < INF and d - c < (1 - WORTH) * (b - a):
            return True
    return False
