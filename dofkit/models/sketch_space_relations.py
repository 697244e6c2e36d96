"""What each kind of SolveSpace's constraints says in space: constraints of a scene, by the number of the kind.

The equations are those that SolveSpace solves, its auxiliary unknowns among them, without its roots where squares say
the same. Points of one workplane are constrained in it, whether or not the constraint says so.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping

from dofkit.expressions.text import to_text
from dofkit.expressions.tree import ONE, ZERO, Expr, mul, sqrt
from dofkit.models.joint_relations import figures
from dofkit.models.model_document import number
from dofkit.models.sketch_mentions import SpaceKind, SpaceMentions, equal, zero
from dofkit.models.sketch_relations import Written
from dofkit.models.sketch_scene import UnreadError
from dofkit.models.sketch_space import (
    Projection,
    SpaceCubic,
    SpaceLine,
    SpaceRound,
    SpaceVector,
    fixed_vector,
    fraction,
    inner,
    inner_drawn,
    squared,
)

#: Distances below this are none.
NO_DISTANCE = 1e-12


def _length(m: SpaceMentions, line: SpaceLine) -> Expr:
    """The length of a line as it is seen."""
    return ONE if line.unit and m.measure.frame is None else sqrt(m.measure.squared(line.along))


def _coincident(m: SpaceMentions) -> Iterator[Written]:
    a, b = m.points
    if m.measure.frame is None and m.joinable:
        yield {"type": "coincident", "between": [a.written, b.written]}
        return
    yield from map(zero, m.measure.pair(a.place.minus(b.place)))


def _distance(m: SpaceMentions) -> Iterator[Written]:
    a, b = m.points
    apart = a.place.minus(b.place)
    plain = m.measure.frame is None or m.measure.within
    if abs(m.value) < NO_DISTANCE:
        yield from _coincident(m)
    elif plain and m.joinable:
        yield {"type": "link", "between": [a.written, b.written], "length": number(abs(m.value))}
    else:
        yield equal(m.measure.squared(apart), fraction(m.value) ** 2)


def _plane_distance(m: SpaceMentions) -> Iterator[Written]:
    """n . (p - o) = value."""
    plane = m.planes[0]
    away = inner(plane.frame.n, m.points[0].place.minus(plane.origin))
    yield equal(away, _times_length(m.value, plane.frame.n, plane.frame.unit))


def _in_plane(m: SpaceMentions) -> Iterator[Written]:
    plane = m.planes[0]
    yield zero(inner(plane.frame.n, m.points[0].place.minus(plane.origin)))


def _line_distance(m: SpaceMentions) -> Iterator[Written]:
    """|d x (p - a)| = value |d|; in a plane on the side on which it is drawn."""
    along, to = m.lines[0].along, m.to(0, 0)
    if abs(m.value) < NO_DISTANCE:
        yield from _on_line(m)
    elif not m.measure.signed:
        yield equal(m.measure.area_squared(along, to), mul(fraction(m.value) ** 2, squared(along)))
    else:
        side = math.copysign(abs(m.value), m.measure.cross_drawn(along, to))
        yield equal(m.measure.cross(along, to), mul(fraction(side), _length(m, m.lines[0])))


def _projected_distance(m: SpaceMentions) -> Iterator[Written]:
    """(q - p) . e = value |e|; of points as far apart as the line is long it is their distance."""
    apart, line = m.points[1].place.minus(m.points[0].place), m.lines[0]
    if apart.is_along(line.along) and not line.unit:
        yield from _distance(m._replace(lines=()))
        return
    yield equal(inner(apart, line.along), _times_length(m.value, line.along, line.unit))


def _times_length(value: float, a: SpaceVector, unit: bool) -> Expr:
    """A number times |a|; no root where one of them is 0 or 1."""
    if abs(value) < NO_DISTANCE:
        return ZERO
    return fraction(value) if unit else mul(fraction(value), sqrt(squared(a)))


def _on_line(m: SpaceMentions) -> Iterator[Written]:
    """p = b + t (a - b); in a plane (a - b) x (p - b) = 0."""
    along, to = m.lines[0].along, m.to(0, 0)
    if m.measure.frame is not None:
        yield zero(m.measure.cross(along, to))
        return
    yield from _multiple(m, to, along)


def _multiple(m: SpaceMentions, a: SpaceVector, b: SpaceVector) -> Iterator[Written]:
    """a = t b with a new unknown t; of a copy and what it is a copy of two of that always hold."""
    if a.is_along(b):
        yield from (zero(ZERO), zero(ZERO))
        return
    t = m.fresh(inner_drawn(a, b) / (inner_drawn(b, b) or 1.0))
    for one, other in zip(a.parts, b.parts, strict=True):
        yield equal(one, mul(t, other))


def _equal_length(m: SpaceMentions) -> Iterator[Written]:
    yield equal(*(m.measure.squared(line.along) for line in m.lines))


def _length_ratio(m: SpaceMentions) -> Iterator[Written]:
    a, b = (m.measure.squared(line.along) for line in m.lines)
    yield equal(a, mul(fraction(m.value) ** 2, b))


def _length_difference(m: SpaceMentions) -> Iterator[Written]:
    a, b = (_length(m, line) for line in m.lines)
    yield equal(a - b, fraction(m.value))


def _length_and_distance(m: SpaceMentions) -> Iterator[Written]:
    """|a|^2 |d|^2 = |d x (p - s)|^2."""
    a, d = (line.along for line in m.lines)
    yield equal(mul(m.measure.squared(a), m.measure.squared(d)), m.measure.area_squared(d, m.to(1, 0)))


def _equal_distances(m: SpaceMentions) -> Iterator[Written]:
    """|c x (p - a)| |d| = |d x (q - b)| |c|, in squares in space."""
    c, d = (line.along for line in m.lines)
    one, other = m.to(0, 0), m.to(1, 1)
    if not m.measure.signed:
        areas = m.measure.area_squared(c, one), m.measure.area_squared(d, other)
        yield equal(mul(areas[0], squared(d)), mul(areas[1], squared(c)))
        return
    side = math.copysign(1, m.measure.cross_drawn(c, one) * m.measure.cross_drawn(d, other))
    left, right = m.measure.cross(c, one), m.measure.cross(d, other)
    lengths = [_length(m, line) for line in m.lines]
    yield equal(mul(left, lengths[1]), mul(fraction(side), right, lengths[0]))


def _equal_angle(m: SpaceMentions) -> Iterator[Written]:
    """The cosines of two angles, one line turned about where the other angle is meant."""
    a, b, c, d = (line.along for line in m.lines)
    sizes = [_length(m, line) for line in m.lines]
    left = mul(fraction(-1 if m.others[0] else 1), m.measure.dot(a, b), sizes[2], sizes[3])
    yield equal(left, mul(m.measure.dot(c, d), sizes[0], sizes[1]))


def _symmetric(m: SpaceMentions) -> Iterator[Written]:
    """The middle lies in the plane, and the points are across it; in a workplane along its trace."""
    (a, b), plane = (p.place for p in m.points), m.planes[0]
    yield zero(inner(plane.frame.n, a.plus(b).minus(plane.origin.times(2))))
    if m.measure.frame is None:
        yield zero(inner(plane.frame.u, a.minus(b)))
        yield zero(inner(plane.frame.v, a.minus(b)))
    else:
        yield zero(inner(plane.frame.n.cross(m.measure.frame.n), a.minus(b)))


def _mirrored_on_axis(along: int) -> Callable[[SpaceMentions], Iterator[Written]]:
    def says(m: SpaceMentions) -> Iterator[Written]:
        a, b = (p.place for p in m.points)
        middle = a.plus(b) if m.origin is None else a.plus(b).minus(m.origin.times(2))
        yield zero(m.measure.pair(a.minus(b))[1 - along])
        yield zero(m.measure.pair(middle)[along])

    return says


def _mirrored(m: SpaceMentions) -> Iterator[Written]:
    """The line through the points is across the line of symmetry, which goes through their middle."""
    along = m.lines[0].along
    yield zero(m.measure.dot(along, m.points[0].place.minus(m.points[1].place)))
    yield zero(m.measure.cross(along, m.to(0, 0)) + m.measure.cross(along, m.to(0, 1)))


def _midpoint(m: SpaceMentions) -> Iterator[Written]:
    a, b = (p.place for p in m.lines[0].ends or m.points)
    if m.planes:
        yield zero(inner(m.planes[0].frame.n, a.plus(b).minus(m.planes[0].origin.times(2))))
    else:
        yield from map(zero, m.measure.pair(a.plus(b).minus(m.points[0].place.times(2))))


def _level(which: int) -> Callable[[SpaceMentions], Iterator[Written]]:
    def says(m: SpaceMentions) -> Iterator[Written]:
        a, b = (p.place for p in m.ends)
        yield zero(m.measure.pair(a.minus(b))[which])

    return says


def _diameter(m: SpaceMentions) -> Iterator[Written]:
    (one,) = m.rounds
    yield equal(one.squared, (fraction(m.value / 2)) ** 2) if one.ends else equal(2 * one.radius, fraction(m.value))


def _on_circle(m: SpaceMentions) -> Iterator[Written]:
    """On the cylinder over the circle."""
    one = m.rounds[0]
    to = m.points[0].place.minus(one.centre.place)
    seen = Projection(one.frame, m.points[0].plane == one.centre.plane != 0)
    if not (seen.metric if one.frame is not None else seen.within):
        raise UnreadError("the orientation of its circle is not read")
    yield equal(seen.squared(to), one.squared)


def _same_orientation(m: SpaceMentions) -> Iterator[Written]:
    """The normals are parallel, and one axis is across another one, as it is drawn."""
    one, other = m.frames
    yield from _multiple(m, one.n, other.n)
    across = min((other.v, other.u), key=lambda axis: abs(inner_drawn(one.u, axis)))
    yield zero(inner(one.u, across))


def _angle(m: SpaceMentions) -> Iterator[Written]:
    """a . b = |a| |b| cos w; in a plane a x b cos w = +- a . b sin w, to the side on which they are drawn."""
    a, b = (line.along for line in m.lines)
    if m.value % 180 == 90:
        yield from _perpendicular(m)
        return
    if m.value % 180 == 0:
        yield from _parallel(m)
        return
    if a.constant and b.constant:
        turned = (-1 if m.others[0] else 1) * m.measure.dot_drawn(a, b)
        size = math.sqrt(m.measure.dot_drawn(a, a) * m.measure.dot_drawn(b, b))
        yield zero(fraction(turned - size * math.cos(math.radians(m.value))))
        return
    angle = f"{'-' if m.value < 0 else ''}pi*{figures(abs(m.value))}/180"
    dot = m.measure.dot(a, b)
    if m.measure.signed:
        turned = m.measure.cross_drawn(a, b) * m.measure.dot_drawn(a, b) * math.tan(math.radians(m.value))
        side = "-" if turned < 0 else ""
        left, right = to_text(m.measure.cross(a, b)), to_text(dot)
        yield {"type": "equation", "text": f"({left})*cos({angle}) = {side}({right})*sin({angle})"}
    else:
        lengths = to_text(mul(*(_length(m, line) for line in m.lines)))
        side = "-" if m.others[0] else ""
        yield {"type": "equation", "text": f"{side}({to_text(dot)}) = {lengths}*cos({angle})"}


def _parallel(m: SpaceMentions) -> Iterator[Written]:
    yield from _along(m, m.lines[0].along, m.lines[1].along)


def _along(m: SpaceMentions, a: SpaceVector, b: SpaceVector) -> Iterator[Written]:
    if m.measure.frame is not None:
        yield zero(m.measure.cross(a, b))
    else:
        yield from _multiple(m, a, b)


def _perpendicular(m: SpaceMentions) -> Iterator[Written]:
    yield zero(m.measure.dot(m.lines[0].along, m.lines[1].along))


def _tangent_line(m: SpaceMentions) -> Iterator[Written]:
    """The line is across the radius to the arc's end."""
    (arc,), (line,) = m.rounds, m.lines
    if arc.ends is not None:
        yield zero(inner(line.along, arc.centre.place.minus(arc.ends[m.others[0]].place)))


def _tangent_cubic(m: SpaceMentions) -> Iterator[Written]:
    """The line is along the cubic's end."""
    for along in m.directions:
        yield from _along(m, along, m.lines[0].along)


def _tangent_curves(m: SpaceMentions) -> Iterator[Written]:
    """Radii of arcs to where they meet are parallel, and so are tangents of cubics; one of each are perpendicular."""
    found = m.directions
    if len(found) == len(m.curves):
        yield zero(inner(*found) if len(m.rounds) == 1 else m.measure.cross(*found))


def _equal_radius(m: SpaceMentions) -> Iterator[Written]:
    yield equal(m.rounds[0].squared, m.rounds[1].squared)


def _dragged(m: SpaceMentions) -> Iterator[Written]:
    (point,) = m.points
    if m.measure.frame is None and point.particle:
        yield {"type": "fixed", "point": point.particle}
        return
    for part, axis in zip(m.measure.pair(point.place), _axes_of(m.measure), strict=True):
        yield equal(part, fraction(inner_drawn(axis, point.place)))


def _axes_of(measure: Projection) -> tuple[SpaceVector, ...]:
    if measure.frame is None:
        return tuple(fixed_vector(float(i == k) for i in range(3)) for k in range(3))
    return measure.frame.u, measure.frame.v


_VECTORS = ((0, 2, 0, 0, 0), (0, 1, 1, 0, 0), (0, 0, 2, 0, 0))
_ANGLES = tuple((0, 4 - k, k, 0, 0) for k in range(5))
#: The kinds by their numbers in a file; their names are those of the kinds in a plane.
SPACE_KINDS: Mapping[int, SpaceKind] = {
    20: SpaceKind(_coincident, ((2, 0, 0, 0, 0),)),
    30: SpaceKind(_distance, ((2, 0, 0, 0, 0),), metric=True),
    31: SpaceKind(_plane_distance, ((1, 0, 0, 1, 0),), seen=False),
    32: SpaceKind(_line_distance, ((1, 1, 0, 0, 0),), metric=True),
    33: SpaceKind(_plane_distance, ((1, 0, 0, 1, 0),), seen=False),
    34: SpaceKind(_projected_distance, ((2, 1, 0, 0, 0), (2, 0, 1, 0, 0)), seen=False),
    41: SpaceKind(_in_plane, ((1, 0, 0, 1, 0),), seen=False),
    42: SpaceKind(_on_line, ((1, 1, 0, 0, 0),)),
    43: SpaceKind(_in_plane, ((1, 0, 0, 1, 0),), seen=False),
    50: SpaceKind(_equal_length, ((0, 2, 0, 0, 0),), metric=True),
    51: SpaceKind(_length_ratio, ((0, 2, 0, 0, 0),), metric=True),
    52: SpaceKind(_length_and_distance, ((1, 2, 0, 0, 0),), metric=True),
    53: SpaceKind(_equal_distances, ((2, 2, 0, 0, 0),), metric=True),
    54: SpaceKind(_equal_angle, _ANGLES, metric=True),
    56: SpaceKind(_length_difference, ((0, 2, 0, 0, 0),), metric=True),
    60: SpaceKind(_symmetric, ((2, 0, 0, 1, 0),)),
    61: SpaceKind(_mirrored_on_axis(0), ((2, 0, 0, 0, 0),), flat=True),
    62: SpaceKind(_mirrored_on_axis(1), ((2, 0, 0, 0, 0),), flat=True),
    63: SpaceKind(_mirrored, ((2, 1, 0, 0, 0),), flat=True, metric=True),
    70: SpaceKind(_midpoint, ((1, 1, 0, 0, 0), (0, 1, 0, 1, 0))),
    80: SpaceKind(_level(1), ((2, 0, 0, 0, 0), (0, 1, 0, 0, 0)), flat=True),
    81: SpaceKind(_level(0), ((2, 0, 0, 0, 0), (0, 1, 0, 0, 0)), flat=True),
    90: SpaceKind(_diameter, ((0, 0, 0, 0, 1),), seen=False),
    100: SpaceKind(_on_circle, ((1, 0, 0, 0, 1),), seen=False),
    110: SpaceKind(_same_orientation, ((0, 0, 2, 0, 0),), seen=False),
    120: SpaceKind(_angle, _VECTORS, metric=True),
    121: SpaceKind(_parallel, _VECTORS),
    122: SpaceKind(_perpendicular, _VECTORS, metric=True),
    124: SpaceKind(_tangent_cubic, ((0, 1, 0, 0, 1),), curves=(SpaceCubic,)),
    123: SpaceKind(_tangent_line, ((0, 1, 0, 0, 1),), seen=False),
    125: SpaceKind(_tangent_curves, ((0, 0, 0, 0, 2),), flat=True, curves=(SpaceRound, SpaceCubic)),
    130: SpaceKind(_equal_radius, ((0, 0, 0, 0, 2),), seen=False),
    200: SpaceKind(_dragged, ((1, 0, 0, 0, 0),)),
}
