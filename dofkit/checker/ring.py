"""Normal forms of expressions: quotients of polynomials with rational coefficients in generators.

Generators are symbols, pi, cosines and sines of atoms of an argument (s^2 = 1 - c^2; sums and whole multiples are
expanded), roots (w^k = u), exponentials of atoms, and every other function as an opaque name with the normal forms of
its arguments. A rule w^k = u is made of generators that were there before w, which are smaller in the order of terms:
division by w^k - u uses it wherever it can be used, and one pass from the last to the first uses all. Every rewrite is
an identity of real numbers wherever both sides have a value. So what has the normal form 0 is 0 wherever it has a
value; the converse is never used.
"""

from collections.abc import Iterator
from fractions import Fraction
from functools import reduce
from typing import Any, NamedTuple

from flint import fmpq, fmpq_mpoly_ctx, fmpz

from dofkit.checker.trees import CheckError, Effort, Tree, refuse, repeated

LARGEST_POWER, LARGEST_FORM, LARGEST_MULTIPLE, MOST_KNOWN = 128, 60_000, 64, 20_000


class Quotient(NamedTuple):
    """A numerator and a denominator that is not the polynomial 0."""

    above: Any
    below: Any


class QuotientRing:
    """Arithmetic of quotients, reduced by rules."""

    def __init__(self, effort: Effort, symbols: int = 0) -> None:
        self.effort = effort
        self.context = fmpq_mpoly_ctx.get([f"g{i}" for i in range(64 + symbols)], "lex")
        self.generators, self.unit = self.context.gens()[::-1], self.context.constant(1)
        self.places: dict[Any, int] = {}
        self.rules: dict[int, tuple[int, Any]] = {}
        self.memory: dict[int, tuple[Tree, Quotient]] = {}

    def constant(self, value: Fraction | int) -> Quotient:
        """A rational number."""
        return Quotient(self.context.constant(fmpq(value.numerator, value.denominator)), self.unit)

    def generator(self, key: Any, order: int = 0, rule: Any = None) -> Quotient:
        """The generator of a key, new or known; its power of an order is the polynomial ``rule``."""
        place = self.places.setdefault(key, len(self.places))
        if place == len(self.generators):
            self.places, self.rules, self.memory = {}, {}, {}
            raise CheckError("too many functions and symbols")
        if order and place not in self.rules:
            self.rules[place] = order, self.generators[place] ** order - rule
        return Quotient(self.generators[place], self.unit)

    def _pay(self, first: Any, second: Any) -> None:
        self.effort.spend(len(first) * len(second) + 1)
        refuse(len(first) * len(second) > 100 * LARGEST_FORM, "an expression is too large to be multiplied out")

    def _product(self, first: Any, second: Any) -> Any:
        self._pay(first, second)
        return self._replaced(first * second)

    def _replaced(self, polynomial: Any) -> Any:
        """Powers of roots and sines replaced, the latest generators first."""
        degrees = polynomial.degrees()
        for place in sorted(self.rules, reverse=True):
            order, rule = self.rules[place]
            if degrees[-1 - place] >= order:
                self._pay(polynomial, rule)
                polynomial %= rule
                degrees = polynomial.degrees()
        refuse(len(polynomial) > LARGEST_FORM, "an expression is too large when it is multiplied out")
        return polynomial

    def times(self, first: Quotient, second: Quotient) -> Quotient:
        """A product."""
        return self._reduced(self._product(first.above, second.above), self._product(first.below, second.below))

    def plus(self, first: Quotient, second: Quotient) -> Quotient:
        """A sum."""
        (a, b), (c, d) = first, second
        if b == d:
            return self._reduced(a + c, b)
        return self._reduced(self._product(a, d) + self._product(c, b), self._product(b, d))

    def minus(self, first: Quotient, second: Quotient) -> Quotient:
        """A difference."""
        return self.plus(first, Quotient(-second.above, second.below))

    def to_power(self, base: Quotient, exponent: int) -> Quotient:
        """A whole power."""
        refuse(abs(exponent) > LARGEST_POWER, "a power is too large")
        power = repeated(self.constant(1), base, abs(exponent), self.times)
        return self._reduced(power.below, power.above) if exponent < 0 else power

    def _reduced(self, above: Any, below: Any) -> Quotient:
        """A quotient without common factors, where these are found at a moderate price."""
        refuse(below == 0, "a denominator is 0 everywhere")
        if above == 0:
            return Quotient(above, self.unit)
        if not below.is_constant() and len(above) * len(below) < 20_000:
            self.effort.spend(len(above) * len(below) // 10)
            common = above.gcd(below)
            above, below = above / common, below / common
        lead = below.leading_coefficient()
        return Quotient(above / lead, below / lead)

    def key(self, quotient: Quotient) -> Any:
        """A quotient as something that can be compared: the same key, the same quotient."""
        coefficients = [
            [(tuple(k for k in enumerate(e) if k[1]), int(c.p), int(c.q)) for e, c in p.terms()] for p in quotient
        ]
        return tuple(map(tuple, coefficients))

    def value_of(self, quotient: Quotient) -> Any:
        """The rational number that a quotient is, or None; a constant denominator is 1 in normal form."""
        above, below = quotient
        if above == 0:
            return fmpq(0)
        return above.leading_coefficient() if above.is_constant() and below.is_constant() else None

    def root(self, u: Quotient, order: int) -> Quotient:
        """The root of a quantity that is not negative: of a / b, by the generator b root(a / b)."""
        value = self.value_of(u)
        refuse(value is not None and value < 0, "a root of a negative number")
        if value is not None:
            return self._number_root(value, order) if value != 0 else u
        size = abs(u.above.leading_coefficient())
        radicand = Quotient(u.above / size, u.below)
        rule = self._product(radicand.above, repeated(self.unit, u.below, order - 1, self._product))
        symbol = self.generator(("root", order, self.key(radicand)), order, rule)
        return self.times(Quotient(symbol.above, u.below), self._number_root(size, order))

    def _number_root(self, value: Any, order: int) -> Quotient:
        whole = fmpz(value.p) * fmpz(value.q) ** (order - 1)
        self.effort.spend(int(whole).bit_length() ** 3 // 20)
        primes = whole.factor() if int(whole).bit_length() <= 128 else [(whole, 1)]
        product = self.constant(Fraction(1, int(value.q)))
        for prime, exponent in primes:
            outside, inside = divmod(int(exponent), order)
            root = self.generator(("root", order, int(prime)), order, fmpq(prime)) if inside else product
            product = self.times(product, self.times(self.constant(int(prime) ** outside), self.to_power(root, inside)))
        return product


class CheckedRing(QuotientRing):
    """The ring that grows with what is read into it."""

    def vanishes(self, tree: Tree) -> bool:
        """Whether the normal form is 0: then the tree is 0 wherever it has a value."""
        return bool(self.read(tree).above == 0)

    def rational(self, tree: Tree) -> Any:
        """The rational number that a tree is, where its normal form is one; else None."""
        return self.value_of(self.read(tree))

    def read(self, tree: Tree) -> Quotient:
        """The normal form of a tree, from those of what is below."""
        if id(tree) not in self.memory:
            self.effort.spend(1)
            if len(self.memory) > MOST_KNOWN:
                self.memory.clear()
            self.memory[id(tree)] = (tree, self._read(tree))
        return self.memory[id(tree)][1]

    def _read(self, tree: Tree) -> Quotient:
        """Return the normal form of a tree; a function without a rule here becomes a generator."""
        if isinstance(tree.value, Fraction):
            return self.constant(tree.value)
        head, below = tree.head, [self.read(part) for part in tree.below]
        if head == "sum":
            return reduce(self.plus, below)
        if head == "product":
            return reduce(self.times, below)
        exponent = tree.below[1].value if head == "power" else None
        if isinstance(exponent, Fraction):
            order = exponent.denominator
            refuse(order > LARGEST_MULTIPLE, "a root of too high an order")
            return self.to_power(below[0] if order == 1 else self.root(below[0], order), exponent.numerator)
        if head in ("sin", "cos"):
            return self._turned(below[0])[head == "sin"]
        if head == "exp":
            powers = (self.to_power(self.generator(("exp", *atom)), often) for *atom, often in self._atoms(below[0]))
            return reduce(self.times, powers, self.constant(1))
        values = [self.value_of(part) for part in below]
        if (head == "log" and values[0] == 1) or (head == "atan2" and values[0] == 0 and (values[1] or 0) > 0):
            return self.constant(0)
        return self.generator((head, tree.value, tree.orders, tuple(map(self.key, below))))

    def _atoms(self, u: Quotient) -> Iterator[tuple[Any, int, int]]:
        """An argument as a sum of multiples of parts of atoms: an atom's key, in how many parts, how often."""
        lead, whole = u.above.leading_coefficient(), u.below.is_constant()
        monomials = (
            [(self.context.from_dict({e: 1}), c) for e, c in u.above.terms()] if whole else [(u.above / lead, lead)]
        )
        for part, size in monomials:
            refuse(abs(size.p) > LARGEST_MULTIPLE, "too large a multiple in an argument")
            yield self.key(Quotient(part, u.below)), int(size.q), int(size.p)

    def _turned(self, u: Quotient) -> tuple[Quotient, Quotient]:
        """Cosine and sine of an argument."""
        turn = still = (self.constant(1), self.constant(0))
        for key, divisions, multiple in self._atoms(u):
            unit = self.generator(("cos", key, divisions))
            other = self.generator(("sin", key, divisions), 2, 1 - unit.above**2)
            cosine, sine = repeated(still, (unit, other), abs(multiple), self._rotated)
            turn = self._rotated(turn, (cosine, sine if multiple > 0 else self.minus(still[1], sine)))
        return turn

    def _rotated(self, turn: tuple[Quotient, Quotient], by: tuple[Quotient, Quotient]) -> tuple[Quotient, Quotient]:
        (c, s), (d, r) = turn, by
        return self.minus(self.times(c, d), self.times(s, r)), self.plus(self.times(s, d), self.times(c, r))
