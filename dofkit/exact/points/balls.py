"""Real points: of balls (arb), of rational numbers, and of floats for searches.

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

#: Number of sines in the function that stands for an unknown one.
WAVES = 3


class SmoothFunction(NamedTuple):
    """f(u) = start + slopes . u + the sum of height sin(widths . u + phase) over ``waves``, with dyadic numbers."""

    start: Fraction
    slopes: tuple[Fraction, ...]
    waves: tuple[tuple[Fraction, tuple[Fraction, ...], Fraction], ...]

    def value(self, args: Sequence[Any], orders: Sequence[int], numbers: Any, sine: Any, half_pi: Any) -> Any:
        """Return the function differentiated ``orders[i]`` times by its i-th argument.

        ``numbers`` converts a fraction to the type of the arguments; ``sine`` and ``half_pi`` are of this type.
        """
        total, terms = sum(orders), list[Any]()
        if total == 0:
            terms = [numbers(self.start), *(numbers(slope) * u for slope, u in zip(self.slopes, args, strict=True))]
        elif total == 1:
            terms = [numbers(self.slopes[list(orders).index(1)])]
        for height, widths, phase in self.waves:
            factor, angle = height, numbers(phase) + half_pi * total
            for width, order, u in zip(widths, orders, args, strict=True):
                factor *= width**order
                angle = angle + numbers(width) * u
            terms.append(numbers(factor) * sine(angle))
        return sum(terms, numbers(Fraction(0)))


@lru_cache(maxsize=256)
def smooth_function(name: str, arguments: int, seed: int) -> SmoothFunction:
    """Return the random function that stands for the unknown function ``name``; the same seed gives the same one."""
    rng = random.Random(f"dofkit function {name} {arguments} {seed}")

    def dyadic(low: int, high: int) -> Fraction:
        return Fraction(rng.choice((-1, 1)) * rng.randrange(low, high), 512)

    slopes = tuple(dyadic(256, 1024) for _ in range(arguments))
    waves = tuple(
        (dyadic(64, 512), tuple(dyadic(256, 1024) for _ in range(arguments)), dyadic(1, 1600)) for _ in range(WAVES)
    )
    return SmoothFunction(dyadic(1, 1024), slopes, waves)


#: Bits of a ball. Numbers longer than `SHORT` bits add twice the excess, because differences of long numbers are small.
PRECISION, SHORT = 256, 64
#: Integers below this become balls directly; a fraction is converted.
WHOLE = 1 << 16
_bits: ContextVar[int | None] = ContextVar("ball_bits", default=None)
_more: ContextVar[int] = ContextVar("ball_bits_more", default=0)


@contextmanager
def balls_of(bits: float) -> Iterator[None]:
    """Compute with balls of exactly so many bits in the ``with`` block (for experiments with the precision)."""
    token = _bits.set(round(bits))
    try:
        yield
    finally:
        _bits.reset(token)


def fixed_bits() -> int | None:
    """Return the bits set by `balls_of`; None if there are none, so that the precision may be raised."""
    return _bits.get()


def precision() -> int:
    """Return the present number of bits of a ball."""
    return _bits.get() or PRECISION + _more.get()


@contextmanager
def precise_for(longest: int) -> Iterator[None]:
    """In the ``with`` block compute with enough bits for numbers of up to ``longest`` bits."""
    token = _more.set(2 * max(0, longest - SHORT))
    try:
        with ctx.workprec(precision()):
            yield
    finally:
        _more.reset(token)


class _RealPoint:
    """Values of the ``symbols``; the ``seed`` chooses the functions that stand for unknown ones."""

    def __init__(self, symbols: Mapping[Expr, Any], seed: int = 0) -> None:
        self.symbols = dict(symbols)
        self.seed = seed

    @cached_property
    def rng(self) -> random.Random:
        """The source of other random choices at this point."""
        return random.Random(f"dofkit functions {self.seed}")


class FloatPoint(_RealPoint):
    """Floating point values, used in searches for a point but in no proof."""

    def number(self, value: Fraction) -> float:
        return value.numerator / value.denominator

    def generator(self, var: Var, args: Sequence[Scalar]) -> float:
        """Return the floating-point value of a generator."""
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
    """Return the real root of a number; raises ValueError for an even root of a negative one."""
    if u >= 0:
        return float(u ** (1 / degree))
    if degree % 2 == 0:
        raise ValueError("an even root of a negative number")
    return -float((-u) ** (1 / degree))


_FLOAT: dict[str, Callable[[float], float]] = {
    "cos": math.cos, "sin": math.sin, "exp": math.exp, "log": math.log, "asin": math.asin, "atan": math.atan,
}  # fmt: skip


class BallPoint(_RealPoint):
    """Values as balls: the computed ball contains the true value."""

    def number(self, value: Fraction) -> arb:
        above, below = value.numerator, value.denominator
        return arb(above) if below == 1 and -WHOLE < above < WHOLE else arb(fmpq(above, below))

    def generator(self, var: Var, args: Sequence[Scalar]) -> arb:
        value = self._value(var, args)
        if not value.is_finite():
            raise OutsideDomainError
        return value

    def _value(self, var: Var, args: Sequence[Scalar]) -> arb:
        """Return the ball of a generator whose arguments have the values ``args``."""
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
    """Return random dyadic (so exact) values of all symbols; those in ``positive`` are greater than 0.

    Time and named parameters have the same value in every ring, so that points of several blocks can be combined.
    """
    rng = random.Random(f"dofkit start {seed}")
    symbols = [var.key for var in ring.vars if var.kind == "symbol"]
    return {s: _random_value(s, rng, seed, s in positive) for s in symbols}


def _random_value(symbol: Expr, rng: random.Random, seed: int, positive: bool) -> float:
    """Return a random multiple of 1/512; that of time or a named parameter depends only on its name and ``seed``."""
    kind, name = symbol.args
    constant = kind in ("time", "parameter")
    low = 256 if positive or constant else -1024
    value = rng.randrange(low, 1025) / 512 or 0.25
    if constant and name[0] != "_":
        return random.Random(f"dofkit start {seed} {name}").randrange(low, 1025) / 512
    return value


def random_ball_point(ring: Ring, positive: frozenset[Expr], seed: int) -> BallPoint:
    """Return a point with exact random values of all symbols (`random_values`)."""
    return BallPoint({s: arb(v) for s, v in random_values(ring, positive, seed).items()}, seed)


def jacobian(
    ring: Ring, at: Sequence[Scalar], point: Any, nodes: Sequence[int], columns: Sequence[int], zero: Scalar
) -> list[list[Scalar]]:
    """Return the matrix d(node)/d(symbol); ``columns`` are generator indices of symbols, ``at`` the nodes' values."""
    rows = []
    for node in nodes:
        g = gradient(ring, at, point, [(node, zero + 1)])
        rows.append([g.get(c, zero) for c in columns])
    return rows


#: Bound on the entries of a matrix that is eliminated over the rationals.
MAX_ENTRIES = 20_000


class ExactPoint:
    """Rational values of symbols, of functions and of roots; raises NoPointError for values that are not rational."""

    def __init__(self, symbols: Mapping[Expr, Fraction]) -> None:
        self.symbols = symbols

    def number(self, value: Fraction) -> fmpq:
        return fmpq(value.numerator, value.denominator)

    def generator(self, var: Var, args: Sequence[Scalar]) -> fmpq:
        if var.kind == "symbol" and var.key in self.symbols:
            return self.number(self.symbols[var.key])
        if args:
            at = Fraction(int(args[0].p), int(args[0].q))
            value = value_at(var.kind, at) if var.kind != "root" else exact_root(at, var.degree) if at >= 0 else None
            if value is not None:
                return self.number(value)
        raise NoPointError(f"{var.kind} has no rational value there")


def rational_values(pose: Mapping[Expr, Expr]) -> dict[Expr, Fraction]:
    """Return the values of the symbols of a pose that are given by rational numbers."""
    return {s: v.args[0] for s, v in pose.items() if v.op == "num"}


def vanish_exactly(ring: Ring, nodes: Sequence[int], symbols: Mapping[Expr, Fraction]) -> bool:
    """Return whether all nodes are 0 at a rational point; False also if a value there is not rational."""
    return vanish(ring, ExactPoint(symbols), nodes)


def exact_rank(
    ring: Ring, nodes: Sequence[int], columns: Sequence[int], symbols: Mapping[Expr, Fraction]
) -> int | None:
    """Return the rank of d(nodes)/d(columns) at a rational point.

    None if a value there is not rational, or if the matrix has more than `MAX_ENTRIES` entries. ``columns`` are
    generator indices of symbols, -1 for a symbol that does not occur.
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

    ``point``: ball values of all symbols. ``matrix``: the Jacobian of the relations there by the ranked symbols that
    occur. ``part``: a certified nonsingular submatrix of ``matrix``. ``certified``: the ball contains a true zero of
    ``solved`` independent relations, by the interval Newton test. ``consistent``: all relations' balls contain 0.
    """

    point: BallPoint
    part: PivotedPart
    certified: bool
    consistent: bool
    matrix: list[list[arb]]
    solved: int = 0

    @property
    def certain(self) -> bool:
        """Whether the independent relations have a zero in the ball, and the others may be 0 in it."""
        return self.certified and self.consistent
