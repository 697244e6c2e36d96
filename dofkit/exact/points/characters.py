"""Exponentials and angles over GF(p): homomorphisms from sums to products, which are free but for that.

exp(u + v) = exp(u) exp(v), and z(u) = cos(u) + i sin(u) likewise. At a point of a set arguments may be related that are
not as written (x = 2 t, or (x + y)^2 beside x^2 + 2 x y + y^2): small integer relations among the arguments there are
looked for, and the values of related ones follow from each other; multiples of pi / D have the values of roots of
unity. Everything else is drawn at random.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import combinations
from math import gcd, isqrt, lcm, prod
from typing import Any

from flint import fmpz_mat, nmod, nmod_poly

from dofkit.exact.errors import NoPointError

#: Arguments among which relations are looked for by reduction of a lattice; among more of them only short ones are.
MOST_REDUCED = 7
#: A relation that is found is there by chance with a probability of 2 to the minus this.
SURENESS = 30
#: Up to which powers products of one, two, three ... values are looked through, and up to which root of them.
POWERS, MOST_ROOTS = (512, 512, 16, 16, 5, 5, 2, 2, 1, 1, 1, 1), 4
#: Powers up to this one are looked through first.
SMALL = 2
#: A number that all of these roots divide.
ROOTS = lcm(*range(1, MOST_ROOTS + 1))
#: Multiples of a unit are looked for up to so many times its order.
TURNS = 64
#: Roots are taken up to this degree.
LARGEST = 512


class Character:
    """The values of one homomorphism at a point: each argument that was asked for with its value."""

    def __init__(self, p: int, known: dict[int, Any] | None = None, drawn: set[int] | None = None) -> None:
        """``drawn``: arguments that were drawn at random, each by itself: they are related by chance only."""
        self.p, self.drawn = p, set() if drawn is None else drawn
        self.values: dict[int, Any] = {} if known is None else known
        self._unit: tuple[Any, Any, int] | None = None

    def copy(self, drawn: set[int]) -> Character:
        """The same values so far."""
        other = Character(self.p, dict(self.values), drawn)
        other._unit = self._unit
        return other

    def settle(self, argument: Any, root: Any, order: int) -> None:
        """The value at an argument is a certain root of unity of this order: 2 pi / n gives exp(2 pi i / n)."""
        self._unit = argument, root, order

    def at(self, argument: Any, draw: Callable[[], Any]) -> Any:
        """The value at an argument: what relations give, else one that is drawn. Raises NoPointError for a root."""
        u = int(argument)
        if u == 0:
            return nmod(1, self.p)
        if u not in self.values:
            related = self._related(u)
            self.values[u] = draw() if related is None else related
        return self.values[u]

    def agree(self, argument: Any, value: Any) -> None:
        """Take a value that was settled elsewhere. Raises NoPointError where another one is known."""
        if self.at(argument, lambda: value) != value:
            raise NoPointError("an exponential or an angle with two values at one place")

    def take(self, argument: Any, value: Any) -> None:
        """The same for a value whose logarithm the argument is: of its roots any is taken, as only a positive one has
        a logarithm. Raises NoPointError."""
        u = int(argument)
        known = self.values.get(u) or self._related(u)
        if known is not None and known**ROOTS != value**ROOTS:
            raise NoPointError("a logarithm with two values at one place")
        self.values.setdefault(u, value)

    def argument_of(self, value: Any) -> Any | None:
        """u where ``value`` is exp(u): a root of a product of powers of known values; None where none was found.

        The products of one half of the values are listed, and those of the other half looked up among them. Of an odd
        number the last is divided between both: its powers are those of small steps and of large ones.
        Raises NoPointError for 0, which no exponential is.
        """
        if int(value) == 0:
            raise NoPointError("a logarithm of 0")
        known = [(u, int(v)) for u, v in self.values.items()][: len(POWERS)]
        largest = POWERS[max(len(known), 1) - 1]
        for most in sorted({min(SMALL, largest), largest}):
            found = self._root_of_product(int(value), known, most)
            if found is not None or not known:
                return found
        return None

    def _root_of_product(self, value: int, known: Sequence[tuple[int, int]], most: int) -> Any | None:
        """The same with powers up to ``most``."""
        low, step = isqrt(most), 2 * isqrt(most) + 1
        steps = [(u, v, most) for u, v in known]
        if len(known) % 2:
            u, v, _ = steps.pop()
            steps = [(u, v, low), *steps, (step * u, pow(v, step, self.p), (most + low) // step)]
        half = len(steps) // 2
        listed, sought = self._products(steps[:half]), self._products(steps[half:])
        for root in range(1, MOST_ROOTS + 1):
            wanted = pow(value, root, self.p)
            for product, u in sought.items():
                at = listed.get(wanted * product % self.p)
                if at is not None:
                    return nmod(at - u, self.p) / root
        return None

    def _products(self, steps: Sequence[tuple[int, int, int]]) -> dict[int, int]:
        """Products of powers, each with its argument: of every (u, exp(u)) from minus to plus so many times."""
        found = {1: 0}
        for u, v, most in steps:
            powers, power = [], pow(v, -most, self.p)
            for k in range(-most, most + 1):
                powers.append((k * u, power))
                power = power * v % self.p
            found = {w * power % self.p: at + times for w, at in found.items() for times, power in powers}
        return found

    def _whole(self, u: int) -> Any | None:
        """The value where u is a multiple of the unit, or differs by one from an argument or from minus one."""
        if self._unit is None:
            return None
        unit, root, order = self._unit
        for at, value in ((0, nmod(1, self.p)), *self.values.items()):
            for other, known in ((at, value), (-at, 1 / value)):
                k = int((nmod(u, self.p) - other) / unit)
                k = k if 2 * k < self.p else k - self.p
                if abs(k) <= TURNS * order:
                    return known * root**k
        return None

    def _related(self, u: int) -> Any | None:
        if u in self.drawn and self.drawn.issuperset(self.values):
            return None
        whole = self._whole(u)
        if whole is not None:
            return whole
        if self.p - u in self.values:
            return 1 / self.values[self.p - u]
        relation = self._reduced(u) if len(self.values) <= MOST_REDUCED else self._of_two(u)
        if relation is None:
            return None
        own = relation.pop(u)
        if self._unit is not None and abs(own) > 1 and int(self._unit[0]) in relation:
            raise NoPointError("an argument is a fraction of pi that is none of those written")
        known = {**self.values} if self._unit is None else {**self.values, int(self._unit[0]): self._unit[1]}
        others = prod((known[v] ** -k for v, k in relation.items()), start=nmod(1, self.p))
        return self._root(others if own > 0 else 1 / others, abs(own))

    def _root(self, value: Any, degree: int) -> Any:
        """A root of a value: any is as good as the others. Raises NoPointError where there is none (Euler's criterion).

        The group of p - 1 elements is cyclic: with g = gcd(d, p - 1) the d-th powers are the g-th ones, and w^g = v
        gives (w^e)^d = v where d e = g modulo p - 1.
        """
        order = self.p - 1
        shared = gcd(degree, order)
        if value ** (order // shared) != 1:
            raise NoPointError("an argument is a fraction of others, and there is no root")
        least = value
        if shared > 1:
            least = min((w for w, _ in nmod_poly([-value, *([0] * (shared - 1)), 1], self.p).roots()), key=int)
        return least ** pow(degree // shared, -1, order // shared)

    def _reduced(self, u: int) -> dict[int, int] | None:
        """A short integer relation among the arguments and ``u``, by Lenstra, Lenstra and Lovasz's reduction."""
        args = [u, *self.values, *(() if self._unit is None else (int(self._unit[0]),))]
        n = len(args)
        if n < 2:
            return None
        most = 2.0 ** ((self.p.bit_length() - SURENESS) / n - 1)
        weight = 1 << (self.p.bit_length() + n)
        rows = [[int(i == j) for j in range(n)] + [a * weight] for i, a in enumerate(args)]
        reduced = fmpz_mat([*rows, [0] * n + [self.p * weight]]).lll()
        for i in range(reduced.nrows()):
            row = [int(reduced[i, j]) for j in range(n)]
            if int(reduced[i, n]) == 0 and 0 < abs(row[0]) <= LARGEST and max(map(abs, row)) <= most:
                return {v: k for v, k in zip(args, row, strict=True) if k}
        return None

    def _of_two(self, u: int) -> dict[int, int] | None:
        """u as the sum or the difference of two arguments, or twice one."""
        for a, b in combinations([*self.values, *self.values], 2):
            for k in (1, -1):
                if (a + k * b - u) % self.p == 0:
                    return {u: 1, a: -2} if a == b else {u: 1, a: -1, b: -k}
        return None
