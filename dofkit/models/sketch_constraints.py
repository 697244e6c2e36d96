"""Constraints of a SolveSpace sketch in a plane as constraints of a scene, by the number of their kind.

The equations are those of SolveSpace, with squares instead of roots where they are equivalent. Points, lines and curves
are formulas in the scene's coordinates, together with their positions in the reference configuration.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

from dofkit.models.joint_relations import figures
from dofkit.models.model_document import number

#: A constraint of a scene without its name; a text is an equation.
Written = str | dict[str, Any]


class SketchPoint(NamedTuple):
    """A point: its coordinates as formulas, its reference position, and its particle (None for a fixed point)."""

    x: str
    y: str
    at: tuple[float, float]
    particle: str | None = None

    @property
    def written(self) -> str | list[float]:
        """The point as a scene writes it."""
        return self.particle if self.particle is not None else [*self.at]


class Arrow(NamedTuple):
    """The vector from one point to another."""

    start: SketchPoint
    end: SketchPoint

    @property
    def components(self) -> tuple[str, str]:
        """The components as formulas."""
        return _difference(self.end.x, self.start.x), _difference(self.end.y, self.start.y)

    @property
    def drawn(self) -> tuple[float, float]:
        """The components in the reference configuration."""
        return self.end.at[0] - self.start.at[0], self.end.at[1] - self.start.at[1]

    @property
    def squared(self) -> str:
        """The squared length as a formula."""
        u, v = self.components
        return f"({u}^2 + {v}^2)"

    @property
    def length(self) -> str:
        """The length as a formula."""
        return f"sqrt{self.squared}"


class Round(NamedTuple):
    """A circle or an arc: its centre, squared radius and radius as formulas; an arc has two ends."""

    centre: SketchPoint
    squared: str
    radius: str
    ends: tuple[SketchPoint, SketchPoint] | None = None


class SketchMentions(NamedTuple):
    """The points, lines and curves of a sketch's constraint, its number (``value``) and its two choices."""

    points: tuple[SketchPoint, ...]
    lines: tuple[Arrow, ...]
    curves: tuple[Round, ...]
    value: float
    other: bool
    other2: bool

    @property
    def line(self) -> Arrow:
        """The first line."""
        return self.lines[0]

    def arms(self) -> tuple[Arrow, ...]:
        """Return the vector from the start of each line to each point, in pairs."""
        return tuple(Arrow(line.start, point) for line, point in zip(self.lines, self.points, strict=False))

    def radii(self) -> tuple[Arrow, ...]:
        """Return the vector from the centre of each arc to the end that the constraint is about; a circle has none."""
        ends = zip(self.curves, (self.other, self.other2), strict=False)
        return tuple(Arrow(curve.centre, curve.ends[end]) for curve, end in ends if curve.ends is not None)


class SketchKind(NamedTuple):
    """A kind of constraint: its name in SolveSpace, what it refers to, and the function that writes it.

    ``needs``: the possible numbers of (points, lines, curves).
    """

    name: str
    needs: tuple[tuple[int, int, int], ...]
    writes: Callable[[SketchMentions], Iterable[Written]]


def cross(a: Arrow, b: Arrow) -> str:
    """Return a x b as a formula."""
    (au, av), (bu, bv) = a.components, b.components
    return f"({au}*{bv} - {av}*{bu})"


def dot(a: Arrow, b: Arrow) -> str:
    """Return a . b as a formula."""
    (au, av), (bu, bv) = a.components, b.components
    return f"({au}*{bu} + {av}*{bv})"


def _drawn_cross(a: Arrow, b: Arrow) -> float:
    return a.drawn[0] * b.drawn[1] - a.drawn[1] * b.drawn[0]


def _drawn_dot(a: Arrow, b: Arrow) -> float:
    return a.drawn[0] * b.drawn[0] + a.drawn[1] * b.drawn[1]


def _minus(negative: bool) -> str:
    return "-" if negative else ""


def _difference(a: str, b: str) -> str:
    if b.startswith("-"):
        return f"({a} + {b[1:]})"
    return f"({a} - {b})" if b != "0" else f"({a})"


def _bracketed(text: str) -> str:
    return f"({text})" if text.startswith("-") else text


def at_angle(a: Arrow, b: Arrow, degrees: float) -> str:
    """Return the equation of two lines at an angle w: a x b cos w = +-a . b sin w, with the sign of the reference."""
    if degrees % 180 == 90:
        return f"{dot(a, b)} = 0"
    if degrees % 180 == 0:
        return f"{cross(a, b)} = 0"
    side = _minus(_drawn_cross(a, b) * _drawn_dot(a, b) * math.tan(math.radians(degrees)) < 0)
    angle = f"{_minus(degrees < 0)}pi*{figures(abs(degrees))}/180"
    return f"{cross(a, b)}*cos({angle}) = {side}{dot(a, b)}*sin({angle})"


def _link(first: SketchPoint, second: SketchPoint, length: float) -> Written:
    return {"type": "link", "between": [first.written, second.written], "length": number(length)}


def _line_distance(m: SketchMentions) -> Iterable[Written]:
    """Yield d x (p - a) = +-value |d|, for the side of the line on which the point p is in the reference."""
    arm = m.arms()[0]
    side = _minus(_drawn_cross(m.line, arm) < 0)
    yield f"{cross(m.line, arm)} = {side}{figures(abs(m.value))}*{m.line.length}"


def _length_and_distance(m: SketchMentions) -> Iterable[Written]:
    """Yield |a| |d| = +-d x (p - s): the length of the line a is the distance of p from the line d through s."""
    first, line = m.lines
    arm = Arrow(line.start, m.points[0])
    yield f"{first.length}*{line.length} = {_minus(_drawn_cross(line, arm) < 0)}{cross(line, arm)}"


def _equal_distances(m: SketchMentions) -> Iterable[Written]:
    (a, b), (to_first, to_second) = m.lines, m.arms()
    side = _minus(_drawn_cross(a, to_first) * _drawn_cross(b, to_second) < 0)
    yield f"{cross(a, to_first)}*{b.length} = {side}{cross(b, to_second)}*{a.length}"


def _equal_angle(m: SketchMentions) -> Iterable[Written]:
    """Yield the equation that the cosines of two angles are equal, or opposite for the supplement."""
    a, b, c, d = m.lines
    yield f"{_minus(m.other)}{dot(a, b)}*{c.length}*{d.length} = {dot(c, d)}*{a.length}*{b.length}"


def _mirrored(m: SketchMentions) -> Iterable[Written]:
    """Yield the equations that p - q is perpendicular to the line of symmetry, and their midpoint on this line."""
    (p, q), line = m.points, m.line
    yield f"{dot(line, Arrow(p, q))} = 0"
    yield f"{cross(line, Arrow(line.start, p))} + {cross(line, Arrow(line.start, q))} = 0"


def _mirrored_on_axis(same: int) -> Callable[[SketchMentions], Iterable[Written]]:
    """Return the function that writes that two points have coordinate ``same`` in common, and opposite others."""
    return lambda m: (
        f"{m.points[0][same]} = {m.points[1][same]}",
        f"{m.points[0][1 - same]} + {m.points[1][1 - same]} = 0",
    )


def _level(which: int) -> Callable[[SketchMentions], Iterable[Written]]:
    """Return the function that writes that two points, or the ends of a line, have coordinate ``which`` in common."""

    def writes(m: SketchMentions) -> Iterable[Written]:
        ends = (m.line.start, m.line.end) if m.lines else m.points
        yield f"{ends[0][which]} = {ends[1][which]}"

    return writes


def _midpoint(m: SketchMentions) -> Iterable[Written]:
    point, line = m.points[0], m.line
    yield f"2*{_bracketed(point.x)} = {line.start.x} + {_bracketed(line.end.x)}"
    yield f"2*{_bracketed(point.y)} = {line.start.y} + {_bracketed(line.end.y)}"


def _diameter(m: SketchMentions) -> Iterable[Written]:
    """Yield the equation of a diameter: of a circle by its radius, of an arc by the distance to its first end."""
    (curve,) = m.curves
    if curve.ends is not None:
        yield _link(curve.centre, curve.ends[0], m.value / 2)
    else:
        yield f"2*{curve.radius} = {figures(m.value)}"


def _tangent_line(m: SketchMentions) -> Iterable[Written]:
    """Yield the equation that a line is perpendicular to the radius at the end of an arc."""
    for radius in m.radii():
        yield f"{dot(radius, m.line)} = 0"


def _tangent_arcs(m: SketchMentions) -> Iterable[Written]:
    """Yield the equation that the radii of two arcs to their common point are parallel."""
    radii = m.radii()
    if len(radii) == len(m.curves):
        yield f"{cross(*radii)} = 0"


#: {number of a kind in a file: kind}, for the kinds that are read.
KINDS: Mapping[int, SketchKind] = {
    20: SketchKind("points-coincident", ((2, 0, 0),),
                   lambda m: [{"type": "coincident", "between": [p.written for p in m.points]}]),
    30: SketchKind("pt-pt-distance", ((2, 0, 0),), lambda m: [_link(m.points[0], m.points[1], m.value)]),
    32: SketchKind("pt-line-distance", ((1, 1, 0),), _line_distance),
    42: SketchKind("pt-on-line", ((1, 1, 0),), lambda m: [f"{cross(m.line, m.arms()[0])} = 0"]),
    50: SketchKind("eq-length", ((0, 2, 0),), lambda m: [f"{m.lines[0].squared} = {m.lines[1].squared}"]),
    51: SketchKind("length-ratio", ((0, 2, 0),),
                   lambda m: [f"{m.lines[0].squared} = {figures(m.value)}^2*{m.lines[1].squared}"]),
    52: SketchKind("eq-length-and-pt-ln-dist", ((1, 2, 0),), _length_and_distance),
    53: SketchKind("eq-pt-line-distances", ((2, 2, 0),), _equal_distances),
    54: SketchKind("eq-angle", ((0, 4, 0),), _equal_angle),
    56: SketchKind("length-difference", ((0, 2, 0),),
                   lambda m: [f"{m.lines[0].length} - {m.lines[1].length} = {figures(m.value)}"]),
    61: SketchKind("symmetric-h", ((2, 0, 0),), _mirrored_on_axis(1)),
    62: SketchKind("symmetric-v", ((2, 0, 0),), _mirrored_on_axis(0)),
    63: SketchKind("symmetric-line", ((2, 1, 0),), _mirrored),
    70: SketchKind("at-midpoint", ((1, 1, 0),), _midpoint),
    80: SketchKind("horizontal", ((2, 0, 0), (0, 1, 0)), _level(1)),
    81: SketchKind("vertical", ((2, 0, 0), (0, 1, 0)), _level(0)),
    90: SketchKind("diameter", ((0, 0, 1),), _diameter),
    100: SketchKind("pt-on-circle", ((1, 0, 1),),
                    lambda m: [f"{Arrow(m.curves[0].centre, m.points[0]).squared} = {m.curves[0].squared}"]),
    120: SketchKind("angle", ((0, 2, 0),), lambda m: [at_angle(m.lines[0], m.lines[1], m.value)]),
    121: SketchKind("parallel", ((0, 2, 0),), lambda m: [f"{cross(*m.lines)} = 0"]),
    122: SketchKind("perpendicular", ((0, 2, 0),), lambda m: [f"{dot(*m.lines)} = 0"]),
    123: SketchKind("arc-line-tangent", ((0, 1, 1),), _tangent_line),
    125: SketchKind("curve-curve-tangent", ((0, 0, 2),), _tangent_arcs),
    130: SketchKind("eq-radius", ((0, 0, 2),), lambda m: [f"{m.curves[0].squared} = {m.curves[1].squared}"]),
    200: SketchKind("lock-where-dragged", ((1, 0, 0),), lambda m: [{"type": "fixed", "point": m.points[0].written}]),
}  # fmt: skip
#: The kinds that are not read: in space, of cubic curves, and of lengths of arcs.
NOT_READ: Mapping[int, str] = {
    31: "pt-plane-distance", 33: "pt-face-distance", 34: "proj-pt-pt-distance", 41: "pt-in-plane", 43: "pt-on-face",
    55: "eq-line-len-arc-len", 60: "symmetric", 110: "same-orientation",
    124: "cubic-line-tangent",
}  # fmt: skip
