"""Frames of bodies and of the ground: their material points, rotations and angular velocities.

Vectors are exact and free of denominators. In the Gibbs chart, with the Gibbs vector g and its cross product matrix g~,
a spatial body has the rotation R = N / w with N = (1 - g.g) I + 2 g g^T + 2 g~ and w = 1 + g.g, which never vanishes;
points are kept as numerator and denominator w, so that relations between them are polynomial. In other charts w is 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple

from dofkit.expressions.tree import MINUS_ONE, ONE, TWO, ZERO, Expr, add, coordinate, fn, mul, velocity
from dofkit.expressions.vectors import (
    Matrix,
    Vec,
    apply,
    cross,
    difference,
    dot,
    is_zero,
    minus,
    plus,
    product,
    scaled,
    square,
    transposed,
    unit,
)

Chart = Literal["fixed", "line", "plane", "gibbs", "euler"]


def turn(angle: Expr) -> Matrix:
    """Return the rotation of the plane by ``angle``."""
    c, s = fn("cos", angle), fn("sin", angle)
    return ((c, mul(MINUS_ONE, s)), (s, c))


def turn_z(angle: Expr) -> Matrix:
    """Return the rotation by ``angle`` about the z axis of space."""
    c, s = fn("cos", angle), fn("sin", angle)
    return ((c, mul(MINUS_ONE, s), ZERO), (s, c, ZERO), (ZERO, ZERO, ONE))


def turn_x(angle: Expr) -> Matrix:
    """Return the rotation by ``angle`` about the x axis of space."""
    c, s = fn("cos", angle), fn("sin", angle)
    return ((ONE, ZERO, ZERO), (ZERO, c, mul(MINUS_ONE, s)), (ZERO, s, c))


def euler(phi: Expr, theta: Expr, psi: Expr) -> Matrix:
    """Return the rotation Rz(phi) Rx(theta) Rz(psi)."""
    return product(turn_z(phi), product(turn_x(theta), turn_z(psi)))


def gibbs_numerator(g: Vec) -> Matrix:
    """Return the matrix N = (1 - g.g) I + 2 g g^T + 2 g~, for the rotation R = N / (1 + g.g)."""
    x, y, z = g
    diagonal = difference(ONE, square(g))
    twice = [mul(TWO, part) for part in g]
    return (
        (add(diagonal, mul(twice[0], x)), difference(mul(twice[0], y), twice[2]), add(mul(twice[0], z), twice[1])),
        (add(mul(twice[0], y), twice[2]), add(diagonal, mul(twice[1], y)), difference(mul(twice[1], z), twice[0])),
        (difference(mul(twice[0], z), twice[1]), add(mul(twice[1], z), twice[0]), add(diagonal, mul(twice[2], z))),
    )


class Placed(NamedTuple):
    """A point X = over / under; ``reference`` is its position in the reference configuration, if known.

    ``frame`` is the name of its body (or ``ground``), None for a particle; ``label`` is unique for each point.
    """

    over: Vec
    under: Expr
    reference: Vec | None
    frame: str | None
    label: str


@dataclass(frozen=True, eq=False)
class Frame:
    """The frame of a body or the ground: the material point at ``a`` in the reference is X = p + R (a - start).

    ``position`` is p, ``start`` its reference value, ``angles`` the names of the angle coordinates
    and ``initial`` their reference values. ``chart`` is ``fixed`` for the ground, ``line`` in one
    dimension, ``plane``, ``gibbs`` or ``euler``.
    """

    name: str
    position: Vec
    start: Vec
    chart: Chart = "fixed"
    angles: tuple[str, ...] = ()
    initial: Vec = ()

    @property
    def dimension(self) -> int:
        """The dimension d of the world."""
        return len(self.position)

    @property
    def fixed(self) -> bool:
        """Whether this is the ground."""
        return self.chart == "fixed"

    @cached_property
    def gibbs(self) -> Vec | None:
        """The Gibbs vector of the rotation from the reference; None in other charts than ``fixed`` and ``gibbs``."""
        if self.fixed:
            return (ZERO, ZERO, ZERO)
        return tuple(coordinate(name) for name in self.angles) if self.chart == "gibbs" else None

    @cached_property
    def angle(self) -> Expr:
        """In the plane, the angle of rotation from the reference; 0 for the ground."""
        return difference(coordinate(self.angles[0]), self.initial[0]) if self.angles else ZERO

    @cached_property
    def under(self) -> Expr:
        """The factor w by which rotated vectors are multiplied."""
        return add(ONE, square(self.gibbs)) if self.chart == "gibbs" and self.gibbs else ONE

    @cached_property
    def turn(self) -> Matrix | None:
        """The matrix w R of the rotation from the reference; None for the identity."""
        if self.chart == "plane":
            return turn(self.angle)
        if self.chart == "gibbs" and self.gibbs:
            return gibbs_numerator(self.gibbs)
        if self.chart == "euler":
            now = euler(*(coordinate(name) for name in self.angles))
            return now if is_zero(self.initial) else product(now, transposed(euler(*self.initial)))
        return None

    def carry(self, a: Vec) -> Vec:
        """Return w R a: the direction ``a`` of the reference, rotated with the body, times w."""
        return a if self.turn is None else apply(self.turn, a)

    def point(self, a: Vec, label: str = "") -> Placed:
        """Return the material point X = (w p + w R (a - start)) / w that is at ``a`` in the reference."""
        if self.fixed:
            return Placed(a, ONE, a, self.name, label)
        arm = minus(a, self.start)
        if is_zero(arm):
            return Placed(self.position, ONE, a, self.name, label)
        return Placed(plus(scaled(self.under, self.position), self.carry(arm)), self.under, a, self.name, label)

    def spin(self) -> tuple[Vec, Expr]:
        """Return (numerator, denominator) of the angular velocity in world axes.

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
    """Return R1^T R2 as a quaternion (scalar, vector), up to a positive factor; None without two Gibbs vectors.

    (1, -g1)(1, g2) = (1 + g1.g2, g2 - g1 - g1 x g2).
    """
    if first.gibbs is None or second.gibbs is None:
        return None
    g, h = first.gibbs, second.gibbs
    return add(ONE, dot(g, h)), minus(minus(h, g), cross(g, h))


def between(first: Placed, second: Placed) -> tuple[Vec, Expr]:
    """Return second - first as (numerator, denominator)."""
    if first.under == second.under:
        return minus(second.over, first.over), first.under
    first_over, second_over = scaled(second.under, first.over), scaled(first.under, second.over)
    return minus(second_over, first_over), mul(first.under, second.under)
