"""The unknowns of relations over GF(p), and a relation as a polynomial in one of them.

A root is an unknown with root^d = radicand; the unknown of a basic angle is the tangent of half of it (`circle`).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError, PoleError
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.residues import Residue, ResiduePolynomial, residue_polynomial
from dofkit.exact.ring.program import ADD, VAR, Var, raising_no_value, reachable, value_of
from dofkit.exact.ring.ring import Ring

#: A quotient is reduced if its denominator exceeds the degree `LOW`; reduced ones beyond `LARGEST` raise NoValueError.
LOW, LARGEST = 48, 4096


class Rational:
    """A quotient of polynomials in one unknown over GF(p)."""

    __slots__ = ("bottom", "top")

    def __init__(self, top: Any, bottom: Any) -> None:
        self.top = top
        self.bottom = bottom

    def _pair(self, other: Any) -> Rational:
        return other if isinstance(other, Rational) else Rational(self.top * 0 + other, self.bottom * 0 + 1)

    def __add__(self, other: Any) -> Rational:
        b = self._pair(other)
        if self.bottom == b.bottom:
            return Rational(self.top + b.top, self.bottom)
        return _lowest(self.top * b.bottom + b.top * self.bottom, self.bottom * b.bottom)

    def __mul__(self, other: Any) -> Rational:
        b = self._pair(other)
        return _lowest(self.top * b.top, self.bottom * b.bottom)

    __radd__ = __add__
    __rmul__ = __mul__

    def __pow__(self, n: int) -> Rational:
        return Rational(self.top**n, self.bottom**n)

    def __rtruediv__(self, other: Any) -> Rational:
        if self.top == 0:
            raise PoleError
        return self._pair(other) * Rational(self.bottom, self.top)

    def numerator(self) -> Any:
        """Return the numerator in lowest terms."""
        return self.top // self.top.gcd(self.bottom)


def _lowest(top: Any, bottom: Any) -> Rational:
    """Return a quotient, in lowest terms if it is large; raises NoValueError if it exceeds `LARGEST` then."""
    if bottom.degree() <= LOW:
        return Rational(top, bottom)
    check()
    common = top.gcd(bottom)
    top, bottom = top // common, bottom // common
    if max(top.degree(), bottom.degree()) > LARGEST:
        raise NoValueError("a quotient of polynomials is too large")
    return Rational(top, bottom)


#: ("var", generator index), or ("angle", the smaller index of cosine and sine).
Unknown = tuple[str, int]


def unknown_of(ring: Ring, index: int) -> Unknown:
    """Return the unknown of a generator; a cosine and its sine have the same one."""
    var = ring.vars[index]
    return ("angle", min(index, var.partner)) if var.kind in ("cos", "sin") else ("var", index)


def unknowns_in(ring: Ring, node: int) -> frozenset[Unknown]:
    """Return the unknowns of a relation, given as a node."""
    unknowns = set()
    for i in reachable(ring, [node], through_generators=False):
        op, payload = ring.code[i]
        if op == VAR and ring.vars[payload].kind != "sign" and not stands_for_number(ring, payload):
            unknowns.add(unknown_of(ring, payload))
    return frozenset(unknowns)


def stands_for_number(ring: Ring, index: int) -> bool:
    """Return whether a generator is a constant: pi, and functions of numbers."""
    var = ring.vars[index]
    if var.kind in ("symbol", "call"):
        return False
    return all(ring.code[i][0] != VAR or stands_for_number(ring, ring.code[i][1]) for i in reachable(ring, var.args))


def root_relations(ring: Ring, relations: list[int]) -> list[int]:
    """Return the nodes of root^d - radicand for every root in the relations, and for roots in those radicands."""
    equations, seen = [], set()
    pending = list(relations)
    while pending:
        for i in reachable(ring, [pending.pop()], through_generators=False):
            op, payload = ring.code[i]
            if op != VAR or payload in seen:
                continue
            seen.add(payload)
            var = ring.vars[payload]
            if var.kind == "root" and not stands_for_number(ring, payload):
                relation = ring.emit(ADD, (ring.power_node(i, var.degree), ring.negative(var.args[0])))
                equations.append(relation)
                pending.append(relation)
    return equations


@raising_no_value
def univariate(ring: Ring, node: int, unknown: Unknown, point: FieldPoint) -> ResiduePolynomial:
    """Return the numerator of a relation as a polynomial in one unknown, the others at ``point``; or NoValueError."""
    check()
    x = residue_polynomial([0, 1], point.p)
    constant_one = residue_polynomial([1], point.p)
    if unknown[0] == "angle":
        below = 5 * (constant_one + x * x)  # the denominator of `circle`
        cos, sin = (Rational(top, below) for top in circle(x, constant_one))
        var = ring.vars[unknown[1]]
        pair = {var.index: cos if var.kind == "cos" else sin, var.partner: sin if var.kind == "cos" else cos}
    else:
        pair = {unknown[1]: Rational(x, constant_one)}
    result = value_along(ring, node, pair, point)
    top: ResiduePolynomial = (
        result.numerator() if isinstance(result, Rational) else residue_polynomial([result], point.p)
    )
    return top


def value_along(ring: Ring, node: int, pair: dict[int, Rational], point: FieldPoint) -> Any:
    """Return the value of a relation at ``point``, with the generators in ``pair`` as functions of one unknown."""
    return value_of(ring, _PointAlong(ring, pair, point), node, through_generators=False)


class _PointAlong(NamedTuple):
    """A ``point`` whose generators in ``pair`` are functions of one unknown; those without a value get a random one."""

    ring: Ring
    pair: dict[int, Rational]
    point: FieldPoint

    def number(self, value: Fraction) -> Any:
        return self.point.number(value)

    def generator(self, var: Var, args: Sequence[Any]) -> Any:
        """Return the value of a generator: by ``pair``, as recorded at ``point``, or a random one."""
        if var.index in self.pair:
            return self.pair[var.index]
        value = self.point.values.get((var.kind, var.key))
        if value is not None:
            return value
        if not stands_for_number(self.ring, var.index):
            return self.point.whatever(var)
        return self.point.generator(var, [value_along(self.ring, a, {}, self.point) for a in var.args])


def roots_of(polynomial: ResiduePolynomial) -> list[Residue]:
    """Return the roots of a polynomial over GF(p); an empty list for the polynomial 0."""
    return [] if polynomial.is_zero() else [root for root, _ in polynomial.roots()]


def circle(w: Any, constant_one: Any) -> tuple[Any, Any]:
    """Return 5 (1 + w^2) times cos and sin of 2 atan(w) + atan(4/3): the point without a w is not a quarter turn."""
    cos, sin = constant_one - w * w, 2 * w
    return 3 * cos - 4 * sin, 4 * cos + 3 * sin
