"""Exponentials and angles over GF(p): homomorphisms from sums to products, which are free but for that.

exp(u + v) = exp(u) exp(v), and z(u) = cos(u) + i sin(u) likewise. At a point of a set arguments may be related that are
not as written (x = 2 t, or (x + y)^2 beside x^2 + 2 x y + y^2): small integer relations among the arguments there are
looked for, and the values of related ones follow from each other; multiples of pi / D have the values of roots of
unity. Everything else is drawn at random.
"""

from __future__ import annotations

from collections.abc import Callable
from math import gcd, prod
from typing import Any

from flint import fmpz_mat, nmod, nmod_poly

from dofkit.exact.errors import NoPointError

#: Arguments among which relations are looked for; among more of them only equal and opposite ones are seen.
MOST_REDUCED = 7
#: A relation that is found is there by chance with a probability of 2 to the minus this.
SURENESS = 30
#: Multiples of a unit are looked for up to so many times its order.
TURNS = 64
#: Roots are taken up to this degree.
LARGEST = 512


class Character:
    """The values of one homomorphism at a point: each argument that was asked for with its value.

    ``drawn``: arguments that were drawn at random, each by itself: they are related by chance only.
    """

    def __init__(self, p: int, drawn: set[int], values: dict[int, Any] | None = None) -> None:
        self.p, self.drawn = p, drawn
        self.values: dict[int, Any] = {} if values is None else values
        self._unit: tuple[Any, Any, int] | None = None

    def copy(self, drawn: set[int]) -> Character:
        """Return a character with the same values so far."""
        other = Character(self.p, drawn, dict(self.values))
        other._unit = self._unit
        return other

    def settle(self, argument: Any, root: Any, order: int) -> None:
        """Let the value at an argument be a certain root of unity of this order: 2 pi / n gives exp(2 pi i / n)."""
        self._unit = argument, root, order

    def at(self, argument: Any, draw: Callable[[], Any]) -> Any:
        """Return the value at an argument, from relations or else drawn. Raises NoPointError for a fraction."""
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

    def _related(self, u: int) -> Any | None:
        """Return the value that the others give, or None where the argument is related to none of them."""
        if u in self.drawn and self.drawn.issuperset(self.values):
            return None
        multiple = self._multiple_of_unit(u)
        if multiple is not None:
            return multiple
        if self.p - u in self.values:
            return 1 / self.values[self.p - u]
        relation = self._reduced(u) if len(self.values) <= MOST_REDUCED else None
        if relation is None:
            return None
        degree = relation.pop(u)
        if self._unit is not None and abs(degree) > 1 and int(self._unit[0]) in relation:
            raise NoPointError("an argument is a fraction of pi that is none of those written")
        known = {**self.values} if self._unit is None else {**self.values, int(self._unit[0]): self._unit[1]}
        sign = 1 if degree > 0 else -1
        power = prod((known[v] ** (-k * sign) for v, k in relation.items()), start=nmod(1, self.p))
        return _root(power, abs(degree), self.p)

    def _multiple_of_unit(self, u: int) -> Any | None:
        """Return the value where u is a multiple of the unit, or differs by one from an argument or from minus one."""
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

    def _reduced(self, u: int) -> dict[int, int] | None:
        """Return a short integer relation among the arguments and ``u``, by the reduction of a lattice (LLL)."""
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


def _root(value: Any, degree: int, p: int) -> Any:
    """Return a root of a value: any is as good as the others. Raises NoPointError where there is none (Euler).

    The group of p - 1 elements is cyclic: with g = gcd(d, p - 1) the d-th powers are the g-th ones, and w^g = v
    gives (w^e)^d = v where d e = g modulo p - 1.
    """
    shared = gcd(degree, p - 1)
    if value ** ((p - 1) // shared) != 1:
        raise NoPointError("an argument is a fraction of others, and there is no root")
    if shared > 1:
        value = min((w for w, _ in nmod_poly([-value, *([0] * (shared - 1)), 1], p).roots()), key=int)
    return value ** pow(degree // shared, -1, (p - 1) // shared)
