"""Points, directions, workplanes and circles of a sketch in space as expressions, and as they are drawn."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from dofkit.expressions.tree import ZERO, Expr, coordinate, mul, num
from dofkit.expressions.vectors import Vec, cross, dot, is_zero, minus, plus, scaled, square
from dofkit.models.model_document import number, vector

Drawn = tuple[float, ...]


class SpaceVector(NamedTuple):
    """A vector, and what it is in the drawing."""

    parts: Vec
    drawn: Drawn

    def plus(self, other: SpaceVector) -> SpaceVector:
        """The sum."""
        return SpaceVector(plus(self.parts, other.parts), _drawn(np.add(self.drawn, other.drawn)))

    def minus(self, other: SpaceVector) -> SpaceVector:
        """The difference."""
        return SpaceVector(minus(self.parts, other.parts), _drawn(np.subtract(self.drawn, other.drawn)))

    def times(self, factor: int | Fraction) -> SpaceVector:
        """A multiple."""
        return SpaceVector(scaled(num(factor), self.parts), _drawn(float(factor) * np.array(self.drawn)))

    def near_unit(self) -> SpaceVector:
        """A multiple whose length in the drawing is about 1."""
        size = float(np.linalg.norm(self.drawn))
        return self.times(Fraction(f"{1 / size:.1g}")) if size else self

    def cross(self, other: SpaceVector) -> SpaceVector:
        """The vector product."""
        return SpaceVector(cross(self.parts, other.parts), _drawn(np.cross(self.drawn, other.drawn)))

    def is_along(self, other: SpaceVector) -> bool:
        """Is it the other one or its opposite, as they are told?"""
        return is_zero(self.plus(other).parts) or is_zero(self.minus(other).parts)

    @property
    def constant(self) -> bool:
        """Are its components numbers?"""
        return all(part.op == "num" for part in self.parts)


def fixed_vector(values: Iterable[float]) -> SpaceVector:
    """A vector of numbers."""
    given = vector(values)
    return SpaceVector(tuple(num(Fraction(str(v))) for v in given), tuple(map(float, given)))


def moving_vector(names: Iterable[str], values: Iterable[float]) -> SpaceVector:
    """A vector whose components are coordinates."""
    return SpaceVector(tuple(map(coordinate, names)), tuple(map(float, vector(values))))


class SpacePoint(NamedTuple):
    """A point: where it is, its particle (empty: it has none), and the workplane it is drawn in (0: none)."""

    place: SpaceVector
    particle: str = ""
    plane: int = 0

    @property
    def written(self) -> str | list[float | int] | None:
        """As a point of a scene; None where it can only be told by expressions."""
        return self.particle or (vector(self.place.drawn) if self.place.constant else None)


class SpaceLine(NamedTuple):
    """A direction: of a line by its ends, or of a normal, which has none; and the plane of its ends (0: none).

    ``unit``: its length is 1.
    """

    along: SpaceVector
    ends: tuple[SpacePoint, SpacePoint] | None = None
    plane: int = 0
    unit: bool = False


class PlaneFrame(NamedTuple):
    """The axes u and v of a workplane and its normal n = u x v; ``unit``: they have length 1, else only directions."""

    u: SpaceVector
    v: SpaceVector
    n: SpaceVector
    unit: bool = True

    @property
    def constant(self) -> bool:
        """Does it never turn?"""
        return self.u.constant and self.v.constant


class SpacePlane(NamedTuple):
    """A workplane: its origin, its frame and the handle of its entity."""

    origin: SpaceVector
    frame: PlaneFrame
    handle: int


class SpaceRound(NamedTuple):
    """A circle or an arc: its centre, the square of its radius and its radius; an arc has two ends and a plane."""

    centre: SpacePoint
    squared: Expr
    radius: Expr
    frame: PlaneFrame | None
    ends: tuple[SpacePoint, SpacePoint] | None = None


class SpaceCubic(NamedTuple):
    """A cubic curve: its tangents at its two ends, and the workplane it is drawn in (0: none)."""

    tangents: tuple[SpaceVector, SpaceVector]
    plane: int


def line_between(a: SpacePoint, b: SpacePoint) -> SpaceLine:
    """The line through two points, its direction as SolveSpace has it: from the second to the first."""
    return SpaceLine(a.place.minus(b.place), (a, b), a.plane if a.plane == b.plane else 0)


def fixed_frame(drawn: Sequence[float]) -> PlaneFrame:
    """The axes of a quaternion that is given in numbers."""
    u, v, n = map(fixed_vector, _axes(drawn))
    return PlaneFrame(u, v, n)


def squared(a: SpaceVector) -> Expr:
    """a . a."""
    return square(a.parts)


def inner(a: SpaceVector, b: SpaceVector) -> Expr:
    """a . b."""
    return dot(a.parts, b.parts)


def inner_drawn(a: SpaceVector, b: SpaceVector) -> float:
    """a . b in the drawing."""
    return float(np.dot(a.drawn, b.drawn))


class Projection(NamedTuple):
    """How vectors are measured: in space (no ``frame``), or as they are seen in a workplane.

    ``within``: all that is measured lies in that plane, where both are the same.
    """

    frame: PlaneFrame | None
    within: bool

    @property
    def metric(self) -> bool:
        """Are lengths known?"""
        return self.frame is None or self.frame.unit or self.within

    @property
    def signed(self) -> bool:
        """Are areas known with their signs?"""
        return self.frame is not None and self.frame.unit

    @property
    def _plain(self) -> bool:
        """Is it shorter in space: in no workplane, or within one that turns?"""
        return self.frame is None or (self.within and not (self.signed and self.frame.constant))

    def pair(self, a: SpaceVector) -> tuple[Expr, ...]:
        """The components that are seen, up to factors where the frame is no unit."""
        return a.parts if self.frame is None else (inner(self.frame.u, a), inner(self.frame.v, a))

    def dot(self, a: SpaceVector, b: SpaceVector) -> Expr:
        """a . b."""
        return inner(a, b) if self._plain else dot(self.pair(a), self.pair(b))

    def squared(self, a: SpaceVector) -> Expr:
        """a . a."""
        return squared(a) if self._plain else square(self.pair(a))

    def cross(self, a: SpaceVector, b: SpaceVector) -> Expr:
        """a x b in a plane, up to a factor where its frame is no unit."""
        if a.is_along(b):
            return ZERO
        (au, av), (bu, bv) = self.pair(a), self.pair(b)
        return mul(au, bv) - mul(av, bu)

    def area_squared(self, a: SpaceVector, b: SpaceVector) -> Expr:
        """The square of |a x b|."""
        return squared(a.cross(b)) if self._plain else self.cross(a, b) ** 2

    def cross_drawn(self, a: SpaceVector, b: SpaceVector) -> float:
        """a x b in a plane, in the drawing."""
        return 0.0 if self.frame is None else float(np.dot(np.cross(a.drawn, b.drawn), self.frame.n.drawn))

    def dot_drawn(self, a: SpaceVector, b: SpaceVector) -> float:
        """a . b in the drawing."""
        if self.frame is None:
            return inner_drawn(a, b)
        axes = (self.frame.u, self.frame.v)
        return sum(inner_drawn(axis, a) * inner_drawn(axis, b) for axis in axes)


def _axes(q: Sequence[float]) -> tuple[Drawn, Drawn, Drawn]:
    """The columns of the rotation matrix of a quaternion of length 1."""
    w, x, y, z = q
    return (
        (w * w + x * x - y * y - z * z, 2 * (w * z + x * y), 2 * (x * z - w * y)),
        (2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (w * x + y * z)),
        (2 * (w * y + x * z), 2 * (y * z - w * x), w * w - x * x - y * y + z * z),
    )


def _drawn(values: Iterable[float]) -> Drawn:
    return tuple(float(v) for v in values)


def fraction(value: float) -> Expr:
    """A number as it would be written."""
    return num(Fraction(str(number(value))))
