"""Normal forms of expressions: quotients of polynomials with rational coefficients in generators.

Generators are symbols, pi, cosines and sines of atoms of an argument (s^2 = 1 - c^2; sums and whole multiples are
expanded), roots (w^k = u), exponentials of atoms, |u| (w^2 = u^2), and every other function as an opaque name with the
normal forms of its arguments. Every rewrite is an identity of real numbers wherever both sides have a value. So what
has the normal form 0 is 0 wherever it has a value; the converse is never used.
"""

from __future__ import annotations

from fractions import Fraction
from math import lcm
from typing import Any

from flint import fmpq

from dofkit.checker.effort import Effort
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.quotients import Quotient, QuotientRing
from dofkit.checker.trees import Tree

LARGEST_MULTIPLE, FINEST = 64, 24


class _FinerError(Exception):
    """A part of an argument was met in a finer division than before: all is read again."""


class CheckedRing(QuotientRing):
    """The ring that grows with what is read into it."""

    def __init__(self, effort: Effort) -> None:
        super().__init__(effort)
        self.levels: dict[Any, int] = {}

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
            self.rules.setdefault(self.places[("abs", self.key(u))], (2, self._fresh(self.times(u, u))))
            return found
        if self._is_zero_at(head, below):
            return self.constant(0)
        key = (head, tree.value, tree.orders, tuple(self.key(part) for part in below))
        found = self.generator(key)
        if head in ("asin", "acos", "atan", "atan2", "log"):
            self.inverses[self.places[key]] = (head, tuple(below))
        return found

    def _is_zero_at(self, head: str, below: list[Quotient]) -> bool:
        """log 1, acos 1, asin 0, atan 0 and atan2(0, x), x a positive number."""
        if head in ("log", "acos"):
            return self._fresh(below[0]) == self.constant(1)
        if head == "atan2":
            x, under = below[1]
            if not (x.is_constant() and under.is_constant() and self._number(x) / self._number(under) > 0):
                return False
        return head in ("asin", "atan", "atan2") and bool(below[0].above == 0)

    def _power(self, base: Tree, exponent: Tree) -> Quotient:
        value = exponent.value
        if isinstance(value, Fraction):
            if value.denominator == 1:
                return self.to_power(self.read(base), int(value))
            refuse(value.denominator > LARGEST_MULTIPLE, "a root of too high an order")
            return self.to_power(self.root(self.read(base), value.denominator), value.numerator)
        return self.generator(("power", self.key(self.read(base)), self.key(self.read(exponent))))

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
            refuse(abs(multiple) > LARGEST_MULTIPLE * level, "too large a multiple in an argument")
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
        self.rules.setdefault(self.places[("sin", level, key)], (2, self._fresh(square)))
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
