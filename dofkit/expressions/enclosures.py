"""Values of expressions as certified intervals (balls: a midpoint and a radius)."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping, Sequence
from fractions import Fraction

from flint import arb, ctx, fmpq

from dofkit.expressions.tree import HALF, Expr, children

#: Bits of the interval arithmetic.
BITS = 256


def is_constant(e: Expr) -> bool:
    """Return whether ``e`` contains no symbol and no unknown function."""
    return not e.symbols and not has_call(e)


def has_call(e: Expr) -> bool:
    """Return whether ``e`` contains an unknown function."""
    return "call" in e.functions


def interval_of(e: Expr, values: Mapping[Expr, Fraction | arb] | None = None, bits: int = BITS) -> arb | None:
    """Return a ball around the value of ``e`` at ``values`` of its symbols; None if ``e`` has no real value there."""

    def go(node: Expr) -> arb:
        if node not in balls:
            balls[node] = _combined(node, [go(part) for part in children(node)])
        return balls[node]

    with ctx.workprec(bits):
        try:
            balls = {
                symbol: _ball(value) if isinstance(value, Fraction) else value
                for symbol, value in (values or {}).items()
            }
            ball = go(e)
        except (KeyError, ZeroDivisionError, RecursionError, OverflowError):
            return None
    return ball if ball.is_finite() else None


def _ball(value: Fraction) -> arb:
    return arb(fmpq(value.numerator, value.denominator))


def _combined(node: Expr, balls: Sequence[arb]) -> arb:
    """Return the value of a node from the values of its children. Raises KeyError for symbols and unknown functions."""
    if node.op == "num":
        return _ball(node.args[0])
    if node.op == "const":
        return arb.pi() if node.args[0] == "pi" else arb.const_e()
    if node.op == "add":
        return sum(balls, arb(0))
    if node.op == "mul":
        return math.prod(balls, start=arb(1))
    if node.op == "pow":
        return balls[0].sqrt() if node.args[1] == HALF else balls[0] ** balls[1]
    if node.op == "fn":
        name = node.args[0]
        if name == "atan2" and all(ball.contains(0) for ball in balls):
            raise ZeroDivisionError
        return abs(balls[0]) if name == "abs" else getattr(arb, name)(*balls)
    raise KeyError(node)


def differs_from_zero(e: Expr) -> bool:
    """Return whether ``e`` is proved not to be identically 0, by its value at a random point with positive symbols."""
    if e.op == "num":
        return bool(e.args[0])
    if has_call(e):
        return False
    draw = random.Random(20)
    values = {symbol: Fraction(draw.randrange(10**6, 10**7), 10**6) for symbol in sorted(e.symbols, key=repr)}
    ball = interval_of(e, values)
    return ball is not None and not ball.contains(0)


def approximate(e: Expr) -> float | None:
    """Return a constant expression as a float; None if ``e`` is not constant, too large or has no real value."""
    if e.op == "num":
        try:
            return float(e.args[0])
        except OverflowError:
            return None
    if not is_constant(e):
        return None
    ball = interval_of(e)
    return None if ball is None else float(ball.mid())
