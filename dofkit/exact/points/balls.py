"""Points at which values are certain: balls of real numbers (arb), and rational numbers.

A value whose ball excludes 0 is proved not to be 0; values at a point with rational coordinates are exact.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

from flint import arb, ctx, fmpq, fmpq_mat

from dofkit.base.errors import NoValueError
from dofkit.exact.matrices.certified import PivotedPart
from dofkit.exact.ring.program import NoPointError, OutsideDomainError, Scalar, Var, gradient, values, vanish
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.rational_values import exact_root, value_at
from dofkit.expressions.tree import Expr

#: Sines in a function.
WAVES = 3


class SmoothFunction(NamedTuple):
    """The dyadic numbers of one function of some arguments."""

    start: Fraction
    slopes: tuple[Fraction, ...]
    waves: tuple[tuple[Fraction, tuple[Fraction, ...], Fraction], ...]

    def value(self, args: Sequence[Any], orders: Sequence[int], numbers: Any, sine: Any, half_pi: Any) -> Any:
        """Return the function differentiated ``orders[i]`` times by its i-th argument.

        ``numbers`` turns a fraction into the numbers of the arguments; ``sine``, ``half_pi``: theirs.
        """
        total = sum(orders)
        total_value = numbers(Fraction(0))
        if total == 0:
            total_value = total_value + numbers(self.start)
            for slope, u in zip(self.slopes, args, strict=True):
                total_value = total_value + numbers(slope) * u
        elif total == 1:
            total_value = total_value + numbers(self.slopes[list(orders).index(1)])
        for height, widths, phase in self.waves:
            factor, angle = height, numbers(phase) + half_pi * total
            for width, order, u in zip(widths, orders, args, strict=True):
                factor *= width**order
                angle = angle + numbers(width) * u
            total_value = total_value + numbers(factor) * sine(angle)
        return total_value


@lru_cache(maxsize=256)
def smooth_function(name: str, arguments: int, seed: int) -> SmoothFunction:
    """Return the function of a name: the same in every run, another for another seed."""
    rng = random.Random(f"dofkit function {name} {arguments} {seed}")

    def draw(low: int, high: int) -> Fraction:
        return Fraction(rng.choice((-1, 1)) * rng.randrange(low, high), 512)

    slopes = tuple(draw(256, 1024) for _ in range(arguments))
    waves = tuple(
        (draw(64, 512), tuple(draw(256, 1024) for _ in range(arguments)), draw(1, 1600)) for _ in range(WAVES)
    )
    return SmoothFunction(draw(1, 1024), slopes, waves)


#: Bits of a ball; numbers of more bits than the second ask for as many more, twice: what they differ by may be as small
#: as they are long.
PRECISION, SHORT = 256, 64
#: Whole numbers up to this need no rounding.
WHOLE = 1 << 16
_bits: ContextVar[int | None] = ContextVar("ball_bits", default=None)
_more: ContextVar[int] = ContextVar("ball_bits_more", default=0)


@contextmanager
def balls_of(bits: float) -> Iterator[None]:
    """Compute with balls of so many bits within, whatever is needed: what few bits tell can be measured."""
    token = _bits.set(round(bits))
    try:
        yield
    finally:
        _bits.reset(token)


def fixed_bits() -> int | None:
    """Return the bits that were asked for; None where they may be raised."""
    return _bits.get()


def precision() -> int:
    """Return the bits of a ball."""
    return _bits.get() or PRECISION + _more.get()


@contextmanager
def precise_for(longest: int) -> Iterator[None]:
    """Compute with balls that tell apart within what numbers of so many bits do."""
    token = _more.set(2 * max(0, longest - SHORT))
    try:
        with ctx.workprec(precision()):
            yield
    finally:
        _more.reset(token)


class _RealPoint:
    """Values of the symbols, and an unknown function of each name that is asked for."""

    def __init__(self, symbols: Mapping[Expr, Any], seed: int = 0) -> None:
        self.symbols = dict(symbols)
        self.seed = seed

    @cached_property
    def rng(self) -> random.Random:
        """What else is drawn at this point."""
        return random.Random(f"dofkit functions {self.seed}")


class FloatPoint(_RealPoint):
    """Floating point values; the search for a point uses them, no answer does."""

    def number(self, value: Fraction) -> float:
        return value.numerator / value.denominator

    def generator(self, var: Var, args: Sequence[Scalar]) -> float:
        if var.kind == "symbol":
            return float(self.symbols[var.key])
        if var.kind == "pi":
            return math.pi
        if var.kind == "call":
            name, orders, _ = var.key
            function = smooth_function(name, len(args), self.seed)
            return float(function.value(args, orders, self.number, math.sin, math.pi / 2))
        if var.kind == "root":
            return _real_root(float(args[0]), var.degree)
        if var.kind == "sign":
            return math.copysign(1.0, args[0])
        if var.kind == "atan2":
            return math.atan2(args[0], args[1])
        return float(_FLOAT[var.kind](args[0]))


def _real_root(u: float, degree: int) -> float:
    if u >= 0:
        return float(u ** (1 / degree))
    if degree % 2 == 0:
        raise ValueError("an even root of a negative number")
    return -float((-u) ** (1 / degree))


_FLOAT: dict[str, Callable[[float], float]] = {
    "cos": math.cos, "sin": math.sin, "exp": math.exp, "log": math.log, "asin": math.asin, "atan": math.atan,
}  # fmt: skip


class BallPoint(_RealPoint):
    """Ball values: what is computed contains what is true."""

    def number(self, value: Fraction) -> arb:
        above, below = value.numerator, value.denominator
        return arb(above) if below == 1 and -WHOLE < above < WHOLE else arb(fmpq(above, below))

    def generator(self, var: Var, args: Sequence[Scalar]) -> arb:
        value = self._value(var, args)
        if not value.is_finite():
            raise OutsideDomainError
        return value

    def _value(self, var: Var, args: Sequence[Scalar]) -> arb:
        if var.kind == "symbol":
            return arb(self.symbols[var.key])
        if var.kind == "pi":
            return arb.pi()
        if var.kind == "call":
            name, orders, _ = var.key
            function = smooth_function(name, len(args), self.seed)
            return arb(function.value(args, orders, self.number, arb.sin, arb.pi() / 2))
        if var.kind == "root":
            return arb(args[0]).root(var.degree) if args[0] > 0 or var.degree % 2 == 0 else -(-args[0]).root(var.degree)
        if var.kind == "sign":
            if args[0].contains(0):
                raise OutsideDomainError
            return arb(args[0]).sgn()
        if var.kind == "atan2":
            return arb.atan2(args[0], args[1])
        return arb(getattr(args[0], var.kind)())


def random_values(ring: Ring, positive: frozenset[Expr], seed: int) -> dict[Expr, float]:
    """Return random dyadic values of the symbols, so that what is not solved for is an exact number.

    Time and a parameter that has a name have the same value wherever they occur: so points of sets fit.
    """
    rng = random.Random(f"dofkit start {seed}")
    symbols = [var.key for var in ring.vars if var.kind == "symbol"]
    return {s: _random_value(s, rng, seed, s in positive) for s in symbols}


def _random_value(symbol: Expr, rng: random.Random, seed: int, positive: bool) -> float:
    kind, name = symbol.args
    constant = kind in ("time", "parameter")
    low = 256 if positive or constant else -1024
    value = rng.randrange(low, 1025) / 512 or 0.25
    if constant and name[0] != "_":
        return random.Random(f"dofkit start {seed} {name}").randrange(low, 1025) / 512
    return value


def random_ball_point(ring: Ring, positive: frozenset[Expr], seed: int) -> BallPoint:
    """Return a point of random values, which are exact."""
    return BallPoint({s: arb(v) for s, v in random_values(ring, positive, seed).items()}, seed)


def jacobian(
    ring: Ring, at: Sequence[Scalar], point: Any, nodes: Sequence[int], columns: Sequence[int], zero: Scalar
) -> list[list[Scalar]]:
    """Return the matrix d(node)/d(symbol); ``columns`` are generator indices of symbols."""
    rows = []
    for node in nodes:
        g = gradient(ring, at, point, [(node, zero + 1)])
        rows.append([g.get(c, zero) for c in columns])
    return rows


#: Entries of a matrix that is eliminated over the rationals.
MAX_ENTRIES = 20_000


class ExactPoint:
    """Rational values of the symbols; of functions, those at 0 and roots of powers. Raises NoPointError for others."""

    def __init__(self, symbols: Mapping[Expr, Fraction]) -> None:
        self.symbols = symbols

    def number(self, value: Fraction) -> fmpq:
        return fmpq(value.numerator, value.denominator)

    def generator(self, var: Var, args: Sequence[Scalar]) -> fmpq:
        if var.kind == "symbol" and var.key in self.symbols:
            return self.number(self.symbols[var.key])
        if args and args[0] == 0 and (at_zero := value_at(var.kind, Fraction(0))) is not None:
            return self.number(at_zero)
        if var.kind == "root" and args[0] >= 0:
            root = exact_root(Fraction(int(args[0].p), int(args[0].q)), var.degree)
            if root is not None:
                return self.number(root)
        raise NoPointError(f"{var.kind} has no rational value there")


def rational_values(pose: Mapping[Expr, Expr]) -> dict[Expr, Fraction]:
    """Return the symbols whose values are written as rational numbers."""
    return {s: v.args[0] for s, v in pose.items() if v.op == "num"}


def vanish_exactly(ring: Ring, nodes: Sequence[int], symbols: Mapping[Expr, Fraction]) -> bool:
    """Return whether nodes are proved to be 0 at a rational point. False where a value is no rational."""
    return vanish(ring, ExactPoint(symbols), nodes)


def exact_rank(
    ring: Ring, nodes: Sequence[int], columns: Sequence[int], symbols: Mapping[Expr, Fraction]
) -> int | None:
    """Return the rank of d(nodes)/d(columns) at a rational point; None where a value is none, or there are too many.

    ``columns``: generators of symbols, -1 for one that does not occur.
    """
    present = [c for c in columns if c >= 0]
    if len(nodes) * len(present) > MAX_ENTRIES:
        return None
    point = ExactPoint(symbols)
    try:
        at = values(ring, point)
        slopes = [gradient(ring, at, point, [(node, fmpq(1))]) for node in nodes]
    except NoValueError:
        return None
    return int(fmpq_mat(len(nodes), len(present), [row.get(c, fmpq(0)) for row in slopes for c in present]).rref()[1])


@dataclass(frozen=True)
class RealPoint:
    """A real point of the variety.

    ``point``: ball values of all symbols. ``part``: of the Jacobian there by the unknowns, a regular part of its rows;
    ``certified``: the ball contains a true zero of as many independent relations; ``consistent``: the other
    relations' balls contain 0 too. ``matrix``: the Jacobian by the ranked symbols that occur; ``solved``: how many
    relations were put to the interval Newton test.
    """

    point: BallPoint
    part: PivotedPart
    certified: bool
    consistent: bool
    matrix: list[list[arb]]
    solved: int = 0

    @property
    def certain(self) -> bool:
        """Whether all relations may be 0 in the ball, and as many as are independent are."""
        return self.certified and self.consistent
