"""Normal forms of expressions: quotients of polynomials with rational coefficients in generators.

Generators are symbols, pi, cosines and sines of atoms of an argument (s^2 = 1 - c^2; sums and whole multiples are
expanded), roots (w^k = u), exponentials of atoms, |u| (w^2 = u^2), and every other function as an opaque name with the
normal forms of its arguments. Every rewrite is an identity of real numbers wherever both sides have a value. So what
has the normal form 0 is 0 wherever it has a value; the converse is never used.
"""

from __future__ import annotations

from fractions import Fraction
from math import lcm
from typing import Any, NamedTuple

from flint import fmpq, fmpq_mpoly_ctx, fmpz

from dofkit.checker.effort import Effort
from dofkit.checker.errors import CheckError
from dofkit.checker.trees import Tree

LARGEST_POWER, LARGEST_MULTIPLE, FINEST, LARGEST_FORM = 128, 64, 24, 60_000
_FIRST_SLOTS = 32


class _FinerError(Exception):
    """A part of an argument was met in a finer division than before: all is read again."""


class Quotient(NamedTuple):
    """A numerator and a denominator that is not the polynomial 0."""

    above: Any
    below: Any


class CheckedRing:
    """The ring that grows with what is read into it."""

    def __init__(self, effort: Effort) -> None:
        self.effort = effort
        self.places: dict[Any, int] = {}
        self.rules: dict[int, tuple[int, Quotient]] = {}
        self.inverses: dict[int, tuple[str, tuple[Quotient, ...]]] = {}
        self.levels: dict[Any, int] = {}
        self.memory: dict[int, tuple[Tree, Quotient]] = {}
        self._grow(_FIRST_SLOTS)

    def vanishes(self, tree: Tree) -> bool:
        """Whether the normal form is 0: then the tree is 0 wherever it has a value."""
        return bool(self.normal(tree).above == 0)

    def normal(self, tree: Tree) -> Quotient:
        """The normal form of a tree."""
        if len(self.memory) > 20_000:
            self.memory.clear()
        for _ in range(200):
            try:
                return self._fresh(self.read(tree))
            except _FinerError:
                self.memory.clear()
        raise CheckError("arguments are divided too finely")

    def rational(self, tree: Tree) -> Fraction | None:
        """The rational number that a tree is, where its normal form is one."""
        above, below = self.normal(tree)
        if not (above.is_constant() and below.is_constant()):
            return None
        value = self._number(above) / self._number(below)
        return Fraction(int(value.p), int(value.q))

    def _grow(self, slots: int) -> None:
        self.context = fmpq_mpoly_ctx.get([f"g{i}" for i in range(slots)], "lex")
        self.slots = slots
        self.generators = self.context.gens()
        self.one = self.context.constant(1)

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
                if self.slots > 1000:
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
        under = self.one
        for place in sorted(self.rules, reverse=True):
            order, (above, below) = self.rules[place][0], self._fresh(self.rules[place][1])
            if polynomial.degrees()[place] < order:
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

    def read(self, tree: Tree) -> Quotient:
        """The normal form of one node, from those below it."""
        known = self.memory.get(id(tree))
        if known is None:
            self.effort.spend(1)
            known = self.memory[id(tree)] = (tree, self._read(tree))
        return known[1]

    def _read(self, tree: Tree) -> Quotient:
        head = tree.head
        if isinstance(tree.value, Fraction):
            return self.constant(tree.value)
        if head in ("symbol", "pi"):
            return self.generator((head, tree.value))
        if head == "power":
            return self._power(tree.below[0], tree.below[1])
        below = [self.read(part) for part in tree.below]
        if head in ("sum", "product"):
            found = self.constant(0 if head == "sum" else 1)
            for part in below:
                found = self.plus(found, part) if head == "sum" else self.times(found, part)
            return found
        return self._function(tree, below)

    def _function(self, tree: Tree, below: list[Quotient]) -> Quotient:
        head, u = tree.head, below[0]
        if head in ("sin", "cos", "tan", "cot", "sec", "csc"):
            cosine, sine = self._turned(u)
            top = {"sin": sine, "cos": cosine, "tan": sine, "cot": cosine}.get(head, self.constant(1))
            under = {"tan": cosine, "sec": cosine, "cot": sine, "csc": sine}.get(head)
            return top if under is None else self.times(top, self.inverse(under))
        if head in ("exp", "sinh", "cosh", "tanh"):
            return self._exponential(head, u)
        if head == "sqrt":
            return self.root(u, 2)
        if head == "abs":
            found = self.generator(("abs", self.key(u)))
            self.rules.setdefault(self.places[("abs", self.key(u))], (2, self.times(u, u)))
            return found
        if head == "log" and u == self.constant(1):
            return self.constant(0)
        key = (head, tree.value, tree.orders, tuple(self.key(part) for part in below))
        found = self.generator(key)
        if head in ("asin", "acos", "atan", "atan2", "log"):
            self.inverses[self.places[key]] = (head, tuple(below))
        return found

    def _power(self, base: Tree, exponent: Tree) -> Quotient:
        value = exponent.value
        if isinstance(value, Fraction):
            if value.denominator == 1:
                return self.to_power(self.read(base), int(value))
            if value.denominator > LARGEST_MULTIPLE:
                raise CheckError("a root of too high an order")
            return self.to_power(self.root(self.read(base), value.denominator), value.numerator)
        return self.generator(("power", self.key(self.read(base)), self.key(self.read(exponent))))

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
        self.rules.setdefault(self.places[key], (order, rest))
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

    def _atoms(self, kind: str, u: Quotient) -> list[tuple[Quotient, Any, int, int]]:
        """An argument as a sum of whole multiples of atoms: (atom, its key, its division, the multiple)."""
        u = self._fresh(u)
        found = []
        terms = list(u.above.to_dict().items()) if u.below.is_constant() else [(None, u.above.leading_coefficient())]
        for exponents, coefficient in terms:
            size = coefficient / u.below.leading_coefficient()
            if exponents is None:
                atom = Quotient(u.above / coefficient, u.below)
            else:
                atom = Quotient(self.context.from_dict({exponents: fmpq(1)}), self.one)
            key, finest = (kind, self.key(atom)), int(size.q)
            if finest > FINEST:
                atom = self.times(atom, self.constant(Fraction(1, finest)))
                key, size, finest = (kind, self.key(atom)), size * finest, 1
            level = self.levels.setdefault(key, finest)
            if level % finest:
                self.levels[key] = lcm(level, finest)
                raise _FinerError
            multiple = int((size * level).p)
            if abs(multiple) > LARGEST_MULTIPLE * level:
                raise CheckError("too large a multiple in an argument")
            found.append((atom, key, level, multiple))
        return found

    def _inverse_of(self, atom: Quotient) -> tuple[str, tuple[Quotient, ...]]:
        """What an atom is the arcsine, logarithm, ... of."""
        for place, found in self.inverses.items():
            if atom == (self.generators[place], self.one):
                return found
        return "", ()

    def _turned(self, u: Quotient) -> tuple[Quotient, Quotient]:
        """Cosine and sine of an argument."""
        cosine, sine = self.constant(1), self.constant(0)
        for atom, key, level, multiple in self._atoms("angle", u):
            step = self._unit(atom, key, level)
            if multiple < 0:
                step = (step[0], self.times(step[1], self.constant(-1)))
            for bit in range(abs(multiple).bit_length()):
                if abs(multiple) >> bit & 1:
                    cosine, sine = self._rotated((cosine, sine), step)
                step = self._rotated(step, step)
        return cosine, sine

    def _rotated(self, one: tuple[Quotient, Quotient], by: tuple[Quotient, Quotient]) -> tuple[Quotient, Quotient]:
        (c, s), (d, r) = one, by
        back = self.times(self.constant(-1), self.times(s, r))
        return self.plus(self.times(c, d), back), self.plus(self.times(s, d), self.times(c, r))

    def _unit(self, atom: Quotient, key: Any, level: int) -> tuple[Quotient, Quotient]:
        """Cosine and sine of an atom divided by its level."""
        if ("pi", "") in self.places and atom == self.generator(("pi", "")) and 12 % level == 0:
            twelfth = self._twelfth()
            found = (self.constant(1), self.constant(0))
            for _ in range(12 // level):
                found = self._rotated(found, twelfth)
            return found
        head, (u, *more) = self._inverse_of(atom) if level == 1 and self._inverse_of(atom)[0] else ("", (atom,))
        if head in ("asin", "acos"):
            other = self.root(self.plus(self.constant(1), self.times(self.constant(-1), self.times(u, u))), 2)
            return (other, u) if head == "asin" else (u, other)
        if head in ("atan", "atan2"):
            x = more[0] if more else self.constant(1)
            over = self.inverse(self.root(self.plus(self.times(x, x), self.times(u, u)), 2))
            return self.times(x, over), self.times(u, over)
        cosine = self.generator(("cos", level, key))
        sine = self.generator(("sin", level, key))
        square = self.plus(self.constant(1), self.times(self.constant(-1), self.times(cosine, cosine)))
        self.rules.setdefault(self.places[("sin", level, key)], (2, square))
        return self._fresh(cosine), sine

    def _twelfth(self) -> tuple[Quotient, Quotient]:
        """Cosine and sine of pi / 12: (sqrt(6) +- sqrt(2)) / 4."""
        six, two = self._number_root(fmpq(6), 2), self._number_root(fmpq(2), 2)
        quarter, minus = self.constant(Fraction(1, 4)), self.constant(-1)
        return self.times(quarter, self.plus(six, two)), self.times(quarter, self.plus(six, self.times(minus, two)))

    def _exponential(self, head: str, u: Quotient) -> Quotient:
        found = self.constant(1)
        for atom, key, level, multiple in self._atoms("exponent", u):
            inverse = self._inverse_of(atom) if level == 1 else ("", ())
            base = inverse[1][0] if inverse[0] == "log" else self.generator(("exp", level, key))
            found = self.times(found, self.to_power(base, multiple))
        if head == "exp":
            return found
        back = self.inverse(found)
        difference, total = self.plus(found, self.times(self.constant(-1), back)), self.plus(found, back)
        if head == "tanh":
            return self.times(difference, self.inverse(total))
        return self.times(self.constant(Fraction(1, 2)), difference if head == "sinh" else total)


def _trimmed(exponents: tuple[int, ...]) -> tuple[int, ...]:
    """Exponents without the zeros at the end, so that a larger ring has the same keys."""
    last = max((i + 1 for i, exponent in enumerate(exponents) if exponent), default=0)
    return tuple(exponents[:last])
