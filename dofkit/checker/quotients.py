"""Quotients of polynomials with rational coefficients in generators that grow, reduced by rules w^k = u.

A rule's u is made of generators that were there before w, so one pass from the last generator to the first uses all.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

from flint import fmpq, fmpq_mpoly_ctx, fmpz

from dofkit.checker.effort import Effort
from dofkit.checker.errors import CheckError
from dofkit.checker.trees import Tree

LARGEST_POWER, LARGEST_FORM, MOST_GENERATORS = 128, 60_000, 1000
_FIRST_SLOTS = 64


class Quotient(NamedTuple):
    """A numerator and a denominator that is not the polynomial 0."""

    above: Any
    below: Any


class QuotientRing:
    """Arithmetic of quotients."""

    def __init__(self, effort: Effort) -> None:
        self.effort = effort
        self.places: dict[Any, int] = {}
        self.rules: dict[int, tuple[int, Quotient]] = {}
        self.inverses: dict[int, tuple[str, tuple[Quotient, ...]]] = {}
        self.memory: dict[int, tuple[Tree, Quotient]] = {}
        self._grow(_FIRST_SLOTS)

    def _grow(self, slots: int) -> None:
        self.context = fmpq_mpoly_ctx.get([f"g{i}" for i in range(slots)], "lex")
        self.slots = slots
        self.generators = self.context.gens()
        self.one = self.context.constant(1)
        self.rules = {place: (order, self._fresh(u)) for place, (order, u) in self.rules.items()}
        self.inverses = {p: (head, tuple(map(self._fresh, below))) for p, (head, below) in self.inverses.items()}
        self.memory.clear()

    def _lift(self, polynomial: Any) -> Any:
        return polynomial if polynomial.context() is self.context else polynomial.project_to_context(self.context)

    def _fresh(self, quotient: Quotient) -> Quotient:
        return Quotient(self._lift(quotient.above), self._lift(quotient.below))

    @staticmethod
    def _number(polynomial: Any) -> Any:
        return polynomial.leading_coefficient() if polynomial != 0 else fmpq(0)

    def constant(self, value: Fraction | int) -> Quotient:
        """A rational number."""
        value = Fraction(value)
        return Quotient(self.context.constant(fmpq(value.numerator, value.denominator)), self.one)

    def generator(self, key: Any) -> Quotient:
        """The generator of a key, new or known."""
        if key not in self.places:
            if len(self.places) == self.slots:
                if self.slots > MOST_GENERATORS:
                    raise CheckError("too many functions and symbols")
                self._grow(2 * self.slots)
            self.places[key] = len(self.places)
        return Quotient(self.generators[self.places[key]], self.one)

    def _product(self, first: Any, second: Any) -> Any:
        first, second = self._lift(first), self._lift(second)
        cost = len(first) * len(second)
        self.effort.spend(cost + 1)
        if cost > 100 * LARGEST_FORM:
            raise CheckError("an expression is too large to be multiplied out")
        found = first * second
        if len(found) > LARGEST_FORM:
            raise CheckError("an expression is too large when it is multiplied out")
        return found

    def times(self, first: Quotient, second: Quotient) -> Quotient:
        """A product."""
        return self._reduced(self._product(first.above, second.above), self._product(first.below, second.below))

    def plus(self, first: Quotient, second: Quotient) -> Quotient:
        """A sum."""
        (a, b), (c, d) = self._fresh(first), self._fresh(second)
        if b == d:
            return self._reduced(a + c, b)
        common = b.gcd(d) if len(b) + len(d) < 400 else self.one
        left, right = d / common, b / common
        return self._reduced(self._product(a, left) + self._product(c, right), self._product(b, left))

    def inverse(self, quotient: Quotient) -> Quotient:
        """One over a quotient."""
        if quotient.above == 0:
            raise CheckError("a denominator is 0 everywhere")
        return Quotient(quotient.below, quotient.above)

    def to_power(self, base: Quotient, exponent: int) -> Quotient:
        """A whole power."""
        if abs(exponent) > LARGEST_POWER:
            raise CheckError("a power is too large")
        if exponent < 0:
            return self.to_power(self.inverse(base), -exponent)
        found = self.constant(1)
        for bit in bin(exponent)[2:]:
            found = self.times(found, found)
            found = self.times(found, base) if bit == "1" else found
        return found

    def _reduced(self, above: Any, below: Any) -> Quotient:
        """Powers of roots and sines replaced, the latest generators first."""
        above, up = self._replaced(above)
        below, down = self._replaced(below)
        above, below = self._product(above, down), self._product(below, up)
        if below == 0:
            raise CheckError("a denominator is 0 everywhere")
        if above == 0:
            return Quotient(above, self.one)
        if not below.is_constant() and len(above) * len(below) < 20_000:
            common = above.gcd(below)
            above, below = (above / common, below / common) if not common.is_constant() else (above, below)
        lead = below.leading_coefficient()
        return Quotient(above / lead, below / lead) if lead != 1 else Quotient(above, below)

    def _replaced(self, polynomial: Any) -> tuple[Any, Any]:
        """A polynomial with all rules used, as numerator and denominator."""
        under, degrees = self.one, polynomial.degrees()
        for place in sorted(self.rules, reverse=True):
            order, (above, below) = self.rules[place]
            if degrees[place] < order:
                continue
            parts: dict[int, dict[tuple[int, ...], Any]] = {}
            for exponents, coefficient in polynomial.to_dict().items():
                count, rest = divmod(exponents[place], order)
                kept = (*exponents[:place], rest, *exponents[place + 1 :])
                parts.setdefault(count, {})[kept] = coefficient
            most, found = max(parts), self.context.constant(0)
            for count, terms in parts.items():
                factor = self._product(self._powered(above, count), self._powered(below, most - count))
                found += self._product(self.context.from_dict(terms), factor)
            polynomial, under = found, self._product(under, self._powered(below, most))
            degrees = polynomial.degrees()
        return polynomial, under

    def _powered(self, polynomial: Any, exponent: int) -> Any:
        found = self.one
        for _ in range(exponent):
            found = self._product(found, polynomial)
        return found

    def key(self, quotient: Quotient) -> Any:
        """A quotient as something that can be compared: the same key, the same quotient."""
        return tuple(
            tuple(sorted((_trimmed(e), (int(c.p), int(c.q))) for e, c in part.to_dict().items())) for part in quotient
        )

    def root(self, u: Quotient, order: int) -> Quotient:
        """The root of a quantity that is not negative: w^order = u."""
        u = self._fresh(u)
        if u.above == 0:
            return u
        lead = u.above.leading_coefficient() / u.below.leading_coefficient()
        if u.above.is_constant() and u.below.is_constant():
            if lead < 0:
                raise CheckError("a root of a negative number")
            return self._number_root(lead, order)
        size = abs(lead)
        rest = self.times(u, self.constant(Fraction(int(size.q), int(size.p))))
        key = ("root", order, self.key(rest))
        found = self.generator(key)
        self.rules.setdefault(self.places[key], (order, self._fresh(rest)))
        return self.times(found, self._number_root(size, order))

    def _number_root(self, value: Any, order: int) -> Quotient:
        whole = fmpz(value.p) * fmpz(value.q) ** (order - 1)
        primes = whole.factor() if int(whole).bit_length() <= 128 else [(whole, 1)]
        found = self.constant(Fraction(1, int(value.q)))
        for prime, exponent in primes:
            outside, inside = divmod(int(exponent), order)
            found = self.times(found, self.constant(int(prime) ** outside))
            if inside:
                key = ("root", order, int(prime))
                found = self.times(found, self.to_power(self.generator(key), inside))
                self.rules.setdefault(self.places[key], (order, self.constant(int(prime))))
        return found


def _trimmed(exponents: tuple[int, ...]) -> tuple[int, ...]:
    """Exponents without the zeros at the end, so that a larger ring has the same keys."""
    last = max((i + 1 for i, exponent in enumerate(exponents) if exponent), default=0)
    return tuple(exponents[:last])
