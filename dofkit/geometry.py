"""Vectors of expressions and the frames of bodies, exact and cleared of denominators.

A spatial body in the Gibbs chart turns by R = N / w with N = (1 - g.g) I + 2 g g^T + 2 g~ and
w = 1 + g.g, the factor that never vanishes; points are kept as numerator over w, so that relations
between them are polynomial. For every other frame w is 1.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Literal, NamedTuple

from dofkit.expr import MINUS_ONE, ONE, TWO, ZERO, Expr, add, coordinate, fn, mul, num, power, sqrt, velocity

Vec = tuple[Expr, ...]
Matrix = tuple[Vec, ...]
Chart = Literal["fixed", "line", "plane", "gibbs", "euler"]


_Number = int | Fraction


def total(parts: Iterable[tuple[_Number, Expr]]) -> Expr:
    """The sum of numbers times expressions, equal terms collected: `add` for many short sums.

    Whole numbers are kept as int while they are added, which is several times faster than Fraction.
    """
    found: dict[Expr, _Number] = {}
    for factor, e in parts:
        for term in e.args if e.op == "add" else (e,):
            number: _Number = factor
            if term.op == "num":
                number, term = factor * _whole(term.args[0]), ONE
            elif term.op == "mul" and term.args[0].op == "num":
                number = factor * _whole(term.args[0].args[0])
                rest = term.args[1:]
                term = rest[0] if len(rest) == 1 else Expr("mul", rest)
            found[term] = found[term] + number if term in found else number
    terms = [_times(number, term) for term, number in found.items() if number]
    if len(terms) > 1:
        return Expr("add", tuple(terms))
    return terms[0] if terms else ZERO


def _whole(number: Fraction) -> _Number:
    return number.numerator if number.denominator == 1 else number


def _times(number: _Number, term: Expr) -> Expr:
    if number == 1:
        return term
    factor = MINUS_ONE if number == -1 else num(number)
    if term is ONE:
        return factor
    return Expr("mul", (factor, *term.args) if term.op == "mul" else (factor, term))


def plus(*vectors: Vec) -> Vec:
    """The sum."""
    return tuple(total([(1, part) for part in parts]) for parts in zip(*vectors, strict=True))


def minus(a: Vec, b: Vec) -> Vec:
    """a - b."""
    return tuple(difference(p, q) for p, q in zip(a, b, strict=True))


def difference(a: Expr, b: Expr) -> Expr:
    """a - b."""
    if a.op == "sym" and b.op == "sym" and a != b:
        return Expr("add", (a, Expr("mul", (MINUS_ONE, b))))
    return a if b.is_zero else total(((1, a), (-1, b)))


def scaled(factor: Expr, a: Vec) -> Vec:
    """factor a."""
    return a if factor is ONE or factor == ONE else tuple(mul(factor, part) for part in a)


def dot(a: Vec, b: Vec) -> Expr:
    """a . b."""
    return total([_product(p, q) for p, q in zip(a, b, strict=True)])


def _product(p: Expr, q: Expr) -> tuple[_Number, Expr]:
    if q.op == "num":
        return _whole(q.args[0]), p
    return (_whole(p.args[0]), q) if p.op == "num" else (1, mul(p, q))


def square(a: Vec) -> Expr:
    """a . a."""
    return total([(1, Expr("pow", (p, TWO)) if p.op in ("sym", "add") else power(p, TWO)) for p in a])


def square_between(a: Vec, b: Vec) -> Expr:
    """|b - a|^2, at once for numbers."""
    if all(part.op == "num" for part in (*a, *b)):
        return num(sum((_whole(q.args[0]) - _whole(p.args[0])) ** 2 for p, q in zip(a, b, strict=True)))
    return square(minus(b, a))


def length(a: Vec) -> Expr:
    """|a|, folded where it is rational."""
    return sqrt(square(a))


def cross(a: Vec, b: Vec) -> Vec:
    """a x b in space."""
    return tuple(difference(mul(a[i], b[j]), mul(a[j], b[i])) for i, j in ((1, 2), (2, 0), (0, 1)))


def apply(matrix: Matrix, a: Vec) -> Vec:
    """The matrix times a vector."""
    return tuple(dot(row, a) for row in matrix)


def product(left: Matrix, right: Matrix) -> Matrix:
    """The product of two matrices."""
    columns = tuple(zip(*right, strict=True))
    return tuple(tuple(dot(row, column) for column in columns) for row in left)


def transposed(matrix: Matrix) -> Matrix:
    """The transpose."""
    return tuple(zip(*matrix, strict=True))


def unit(axis: int, dimension: int) -> Vec:
    """The world's axis number ``axis``."""
    return tuple(ONE if i == axis else ZERO for i in range(dimension))


def is_zero(a: Vec) -> bool:
    """True where every component is the number 0 as written."""
    return all(part.is_zero for part in a)


def across(n: Vec, pivot: int) -> tuple[Vec, ...]:
    """d - 1 independent vectors perpendicular to ``n``, whose component ``pivot`` is not zero.

    In the plane the one turned left by a right angle.
    """
    if len(n) == 2:
        return ((mul(MINUS_ONE, n[1]), n[0]),)
    spanning = []
    for i in range(len(n)):
        if i != pivot:
            parts = [ZERO] * len(n)
            parts[i], parts[pivot] = n[pivot], mul(MINUS_ONE, n[i])
            spanning.append(tuple(parts))
    return tuple(spanning)


def turn_z(angle: Expr) -> Matrix:
    """The rotation by ``angle`` about the z axis of space."""
    c, s = fn("cos", angle), fn("sin", angle)
    return ((c, mul(MINUS_ONE, s), ZERO), (s, c, ZERO), (ZERO, ZERO, ONE))


def turn_x(angle: Expr) -> Matrix:
    """The rotation by ``angle`` about the x axis of space."""
    c, s = fn("cos", angle), fn("sin", angle)
    return ((ONE, ZERO, ZERO), (ZERO, c, mul(MINUS_ONE, s)), (ZERO, s, c))


def euler(phi: Expr, theta: Expr, psi: Expr) -> Matrix:
    """The rotation Rz(phi) Rx(theta) Rz(psi)."""
    return product(turn_z(phi), product(turn_x(theta), turn_z(psi)))


def gibbs_numerator(g: Vec) -> Matrix:
    """N = (1 - g.g) I + 2 g g^T + 2 g~, so that R = N / (1 + g.g)."""
    x, y, z = g
    diagonal = difference(ONE, square(g))
    twice = [mul(TWO, part) for part in g]
    return (
        (add(diagonal, mul(twice[0], x)), difference(mul(twice[0], y), twice[2]), add(mul(twice[0], z), twice[1])),
        (add(mul(twice[0], y), twice[2]), add(diagonal, mul(twice[1], y)), difference(mul(twice[1], z), twice[0])),
        (difference(mul(twice[0], z), twice[1]), add(mul(twice[1], z), twice[0]), add(diagonal, mul(twice[2], z))),
    )


class Placed(NamedTuple):
    """A point X = over / under; ``reference`` is where it stands in the reference configuration, if known.

    ``frame`` names the body that carries it (``ground`` too), None for a particle; ``label`` tells
    points apart.
    """

    over: Vec
    under: Expr
    reference: Vec | None
    frame: str | None
    label: str


@dataclass(frozen=True, eq=False)
class Frame:
    """A body's pose, or the ground's: a material point at ``a`` in the reference is X = p + R (a - start).

    ``position`` is p, ``start`` its reference value, ``angles`` the names of the angle coordinates
    and ``initial`` their reference values. ``chart`` is ``fixed`` for the ground, ``line`` in one
    dimension, ``plane``, ``gibbs`` or ``euler``.
    """

    name: str
    position: Vec
    start: Vec
    chart: Chart
    angles: tuple[str, ...] = ()
    initial: Vec = ()

    @property
    def dimension(self) -> int:
        """d."""
        return len(self.position)

    @property
    def fixed(self) -> bool:
        """True for the ground."""
        return self.chart == "fixed"

    @cached_property
    def gibbs(self) -> Vec | None:
        """The Gibbs vector of the rotation from the reference, where the chart has one."""
        if self.fixed:
            return (ZERO, ZERO, ZERO)
        return tuple(coordinate(name) for name in self.angles) if self.chart == "gibbs" else None

    @cached_property
    def angle(self) -> Expr:
        """In the plane, the angle from the reference."""
        return difference(coordinate(self.angles[0]), self.initial[0]) if self.angles else ZERO

    @cached_property
    def under(self) -> Expr:
        """The factor w by which rotated vectors are multiplied."""
        return add(ONE, square(self.gibbs)) if self.chart == "gibbs" and self.gibbs else ONE

    @cached_property
    def turn(self) -> Matrix | None:
        """w R; None for the identity."""
        if self.chart == "plane":
            c, s = fn("cos", self.angle), fn("sin", self.angle)
            return ((c, mul(MINUS_ONE, s)), (s, c))
        if self.chart == "gibbs" and self.gibbs:
            return gibbs_numerator(self.gibbs)
        if self.chart == "euler":
            now = euler(*(coordinate(name) for name in self.angles))
            return now if is_zero(self.initial) else product(now, transposed(euler(*self.initial)))
        return None

    def carry(self, a: Vec) -> Vec:
        """w R a: where a direction of the reference points now, times w."""
        return a if self.turn is None else apply(self.turn, a)

    def point(self, a: Vec, label: str = "") -> Placed:
        """The material point that stands at ``a`` in the reference configuration."""
        if self.fixed:
            return Placed(a, ONE, a, self.name, label)
        arm = minus(a, self.start)
        if is_zero(arm):
            return Placed(self.position, ONE, a, self.name, label)
        return Placed(plus(scaled(self.under, self.position), self.carry(arm)), self.under, a, self.name, label)

    def spin(self) -> tuple[Vec, Expr]:
        """The angular velocity in world axes as numerator and denominator, velocities as symbols.

        Gibbs: 2 (gdot + g x gdot) / (1 + g.g). Euler: phidot e_z + thetadot (cos phi, sin phi, 0)
        + psidot (sin phi sin theta, -cos phi sin theta, cos theta).
        """
        rates = tuple(velocity(name) for name in self.angles)
        if self.gibbs is not None:
            return scaled(TWO, plus(rates, cross(self.gibbs, rates))), self.under
        phi, theta = (coordinate(name) for name in self.angles[:2])
        line = (fn("cos", phi), fn("sin", phi), ZERO)
        tilt = fn("sin", theta)
        axle = (mul(fn("sin", phi), tilt), mul(MINUS_ONE, fn("cos", phi), tilt), fn("cos", theta))
        return plus(scaled(rates[0], unit(2, 3)), scaled(rates[1], line), scaled(rates[2], axle)), ONE


def relative(first: Frame, second: Frame) -> tuple[Expr, Vec] | None:
    """The rotation R1^T R2 as a quaternion (scalar, vector), up to a positive factor; None outside Gibbs charts.

    (1, -g1)(1, g2) = (1 + g1.g2, g2 - g1 - g1 x g2).
    """
    if first.gibbs is None or second.gibbs is None:
        return None
    g, h = first.gibbs, second.gibbs
    return add(ONE, dot(g, h)), minus(minus(h, g), cross(g, h))


def between(first: Placed, second: Placed) -> tuple[Vec, Expr]:
    """second - first as numerator and denominator."""
    if first.under == second.under:
        return minus(second.over, first.over), first.under
    left, right = scaled(second.under, first.over), scaled(first.under, second.over)
    return minus(right, left), mul(first.under, second.under)
