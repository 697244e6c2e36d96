"""Bodies and points: where a material point stands, as a numerator over a factor that never vanishes.

A body turns from its reference by A, and the point that stands at ``a`` there is X = p + A (a - p0). In the plane A is
the rotation by the angle less its reference value; in space it is R R_ref^T with R = Rz(phi) Rx(theta) Rz(psi), or,
read with Cayley parameters g = (a, b, c), A = ((1 - g.g) I + 2 g g^T + 2 [g]) / (1 + g.g).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from dofkit.checker.trees import ONE, ZERO, Tree, add, call, negative, number, power, symbol, times

Vector = tuple[Tree, ...]
TWO = number(2)


def dot(a: Sequence[Tree], b: Sequence[Tree]) -> Tree:
    """The scalar product."""
    return add(*(times(p, q) for p, q in zip(a, b, strict=True)))


def cross(a: Sequence[Tree], b: Sequence[Tree]) -> Vector:
    """The vector product."""
    pairs = ((1, 2), (2, 0), (0, 1))
    return tuple(add(times(a[i], b[j]), negative(times(a[j], b[i]))) for i, j in pairs)


def less(a: Sequence[Tree], b: Sequence[Tree]) -> Vector:
    """a - b."""
    return tuple(difference(p, q) for p, q in zip(a, b, strict=True))


def difference(a: Tree, b: Tree) -> Tree:
    """a - b, 0 where they are the same."""
    return ZERO if a == b else add(a, negative(b))


def scaled(factor: Tree, a: Sequence[Tree]) -> Vector:
    """factor a."""
    return tuple(times(factor, part) for part in a)


def square(a: Sequence[Tree]) -> Tree:
    """a . a."""
    return add(*(power(part, TWO) if part.head != "number" else times(part, part) for part in a))


def length(a: Sequence[Tree]) -> Tree:
    """|a|, without a root where one component is all."""
    parts = [part for part in a if part != ZERO]
    if len(parts) == 1 and parts[0].head == "number":
        return parts[0] if parts[0].value > ZERO.value else negative(parts[0])  # type: ignore[operator]
    return call("sqrt", square(a))


class MaterialPoint(NamedTuple):
    """X = over / under. ``start``: where it stands in the reference, if that is known."""

    over: Vector
    under: Tree
    start: Vector | None

    @property
    def place(self) -> Vector:
        """X."""
        return self.over if self.under == ONE else scaled(power(self.under, number(-1)), self.over)


@dataclass(frozen=True)
class CheckedFrame:
    """A body or the ground: position p, its reference p0, and ``turn``, the rows of ``under`` times A.

    ``angles``: the names of its angles or Cayley parameters; ``initial`` the reference values of angles.
    """

    name: str
    position: Vector
    start: Vector
    turn: tuple[Vector, ...]
    under: Tree = ONE
    angles: tuple[str, ...] = ()
    initial: Vector = ()
    cayley: bool = False

    @property
    def gibbs(self) -> Vector | None:
        """The Cayley parameters; 0 for the ground."""
        if self.name == "ground":
            return (ZERO,) * 3
        return tuple(map(symbol, self.angles)) if self.cayley else None

    @property
    def angle(self) -> Tree:
        """In the plane, the angle from the reference."""
        return difference(symbol(self.angles[0]), self.initial[0]) if self.angles else ZERO

    def carry(self, a: Sequence[Tree]) -> Vector:
        """``under`` times A a."""
        return tuple(dot(row, a) for row in self.turn)

    def point(self, a: Vector) -> MaterialPoint:
        """The material point that stands at ``a`` in the reference."""
        arm = less(a, self.start)
        if all(part == ZERO for part in arm):
            return MaterialPoint(self.position, ONE, a)
        over = tuple(add(times(self.under, p), q) for p, q in zip(self.position, self.carry(arm), strict=True))
        return MaterialPoint(over, self.under, a)


def apart(first: MaterialPoint, second: MaterialPoint) -> tuple[Vector, Tree]:
    """second - first as numerator and denominator."""
    if first.under == second.under:
        return less(second.over, first.over), first.under
    return less(scaled(first.under, second.over), scaled(second.under, first.over)), times(first.under, second.under)


def identity(d: int) -> tuple[Vector, ...]:
    """The rows of the identity."""
    return tuple(tuple(ONE if i == j else ZERO for j in range(d)) for i in range(d))


def plane_turn(angle: Tree) -> tuple[Vector, ...]:
    """The rotation of the plane."""
    c, s = (ONE, ZERO) if angle == ZERO else (call("cos", angle), call("sin", angle))
    return ((c, negative(s)), (s, c))


def space_turn(angle: Tree, axis: int) -> tuple[Vector, ...]:
    """The rotation of space about x (0) or z (2)."""
    ((c, _), (s, _)), o, e = plane_turn(angle), ZERO, ONE
    return ((e, o, o), (o, c, negative(s)), (o, s, c)) if axis == 0 else ((c, negative(s), o), (s, c, o), (o, o, e))


def euler_turn(phi: Tree, theta: Tree, psi: Tree) -> tuple[Vector, ...]:
    """Rz(phi) Rx(theta) Rz(psi)."""
    return matrix_product(space_turn(phi, 2), matrix_product(space_turn(theta, 0), space_turn(psi, 2)))


def cayley_turn(g: Vector) -> tuple[Vector, ...]:
    """(1 - g.g) I + 2 g g^T + 2 [g], which is 1 + g.g times a rotation."""
    x, y, z = g
    skew = ((ZERO, negative(z), y), (z, ZERO, negative(x)), (negative(y), x, ZERO))
    diagonal = difference(ONE, square(g))
    return tuple(
        tuple(add(diagonal if i == j else ZERO, times(TWO, g[i], g[j]), times(TWO, skew[i][j])) for j in range(3))
        for i in range(3)
    )


def matrix_product(a: Sequence[Vector], b: Sequence[Vector]) -> tuple[Vector, ...]:
    """The rows of a b."""
    return tuple(tuple(dot(row, column) for column in zip(*b, strict=True)) for row in a)


def transposed(a: Sequence[Vector]) -> tuple[Vector, ...]:
    """The columns of a."""
    return tuple(zip(*a, strict=True))
