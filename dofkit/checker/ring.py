"""Normal forms of expressions: quotients of polynomials with rational coefficients in generators.

Generators are symbols, pi, cosines and sines of atoms of an argument (s^2 = 1 - c^2; sums and whole multiples are
expanded), roots (w^k = u), exponentials of atoms, |u| (w^2 = u^2), and every other function as an opaque name with the
normal forms of its arguments. A rule w^k = u is made of generators that were there before w, so one pass from the last
to the first uses all. Every rewrite is an identity of real numbers wherever both sides have a value. So what has the
normal form 0 is 0 wherever it has a value; the converse is never used.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import lcm
from typing import Any, NamedTuple, TypeVar

from flint import fmpq, fmpq_mpoly_ctx, fmpz

from dofkit.checker.trees import CheckError, Effort, Tree, refuse

LARGEST_POWER, LARGEST_FORM, MOST_GENERATORS = 128, 60_000, 1000
LARGEST_MULTIPLE, FINEST, MOST_KNOWN = 64, 24, 20_000
Factor = TypeVar("Factor")


class _AgainError(Exception):
    """More generators, or a finer division of an argument: what was read is forgotten, and all is read again."""


class Quotient(NamedTuple):
    """A numerator and a denominator that is not the polynomial 0."""

    above: Any
    below: Any


def repeated(one: Factor, base: Factor, exponent: int, product: Callable[[Factor, Factor], Factor]) -> Factor:
    """A power by squaring."""
    found = one
    for bit in bin(exponent)[2:]:
        found = product(found, found)
        found = product(found, base) if bit == "1" else found
    return found


class QuotientRing:
    """Arithmetic of quotients, reduced by rules."""

    def __init__(self, effort: Effort) -> None:
        self.effort = effort
        self.places: dict[Any, int] = {}
        self._forget(64)

    def _forget(self, slots: int) -> None:
        """A ring with room for so many generators, in which nothing was read; known ones keep their places."""
        self.slots = slots
        self.context = fmpq_mpoly_ctx.get([f"g{i}" for i in range(slots)], "lex")
        self.generators, self.one = self.context.gens(), self.context.constant(1)
        self.rules: dict[int, tuple[int, Quotient]] = {}
        self.inverses: dict[int, tuple[str, tuple[Quotient, ...]]] = {}
        self.memory: dict[int, tuple[Tree, Quotient]] = {}

    def constant(self, value: Fraction | int) -> Quotient:
        """A rational number."""
        return Quotient(self.context.constant(fmpq(value.numerator, value.denominator)), self.one)

    def generator(self, key: Any, rule: tuple[int, Quotient] | None = None) -> Quotient:
        """The generator of a key, new or known, with its rule."""
        if key not in self.places:
            if len(self.places) == self.slots:
                refuse(self.slots > MOST_GENERATORS, "too many functions and symbols")
                self._forget(2 * self.slots)
                raise _AgainError
            self.places[key] = len(self.places)
        if rule is not None:
            self.rules.setdefault(self.places[key], rule)
        return Quotient(self.generators[self.places[key]], self.one)

    def _product(self, first: Any, second: Any) -> Any:
        cost = len(first) * len(second)
        self.effort.spend(cost + 1)
        refuse(cost > 100 * LARGEST_FORM, "an expression is too large to be multiplied out")
        found = first * second
        refuse(len(found) > LARGEST_FORM, "an expression is too large when it is multiplied out")
        return found

    def times(self, first: Quotient, second: Quotient) -> Quotient:
        """A product."""
        return self._reduced(self._product(first.above, second.above), self._product(first.below, second.below))

    def plus(self, first: Quotient, second: Quotient) -> Quotient:
        """A sum."""
        (a, b), (c, d) = first, second
        if b == d:
            return self._reduced(a + c, b)
        common = b.gcd(d) if len(b) + len(d) < 400 else self.one
        left, right = d / common, b / common
        return self._reduced(self._product(a, left) + self._product(c, right), self._product(b, left))

    def minus(self, first: Quotient, second: Quotient) -> Quotient:
        """A difference."""
        return self.plus(first, Quotient(-second.above, second.below))

    def over(self, first: Quotient, second: Quotient) -> Quotient:
        """A quotient of quotients."""
        refuse(second.above == 0, "a denominator is 0 everywhere")
        return self.times(first, Quotient(second.below, second.above))

    def to_power(self, base: Quotient, exponent: int) -> Quotient:
        """A whole power."""
        refuse(abs(exponent) > LARGEST_POWER, "a power is too large")
        found = repeated(self.constant(1), base, abs(exponent), self.times)
        return self.over(self.constant(1), found) if exponent < 0 else found

    def _reduced(self, above: Any, below: Any) -> Quotient:
        """Powers of roots and sines replaced, the latest generators first."""
        (above, up), (below, down) = self._replaced(above), self._replaced(below)
        above, below = self._product(above, down), self._product(below, up)
        refuse(below == 0, "a denominator is 0 everywhere")
        if above == 0:
            return Quotient(above, self.one)
        if not below.is_constant() and len(above) * len(below) < 20_000:
            self.effort.spend(len(above) * len(below) // 10)
            common = above.gcd(below)
            above, below = (above / common, below / common) if not common.is_constant() else (above, below)
        lead = below.leading_coefficient()
        return Quotient(above / lead, below / lead) if lead != 1 else Quotient(above, below)

    def _replaced(self, polynomial: Any) -> tuple[Any, Any]:
        """A polynomial with all rules used, as numerator and denominator."""
        under, degrees = self.one, polynomial.degrees()
        for place in sorted(self.rules, reverse=True):
            order, rule = self.rules[place]
            if degrees[place] < order:
                continue
            self.effort.spend(len(polynomial))
            parts: dict[int, dict[tuple[int, ...], Any]] = {}
            for exponents, coefficient in polynomial.to_dict().items():
                count, rest = divmod(exponents[place], order)
                parts.setdefault(count, {})[(*exponents[:place], rest, *exponents[place + 1 :])] = coefficient
            most, found = max(parts), self.context.constant(0)
            for count, terms in parts.items():
                above = repeated(self.one, rule.above, count, self._product)
                below = repeated(self.one, rule.below, most - count, self._product)
                found += self._product(self.context.from_dict(terms), self._product(above, below))
            polynomial = found
            under = self._product(under, repeated(self.one, rule.below, most, self._product))
            degrees = polynomial.degrees()
        return polynomial, under

    def key(self, quotient: Quotient) -> Any:
        """A quotient as something that can be compared: the same key, the same quotient, in whatever slots."""
        return tuple(
            tuple(sorted((tuple(k for k in enumerate(e) if k[1]), (int(c.p), int(c.q))) for e, c in part.terms()))
            for part in quotient
        )

    def value_of(self, quotient: Quotient) -> Any:
        """The rational number that a quotient is, or None."""
        above, below = quotient
        if not (above.is_constant() and below.is_constant()):
            return None
        return above.leading_coefficient() / below.leading_coefficient() if above != 0 else fmpq(0)

    def root(self, u: Quotient, order: int) -> Quotient:
        """The root of a quantity that is not negative: w^order = u."""
        value = self.value_of(u)
        if value is not None:
            refuse(value < 0, "a root of a negative number")
            return self._number_root(value, order) if value != 0 else u
        size = abs(u.above.leading_coefficient() / u.below.leading_coefficient())
        rest = Quotient(u.above / size, u.below)
        return self.times(
            self.generator(("root", order, self.key(rest)), (order, rest)), self._number_root(size, order)
        )

    def _number_root(self, value: Any, order: int) -> Quotient:
        whole = fmpz(value.p) * fmpz(value.q) ** (order - 1)
        primes = whole.factor() if int(whole).bit_length() <= 128 else [(whole, 1)]
        found = self.constant(Fraction(1, int(value.q)))
        for prime, exponent in primes:
            outside, inside = divmod(int(exponent), order)
            found = self.times(found, self.constant(int(prime) ** outside))
            if inside:
                root = self.generator(("root", order, int(prime)), (order, self.constant(int(prime))))
                found = self.times(found, self.to_power(root, inside))
        return found


class CheckedRing(QuotientRing):
    """The ring that grows with what is read into it."""

    def __init__(self, effort: Effort) -> None:
        super().__init__(effort)
        self.levels: dict[Any, int] = {}

    def vanishes(self, tree: Tree) -> bool:
        """Whether the normal form is 0: then the tree is 0 wherever it has a value."""
        return bool(self.normal(tree).above == 0)

    def rational(self, tree: Tree) -> Fraction | None:
        """The rational number that a tree is, where its normal form is one."""
        value = self.value_of(self.normal(tree))
        return None if value is None else Fraction(int(value.p), int(value.q))

    def normal(self, tree: Tree) -> Quotient:
        """The normal form of a tree."""
        for _ in range(200):
            try:
                if len(self.memory) > MOST_KNOWN:
                    self.memory.clear()
                return self.read(tree)
            except _AgainError:
                self.memory.clear()
        raise CheckError("arguments are divided too finely")

    def read(self, tree: Tree) -> Quotient:
        """The normal form of one node, from those below it."""
        if id(tree) not in self.memory:
            self.effort.spend(1)
            self.memory[id(tree)] = (tree, self._read(tree))
        return self.memory[id(tree)][1]

    def _read(self, tree: Tree) -> Quotient:
        head = tree.head
        if isinstance(tree.value, Fraction):
            return self.constant(tree.value)
        if head in ("symbol", "pi"):
            return self.generator((head, tree.value))
        below = [self.read(part) for part in tree.below]
        if head in ("sum", "product"):
            found = self.constant(0 if head == "sum" else 1)
            for part in below:
                found = self.plus(found, part) if head == "sum" else self.times(found, part)
            return found
        exponent = tree.below[1].value if head == "power" else None
        if isinstance(exponent, Fraction):
            if exponent.denominator == 1:
                return self.to_power(below[0], int(exponent))
            refuse(exponent.denominator > LARGEST_MULTIPLE, "a root of too high an order")
            return self.to_power(self.root(below[0], exponent.denominator), exponent.numerator)
        return self._function(tree, below)

    def _function(self, tree: Tree, below: list[Quotient]) -> Quotient:
        head, u, one = tree.head, below[0], self.constant(1)
        if head in ("sin", "cos", "tan", "cot", "sec", "csc"):
            cosine, sine = self._turned(u)
            top = {"sin": sine, "cos": cosine, "tan": sine, "cot": cosine}.get(head, one)
            return self.over(top, {"tan": cosine, "sec": cosine, "cot": sine, "csc": sine}.get(head, one))
        if head in ("exp", "sinh", "cosh", "tanh"):
            return self._exponential(head, u)
        if head == "sqrt":
            return self.root(u, 2)
        if head == "abs":
            return self.generator(("abs", self.key(u)), (2, self.times(u, u)))
        if self._is_zero_at(head, below):
            return self.constant(0)
        key = (head, tree.value, tree.orders, tuple(map(self.key, below)))
        found = self.generator(key)
        if head in ("asin", "acos", "atan", "atan2", "log"):
            self.inverses[self.places[key]] = (head, tuple(below))
        return found

    def _is_zero_at(self, head: str, below: list[Quotient]) -> bool:
        """log 1, acos 1, asin 0, atan 0 and atan2(0, x), x a positive number."""
        value, other = self.value_of(below[0]), self.value_of(below[-1])
        if head == "atan2":
            return value == 0 and other is not None and bool(other > 0)
        return value is not None and bool(value == {"log": 1, "acos": 1, "asin": 0, "atan": 0}.get(head))

    def _atoms(self, kind: str, u: Quotient) -> list[tuple[Quotient, Any, int, int]]:
        """An argument as a sum of whole multiples of atoms: (atom, its key, its division, the multiple)."""
        found, lead = [], u.below.leading_coefficient()
        terms = list(u.above.terms()) if u.below.is_constant() else [(None, u.above.leading_coefficient())]
        for exponents, coefficient in terms:
            size = coefficient / lead
            whole = u.above / coefficient if exponents is None else self.context.from_dict({exponents: fmpq(1)})
            atom = Quotient(whole, u.below if exponents is None else self.one)
            finest = int(size.q)
            if finest > FINEST:
                atom, size, finest = Quotient(whole / finest, atom.below), size * finest, 1
            key = (kind, self.key(atom))
            level = self.levels.setdefault(key, finest)
            if level % finest:
                self.levels[key] = lcm(level, finest)
                raise _AgainError
            multiple = int((size * level).p)
            refuse(abs(multiple) > LARGEST_MULTIPLE * level, "too large a multiple in an argument")
            found.append((atom, key, level, multiple))
        return found

    def _inverse_of(self, atom: Quotient, level: int) -> tuple[str, tuple[Quotient, ...]]:
        """What an atom is the arcsine, logarithm, ... of."""
        for place, found in self.inverses.items():
            if level == 1 and atom == (self.generators[place], self.one):
                return found
        return "", (atom,)

    def _turned(self, u: Quotient) -> tuple[Quotient, Quotient]:
        """Cosine and sine of an argument."""
        found = still = (self.constant(1), self.constant(0))
        for atom, key, level, multiple in self._atoms("angle", u):
            cosine, sine = repeated(still, self._unit(atom, key, level), abs(multiple), self._rotated)
            found = self._rotated(found, (cosine, Quotient(-sine.above, sine.below) if multiple < 0 else sine))
        return found

    def _rotated(self, one: tuple[Quotient, Quotient], by: tuple[Quotient, Quotient]) -> tuple[Quotient, Quotient]:
        (c, s), (d, r) = one, by
        return self.minus(self.times(c, d), self.times(s, r)), self.plus(self.times(s, d), self.times(c, r))

    def _unit(self, atom: Quotient, key: Any, level: int) -> tuple[Quotient, Quotient]:
        """Cosine and sine of an atom divided by its level."""
        one = self.constant(1)
        if 12 % level == 0 and ("pi", "") in self.places and atom == self.generator(("pi", "")):
            return repeated((one, self.constant(0)), self._twelfth(), 12 // level, self._rotated)
        head, (u, *more) = self._inverse_of(atom, level)
        if head in ("asin", "acos"):
            other = self.root(self.minus(one, self.times(u, u)), 2)
            return (other, u) if head == "asin" else (u, other)
        if head in ("atan", "atan2"):
            x = more[0] if more else one
            size = self.root(self.plus(self.times(x, x), self.times(u, u)), 2)
            return self.over(x, size), self.over(u, size)
        cosine = self.generator(("cos", level, key))
        return cosine, self.generator(("sin", level, key), (2, self.minus(one, self.times(cosine, cosine))))

    def _twelfth(self) -> tuple[Quotient, Quotient]:
        """Cosine and sine of pi / 12: (sqrt(6) +- sqrt(2)) / 4."""
        six, two = (self.over(self._number_root(fmpq(k), 2), self.constant(4)) for k in (6, 2))
        return self.plus(six, two), self.minus(six, two)

    def _exponential(self, head: str, u: Quotient) -> Quotient:
        found = self.constant(1)
        for atom, key, level, multiple in self._atoms("exponent", u):
            inverse, (argument, *_) = self._inverse_of(atom, level)
            base = argument if inverse == "log" else self.generator(("exp", level, key))
            found = self.times(found, self.to_power(base, multiple))
        back = self.over(self.constant(1), found)
        double = {"sinh": self.minus(found, back), "cosh": self.plus(found, back)}
        if head == "tanh":
            return self.over(double["sinh"], double["cosh"])
        return self.over(double[head], self.constant(2)) if head in double else found
