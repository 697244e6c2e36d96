"""Truncated power series in one variable, over GF(p) and over balls, and programs run on them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import comb, factorial
from typing import Any

from flint import arb, arb_poly

from dofkit.base.errors import PoleError
from dofkit.exact.residues import Residue, ResiduePolynomial, modulus, residue_polynomial
from dofkit.exact.ring.program import Scalar, TooLargeError, Var

#: Bound on the number of partial derivatives in the Taylor polynomial of an unknown function.
MAX_JET = 400


class Series:
    """A power series in s modulo s^order; ``poly`` is a ResiduePolynomial or an arb_poly."""

    __slots__ = ("order", "poly")

    def __init__(self, poly: Any, order: int) -> None:
        self.poly = poly
        self.order = order

    def __add__(self, other: Any) -> Series:
        return Series(self.poly + (other.poly if isinstance(other, Series) else other), self.order)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Series:
        return Series(self.poly - (other.poly if isinstance(other, Series) else other), self.order)

    def __neg__(self) -> Series:
        return Series(-self.poly, self.order)

    def __mul__(self, other: Any) -> Series:
        if isinstance(other, Series):
            return Series(_mul_low(self.poly, other.poly, self.order), self.order)
        return Series(self.poly * other, self.order)

    __rmul__ = __mul__

    def __pow__(self, n: int) -> Series:
        total = self
        for _ in range(n - 1):
            total = total * self
        return total

    def inverse(self) -> Series:
        """Return 1/self; raises PoleError if the constant term is 0, or a ball that contains 0."""
        if not self.invertible:
            raise PoleError("a series without constant term has no inverse")
        if isinstance(self.poly, ResiduePolynomial):
            return Series(self.poly.inverse_series_trunc(self.order), self.order)
        first = 1 / self.poly[0]
        coefficients = [first]
        for k in range(1, self.order):
            coefficients.append(-first * sum((self.poly[j] * coefficients[k - j] for j in range(1, k + 1)), arb(0)))
        return Series(arb_poly(coefficients), self.order)

    def __truediv__(self, other: Series) -> Series:
        return Series(_mul_low(self.poly, other.inverse().poly, self.order), self.order)

    def __rtruediv__(self, other: Any) -> Series:
        return Series(self.inverse().poly * other, self.order)

    @property
    def invertible(self) -> bool:
        """Whether the constant term is certainly not 0."""
        head = self.poly[0]
        return not head.contains(0) if isinstance(head, arb) else head != 0

    def coefficient(self, k: int) -> Scalar:
        return self.poly[k]

    def truncated(self, order: int) -> Series:
        """Return the series modulo s^order."""
        return Series(self.poly.truncate(order), order)

    def derivative(self) -> Series:
        return Series(self.poly.derivative(), self.order)

    def integral(self, constant: Scalar) -> Series:
        """Return the antiderivative with the given constant term, to the same order."""
        poly = self.poly.integral()
        return Series(poly.truncate(self.order) + constant, self.order)


def _mul_low(a: Any, b: Any, order: int) -> Any:
    return a.mul_low(b, order) if isinstance(a, ResiduePolynomial) else (a * b).truncate(order)


class SeriesPoint:
    """A curve in s: ``symbols`` are series by generator index; other generators are expanded by their derivatives.

    ``base``: the point s = 0, at which the program has been run; ``like``: a polynomial of the type of the series.
    """

    def __init__(self, base: Any, symbols: Mapping[int, Series], order: int, like: Any) -> None:
        self.base = base
        self.symbols = symbols
        self.order = order
        self.like = like
        self._circles: dict[tuple[str, object], Series] = {}

    def constant(self, value: Scalar) -> Series:
        return Series(self.like * 0 + value, self.order)

    def number(self, value: Fraction) -> Series:
        return self.constant(self.base.number(value))

    def generator(self, var: Var, args: Sequence[Series]) -> Series:
        if var.kind == "symbol":
            series = self.symbols.get(var.index)
            return self.constant(self.base.generator(var, ())) if series is None else series
        head = self.base.generator(var, [a.coefficient(0) for a in args])
        if var.kind == "sign" and not args[0].invertible and args[0].poly.degree() > 0:
            raise PoleError("a sign changes where the series begins")
        if var.kind in ("pi", "sign"):
            return self.constant(head)
        if all(a.poly.degree() < 1 for a in args):
            return self.constant(head)
        return self._transcendental(var, args, head)

    def _transcendental(self, var: Var, args: Sequence[Series], head: Scalar) -> Series:
        """Return the series of a function of ``args`` with the value ``head`` at s = 0."""
        u = args[0]
        if var.kind == "exp":
            return self._exponential(u.derivative(), head)
        if var.kind in ("cos", "sin"):
            return self._circle(var, u, head)
        if var.kind == "log":
            return (u.derivative() / u).integral(head)
        if var.kind == "root":
            return self._exponential(u.derivative() / (u * self.base.number(Fraction(var.degree))), head)
        if var.kind == "atan":
            return (u.derivative() / (u * u + 1)).integral(head)
        if var.kind == "asin":
            return (u.derivative() / args[1]).integral(head)
        if var.kind == "atan2":
            x = args[1]
            return ((x * u.derivative() - u * x.derivative()) / (x * x + u * u)).integral(head)
        return self._call(var, args)

    def _exponential(self, slope: Series, head: Scalar) -> Series:
        """Return the series y with y' = slope y and y(0) = ``head``."""
        coefficients = [head]
        for k in range(1, self.order):
            total = sum((slope.poly[j] * coefficients[k - 1 - j] for j in range(k)), head * 0)
            coefficients.append(total / k)
        return self._series(coefficients)

    def _circle(self, var: Var, u: Series, head: Scalar) -> Series:
        """Return the series of cos u or sin u by cos' = -u' sin, sin' = u' cos; the other one is kept for its call."""
        earlier = self._circles.get((var.kind, var.key))
        if earlier is not None:
            return earlier
        kind = "sin" if var.kind == "cos" else "cos"
        partner = self.base.generator(Var(var.partner, kind, var.key, var.args, var.index), [u.coefficient(0)])
        slope, coefficients, other = u.derivative().poly.coeffs(), [head], [partner]
        sign = -1 if var.kind == "cos" else 1
        for k in range(1, self.order):
            a = b = head * 0
            for j in range(min(k, len(slope))):
                a = a + slope[j] * other[k - 1 - j]
                b = b + slope[j] * coefficients[k - 1 - j]
            coefficients.append(a * sign / k)
            other.append(-b * sign / k)
        self._circles[kind, var.key] = self._series(other)
        return self._series(coefficients)

    def _call(self, var: Var, args: Sequence[Series]) -> Series:
        """Return the series of an unknown function by Taylor's formula, with the derivatives' values at ``base``."""
        name, orders, key = var.key
        heads = [a.coefficient(0) for a in args]
        moved = [a - h for a, h in zip(args, heads, strict=True)]
        total = self.constant(heads[0] * 0)
        for extra in _multi_indices(len(args), self.order - 1):
            raised = tuple(o + e for o, e in zip(orders, extra, strict=True))
            term = self.constant(self.base.generator(Var(-1, "call", (name, raised, key), var.args), heads))
            for power, m in zip(extra, moved, strict=True):
                if power:
                    term = term * (m**power) * self.base.number(Fraction(1, factorial(power)))
            total = total + term
        return total

    def _series(self, coefficients: list[Scalar]) -> Series:
        if isinstance(self.like, ResiduePolynomial):
            return Series(residue_polynomial([int(c) for c in coefficients], modulus(self.like)), self.order)
        return Series(arb_poly(coefficients), self.order)


def _multi_indices(n: int, total: int) -> list[tuple[int, ...]]:
    """Return the n-tuples of orders with a sum of at most ``total``; raises TooLargeError for more than `MAX_JET`."""
    if comb(n + total, n) > MAX_JET:
        raise TooLargeError
    if n == 1:
        return [(k,) for k in range(total + 1)]
    return [(k, *others) for k in range(total + 1) for others in _multi_indices(n - 1, total - k)]


def zero_poly(sample: Scalar) -> Any:
    """Return the zero polynomial with coefficients of the type of ``sample``."""
    return residue_polynomial([0], modulus(sample)) if isinstance(sample, Residue) else arb_poly([])


def monomial(like: Any) -> Any:
    """Return the polynomial s, of the type of the polynomial ``like``."""
    return residue_polynomial([0, 1], modulus(like)) if isinstance(like, ResiduePolynomial) else arb_poly([0, 1])
