"""A random curve over GF(p): a point whose values are power series, so that one run of a program does for many points.

A function of the symbols that vanishes at random points vanishes along the curve to any order; and as every coefficient
is drawn, functions that are independent over the numbers stay so on it, to as many orders as there are functions.
"""

from __future__ import annotations

from collections.abc import Sequence

from flint import nmod_poly

from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.series import Series, SeriesPoint
from dofkit.exact.ring.instructions import Var
from dofkit.expressions import tree as ex

#: Generators that stand for a number, or are tied to their argument by an equation.
_TIED = ("pi", "sign", "root")


class RandomCurve(SeriesPoint):
    """Symbols and functions as random series, independent of each other as at a random point; sine and cosine lie on
    the unit circle, and a root is one of its radicand.

    ``base`` supplies what is tied at s = 0. Raises NoPointError where that has no value.
    """

    def __init__(self, base: FieldPoint, order: int) -> None:
        super().__init__(base, {}, order, nmod_poly([0], base.p))
        self._drawn: dict[tuple[str, object], Series] = {}

    def generator(self, var: Var, args: Sequence[Series]) -> Series:
        """The series of a generator; the first time it is drawn."""
        name = (var.kind, var.key)
        found = self._drawn.get(name)
        if found is None:
            found = self._drawn[name] = self._draw(var, args)
        return found

    def _draw(self, var: Var, args: Sequence[Series]) -> Series:
        if var.kind in ("cos", "sin"):
            if var.key[0] == ex.PI:
                return self.constant(self.base.generator(var, [a.coefficient(0) for a in args]))
            self._turn(var)
            return self._drawn[var.kind, var.key]
        return super().generator(var, args) if var.kind in _TIED else self._random()

    def _random(self) -> Series:
        p, number = self.base.p, self.base.rng.getrandbits
        bits = p.bit_length() - 1
        return Series(nmod_poly([number(bits) for _ in range(self.order)], p), self.order)

    def _turn(self, var: Var) -> None:
        """Cosine and sine of a random angle: (1 - w^2) / (1 + w^2) and 2 w / (1 + w^2)."""
        w = self._random()
        square = w * w
        below = (square + 1).inverse()
        self._drawn["cos", var.key] = (1 - square) * below
        self._drawn["sin", var.key] = (w + w) * below
