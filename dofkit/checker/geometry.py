"""Bodies and points: where a material point stands, as a numerator over a factor that never vanishes.

A body turns from its reference by A, and the point that stands at ``a`` there is X = p + A (a - p0). In the plane A is
the rotation by the angle less its reference value; in space it is R R_ref^T with R = Rz(phi) Rx(theta) Rz(psi), or,
read with Cayley parameters g = (a, b, c), A = ((1 - g.g) I + 2 g g^T + 2 [g]) / (1 + g.g).
"""

import operator
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from dofkit.checker.trees import ONE, TWO, ZERO, Tree, add, call, number, symbol, times

Vector = tuple[Tree, ...]
Matrix = tuple[Vector, ...]


def dot(a: Sequence[Tree], b: Sequence[Tree]) -> Tree:
    """The scalar product."""
    return add(*map(times, a, b))


def cross(a: Sequence[Tree], b: Sequence[Tree]) -> Vector:
    """The vector product."""
    return tuple(a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1)))


def less(a: Sequence[Tree], b: Sequence[Tree]) -> Vector:
    """a - b."""
    return tuple(map(operator.sub, a, b))


def scaled(factor: Tree, a: Sequence[Tree]) -> Vector:
    """factor a."""
    return tuple(factor * part for part in a)


def square(a: Sequence[Tree]) -> Tree:
    """a . a."""
    return add(*(part * part if part.head == "number" else part**2 for part in a))


def length(a: Sequence[Tree]) -> Tree:
    """|a|, without a root where one component is all, and a number."""
    only = [part.value for part in a if part != ZERO]
    return number(abs(only[0])) if len(only) == 1 and not isinstance(only[0], str) else call("sqrt", square(a))


def determinant(rows: Sequence[Sequence[Tree]]) -> Tree:
    """The determinant of a small matrix."""
    if not rows:
        return ONE
    minors = (determinant([[*row[:j], *row[j + 1 :]] for row in rows[1:]]) for j in range(len(rows)))
    return add(*(rows[0][j] * (-minor if j % 2 else minor) for j, minor in enumerate(minors)))


def product(a: Matrix, b: Matrix) -> Matrix:
    """The rows of a b."""
    return tuple(tuple(dot(row, column) for column in zip(*b, strict=True)) for row in a)


def rotation(d: int, i: int, j: int, angle: Tree = ZERO) -> Matrix:
    """The rotation by an angle in the plane of two axes; by 0 it is the identity."""
    c, s = (ONE, ZERO) if angle == ZERO else (call("cos", angle), call("sin", angle))
    turned = {(i, i): c, (i, j): -s, (j, i): s, (j, j): c}
    return tuple(tuple(turned.get((k, m), ONE if k == m else ZERO) for m in range(d)) for k in range(d))


def euler_turn(phi: Tree, theta: Tree, psi: Tree) -> Matrix:
    """Rz(phi) Rx(theta) Rz(psi)."""
    return product(rotation(3, 0, 1, phi), product(rotation(3, 1, 2, theta), rotation(3, 0, 1, psi)))


def cayley_turn(g: Vector) -> Matrix:
    """(1 - g.g) I + 2 g g^T + 2 [g], which is 1 + g.g times a rotation."""
    (x, y, z), kept = g, ONE - square(g)
    skew = ((ZERO, -z, y), (z, ZERO, -x), (-y, x, ZERO))
    doubled = [[TWO * (g[i] * g[j] + skew[i][j]) for j in range(3)] for i in range(3)]
    return tuple(tuple((kept if i == j else ZERO) + doubled[i][j] for j in range(3)) for i in range(3))


class MaterialPoint(NamedTuple):
    """X = over / under. ``start``: where it stands in the reference, if that is known."""

    over: Vector
    under: Tree = ONE
    start: Vector | None = None

    @property
    def place(self) -> Vector:
        """X."""
        return scaled(self.under**-1, self.over)


def apart(first: MaterialPoint, second: MaterialPoint) -> tuple[Vector, Tree]:
    """second - first as numerator and denominator."""
    if first.under == second.under:
        return less(second.over, first.over), first.under
    return less(scaled(first.under, second.over), scaled(second.under, first.over)), first.under * second.under


class CheckedFrame(NamedTuple):
    """A body or the ground: position p, its reference p0, and ``turn``, the rows of ``under`` times A.

    ``reference``: the values of its coordinates there; ``angle`` from it in the plane; ``cayley`` parameters, if any.
    """

    name: str
    position: Vector
    start: Vector
    turn: Matrix
    under: Tree
    reference: Mapping[str, Tree]
    angle: Tree = ZERO
    cayley: Vector | None = None

    def carry(self, a: Sequence[Tree]) -> Vector:
        """``under`` times A a."""
        return tuple(dot(row, a) for row in self.turn)

    def point(self, a: Vector) -> MaterialPoint:
        """The material point that stands at ``a`` in the reference."""
        arm = less(a, self.start)
        if all(part == ZERO for part in arm):
            return MaterialPoint(self.position, ONE, a)
        return MaterialPoint(tuple(map(add, scaled(self.under, self.position), self.carry(arm))), self.under, a)

    def in_body_axes(self, a: Vector) -> Vector:
        """R(theta)^T (a - p): a place of the plane in the body's own coordinates."""
        turn = rotation(2, 0, 1, symbol(list(self.reference)[2]) if self.reference else ZERO)
        return tuple(dot(column, less(a, self.position)) for column in zip(*turn, strict=True))

    def offset(self, point: MaterialPoint, place: Vector, direction: Vector) -> Tree:
        """How far a point is from a place of this body, along a direction of it, times both denominators."""
        now = dot(self.carry(direction), less(point.over, scaled(point.under, self.position)))
        return now - self.under * point.under * dot(direction, less(place, self.start))


def ground(d: int) -> CheckedFrame:
    """The world, which never moves."""
    zero = (ZERO,) * d
    return CheckedFrame("ground", zero, zero, rotation(d, 0, 1), ONE, {}, cayley=zero)


def body_frame(name: str, d: int, reference: Mapping[str, Tree], cayley: bool) -> CheckedFrame:
    """A body with its coordinates and their reference values."""
    moving, values = tuple(map(symbol, reference)), tuple(reference.values())
    turning, initial, under, angle, turn = moving[d:], values[d:], ONE, ZERO, rotation(d, 0, 1)
    if cayley:
        turn, under = cayley_turn(turning), ONE + square(turning)
    elif d == 2:
        angle = turning[0] - initial[0]
        turn = rotation(2, 0, 1, angle)
    elif d == 3:
        turn = product(euler_turn(*turning), tuple(zip(*euler_turn(*initial), strict=True)))
    return CheckedFrame(name, moving[:d], values[:d], turn, under, reference, angle, turning if cayley else None)
