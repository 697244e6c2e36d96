"""Points, lines, circles and arcs of a sketch in a plane as texts in a scene's coordinates, and as they are drawn."""

from __future__ import annotations

import math
from typing import NamedTuple

from dofkit.models.joint_relations import figures


class SketchPoint(NamedTuple):
    """A point: its coordinates as text, where it is drawn, and its particle (None: it is fixed)."""

    x: str
    y: str
    at: tuple[float, float]
    particle: str | None = None

    @property
    def written(self) -> str | list[float]:
        """As a point of a scene."""
        return self.particle if self.particle is not None else [*self.at]


def particle_point(name: str, at: tuple[float, float]) -> SketchPoint:
    """The point that a particle is."""
    return SketchPoint(f"x_{name}", f"y_{name}", at, name)


def fixed_point(at: tuple[float, float]) -> SketchPoint:
    """A point that stays where it is drawn."""
    return SketchPoint(figures(at[0]), figures(at[1]), at)


class Arrow(NamedTuple):
    """From one point to another."""

    start: SketchPoint
    end: SketchPoint

    @property
    def parts(self) -> tuple[str, str]:
        """Its components as text."""
        return _less(self.end.x, self.start.x), _less(self.end.y, self.start.y)

    @property
    def drawn(self) -> tuple[float, float]:
        """Its components in the drawing."""
        return self.end.at[0] - self.start.at[0], self.end.at[1] - self.start.at[1]

    @property
    def squared(self) -> str:
        """The square of its length."""
        u, v = self.parts
        return f"({u}^2 + {v}^2)"

    @property
    def length(self) -> str:
        """Its length."""
        return f"sqrt{self.squared}"


class Round(NamedTuple):
    """A circle or an arc: its centre, the square of its radius and its radius as text; an arc has two ends."""

    centre: SketchPoint
    squared: str
    radius: str
    ends: tuple[SketchPoint, SketchPoint] | None = None


class Cubic(NamedTuple):
    """A cubic curve: its tangents at its two ends."""

    tangents: tuple[Arrow, Arrow]


def cross(a: Arrow, b: Arrow) -> str:
    """a x b: 0 where they are parallel."""
    (au, av), (bu, bv) = a.parts, b.parts
    return f"({au}*{bv} - {av}*{bu})"


def dot(a: Arrow, b: Arrow) -> str:
    """a . b: 0 where they are perpendicular."""
    (au, av), (bu, bv) = a.parts, b.parts
    return f"({au}*{bu} + {av}*{bv})"


def drawn_cross(a: Arrow, b: Arrow) -> float:
    """a x b in the drawing."""
    return a.drawn[0] * b.drawn[1] - a.drawn[1] * b.drawn[0]


def drawn_dot(a: Arrow, b: Arrow) -> float:
    """a . b in the drawing."""
    return a.drawn[0] * b.drawn[0] + a.drawn[1] * b.drawn[1]


def at_angle(a: Arrow, b: Arrow, degrees: float) -> str:
    """Lines at an angle, to the side on which they are drawn: a x b cos w = +- a . b sin w.

    A right angle is a . b = 0, none is a x b = 0.
    """
    if degrees % 180 == 90:
        return f"{dot(a, b)} = 0"
    if degrees % 180 == 0:
        return f"{cross(a, b)} = 0"
    side = "-" if drawn_cross(a, b) * drawn_dot(a, b) * math.tan(math.radians(degrees)) < 0 else ""
    angle = f"pi*{figures(degrees)}/180" if degrees >= 0 else f"-pi*{figures(-degrees)}/180"
    return f"{cross(a, b)}*cos({angle}) = {side}{dot(a, b)}*sin({angle})"


def _less(a: str, b: str) -> str:
    if b.startswith("-"):
        return f"({a} + {b[1:]})"
    return f"({a} - {b})" if b != "0" else f"({a})"
