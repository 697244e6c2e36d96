"""What each kind of SolveSpace's constraints says in a plane: constraints of a scene, by the number of the kind.

The equations are those that SolveSpace solves, without its roots where squares say the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from dofkit.models.joint_relations import figures
from dofkit.models.model_document import number
from dofkit.models.sketch_geometry import Arrow, Cubic, Round, SketchPoint, at_angle, cross, dot, drawn_cross

#: A constraint of a scene without its name.
Written = dict[str, Any]


class SketchMentions(NamedTuple):
    """What a constraint of a sketch mentions: its points, lines and curves, its number and its two choices."""

    points: tuple[SketchPoint, ...]
    lines: tuple[Arrow, ...]
    curves: tuple[Round | Cubic, ...]
    value: float
    other: bool
    other2: bool

    @property
    def rounds(self) -> tuple[Round, ...]:
        """Its circles and arcs."""
        return tuple(one for one in self.curves if isinstance(one, Round))

    def directions(self) -> tuple[Arrow, ...]:
        """Where its curves meet: across arcs, along cubics."""
        found = []
        for one, end in zip(self.curves, (self.other, self.other2), strict=False):
            if isinstance(one, Cubic):
                found.append(one.tangents[end])
            elif one.ends is not None:
                found.append(Arrow(one.centre, one.ends[end]))
        return tuple(found)


class SketchKind(NamedTuple):
    """A kind: its name in SolveSpace, and what it says (None: it is not read).

    ``needs``: how many points, lines and curves, in one way or another; ``curves``: of which types these are.
    """

    name: str
    says: Callable[[SketchMentions], Iterator[Written]] | None
    needs: tuple[tuple[int, int, int], ...] = ()
    curves: tuple[type, ...] = (Round,)


def _equation(text: str) -> Written:
    return {"type": "equation", "text": text}


def _link(first: SketchPoint, second: SketchPoint, length: float) -> Written:
    return {"type": "link", "between": [first.written, second.written], "length": number(length)}


def _coincident(m: SketchMentions) -> Iterator[Written]:
    yield {"type": "coincident", "between": [point.written for point in m.points]}


def _distance(m: SketchMentions) -> Iterator[Written]:
    yield _link(m.points[0], m.points[1], m.value)


def _line_distance(m: SketchMentions) -> Iterator[Written]:
    """d x (p - a) = +-value |d|, to the side on which it is drawn."""
    line = m.lines[0]
    to = Arrow(line.start, m.points[0])
    side = "-" if drawn_cross(line, to) < 0 else ""
    yield _equation(f"{cross(line, to)} = {side}{figures(abs(m.value))}*{line.length}")


def _on_line(m: SketchMentions) -> Iterator[Written]:
    yield _equation(f"{cross(m.lines[0], Arrow(m.lines[0].start, m.points[0]))} = 0")


def _equal_length(m: SketchMentions) -> Iterator[Written]:
    yield _equation(f"{m.lines[0].squared} = {m.lines[1].squared}")


def _length_ratio(m: SketchMentions) -> Iterator[Written]:
    yield _equation(f"{m.lines[0].squared} = {figures(m.value)}^2*{m.lines[1].squared}")


def _length_difference(m: SketchMentions) -> Iterator[Written]:
    yield _equation(f"{m.lines[0].length} - {m.lines[1].length} = {figures(m.value)}")


def _length_and_distance(m: SketchMentions) -> Iterator[Written]:
    """|a| |d| = +-d x (p - s): the length of one line is the distance of a point from the other."""
    first, line = m.lines
    to = Arrow(line.start, m.points[0])
    side = "-" if drawn_cross(line, to) < 0 else ""
    yield _equation(f"{first.length}*{line.length} = {side}{cross(line, to)}")


def _equal_distances(m: SketchMentions) -> Iterator[Written]:
    one, other = (Arrow(line.start, p) for line, p in zip(m.lines, m.points, strict=True))
    a, b = m.lines
    side = "-" if drawn_cross(a, one) * drawn_cross(b, other) < 0 else ""
    yield _equation(f"{cross(a, one)}*{b.length} = {side}{cross(b, other)}*{a.length}")


def _equal_angle(m: SketchMentions) -> Iterator[Written]:
    """The cosines of two angles, their lines turned about where the other angle is meant."""
    a, b, c, d = m.lines
    sign = "-" if m.other else ""
    yield _equation(f"{sign}{dot(a, b)}*{c.length}*{d.length} = {dot(c, d)}*{a.length}*{b.length}")


def _mirrored(m: SketchMentions) -> Iterator[Written]:
    """The line through the points is across the line of symmetry, which goes through their middle."""
    (p, q), line = m.points, m.lines[0]
    yield _equation(f"{dot(line, Arrow(p, q))} = 0")
    yield _equation(f"{cross(line, Arrow(line.start, p))} + {cross(line, Arrow(line.start, q))} = 0")


def _mirrored_on_axis(along: int) -> Callable[[SketchMentions], Iterator[Written]]:
    def says(m: SketchMentions) -> Iterator[Written]:
        p, q = m.points
        same, opposite = ((p.y, q.y), (p.x, q.x)) if along == 0 else ((p.x, q.x), (p.y, q.y))
        yield _equation(f"{same[0]} = {same[1]}")
        yield _equation(f"{opposite[0]} + {opposite[1]} = 0")

    return says


def _midpoint(m: SketchMentions) -> Iterator[Written]:
    p, line = m.points[0], m.lines[0]
    yield _equation(f"2*{_wrapped(p.x)} = {line.start.x} + {_wrapped(line.end.x)}")
    yield _equation(f"2*{_wrapped(p.y)} = {line.start.y} + {_wrapped(line.end.y)}")


def _level(which: int) -> Callable[[SketchMentions], Iterator[Written]]:
    def says(m: SketchMentions) -> Iterator[Written]:
        ends = (m.lines[0].start, m.lines[0].end) if m.lines else m.points
        yield _equation(f"{ends[0][which]} = {ends[1][which]}")

    return says


def _diameter(m: SketchMentions) -> Iterator[Written]:
    (one,) = m.rounds
    if one.ends is not None:
        yield _link(one.centre, one.ends[0], m.value / 2)
    else:
        yield _equation(f"2*{one.radius} = {figures(m.value)}")


def _on_circle(m: SketchMentions) -> Iterator[Written]:
    yield _equation(f"{Arrow(m.rounds[0].centre, m.points[0]).squared} = {m.rounds[0].squared}")


def _angle(m: SketchMentions) -> Iterator[Written]:
    yield _equation(at_angle(m.lines[0], m.lines[1], m.value))


def _parallel(m: SketchMentions) -> Iterator[Written]:
    yield _equation(f"{cross(*m.lines)} = 0")


def _perpendicular(m: SketchMentions) -> Iterator[Written]:
    yield _equation(f"{dot(*m.lines)} = 0")


def _tangent_line(m: SketchMentions) -> Iterator[Written]:
    """The line is across the radius to the arc's end."""
    (arc,), (line,) = m.rounds, m.lines
    if arc.ends is not None:
        yield _equation(f"{dot(line, Arrow(arc.centre, arc.ends[m.other]))} = 0")


def _tangent_cubic(m: SketchMentions) -> Iterator[Written]:
    """The line is along the cubic's end."""
    for along in m.directions():
        yield _equation(f"{cross(along, m.lines[0])} = 0")


def _tangent_curves(m: SketchMentions) -> Iterator[Written]:
    """Radii of arcs to where they meet are parallel, and so are tangents of cubics; one of each are perpendicular."""
    found = m.directions()
    if len(found) == len(m.curves):
        yield _equation(f"{(dot if len(m.rounds) == 1 else cross)(*found)} = 0")


def _equal_radius(m: SketchMentions) -> Iterator[Written]:
    yield _equation(f"{m.rounds[0].squared} = {m.rounds[1].squared}")


def _dragged(m: SketchMentions) -> Iterator[Written]:
    yield {"type": "fixed", "point": m.points[0].written}


def _wrapped(text: str) -> str:
    return f"({text})" if text.startswith("-") else text


#: The kinds by their numbers in a file.
KINDS: Mapping[int, SketchKind] = {
    20: SketchKind("points-coincident", _coincident, ((2, 0, 0),)),
    30: SketchKind("pt-pt-distance", _distance, ((2, 0, 0),)),
    31: SketchKind("pt-plane-distance", None),
    32: SketchKind("pt-line-distance", _line_distance, ((1, 1, 0),)),
    33: SketchKind("pt-face-distance", None),
    34: SketchKind("proj-pt-pt-distance", None),
    41: SketchKind("pt-in-plane", None),
    42: SketchKind("pt-on-line", _on_line, ((1, 1, 0),)),
    43: SketchKind("pt-on-face", None),
    50: SketchKind("eq-length", _equal_length, ((0, 2, 0),)),
    51: SketchKind("length-ratio", _length_ratio, ((0, 2, 0),)),
    52: SketchKind("eq-length-and-pt-ln-dist", _length_and_distance, ((1, 2, 0),)),
    53: SketchKind("eq-pt-line-distances", _equal_distances, ((2, 2, 0),)),
    54: SketchKind("eq-angle", _equal_angle, ((0, 4, 0),)),
    55: SketchKind("eq-line-len-arc-len", None),
    56: SketchKind("length-difference", _length_difference, ((0, 2, 0),)),
    60: SketchKind("symmetric", None),
    61: SketchKind("symmetric-h", _mirrored_on_axis(0), ((2, 0, 0),)),
    62: SketchKind("symmetric-v", _mirrored_on_axis(1), ((2, 0, 0),)),
    63: SketchKind("symmetric-line", _mirrored, ((2, 1, 0),)),
    70: SketchKind("at-midpoint", _midpoint, ((1, 1, 0),)),
    80: SketchKind("horizontal", _level(1), ((2, 0, 0), (0, 1, 0))),
    81: SketchKind("vertical", _level(0), ((2, 0, 0), (0, 1, 0))),
    90: SketchKind("diameter", _diameter, ((0, 0, 1),)),
    100: SketchKind("pt-on-circle", _on_circle, ((1, 0, 1),)),
    110: SketchKind("same-orientation", None),
    120: SketchKind("angle", _angle, ((0, 2, 0),)),
    121: SketchKind("parallel", _parallel, ((0, 2, 0),)),
    122: SketchKind("perpendicular", _perpendicular, ((0, 2, 0),)),
    123: SketchKind("arc-line-tangent", _tangent_line, ((0, 1, 1),)),
    124: SketchKind("cubic-line-tangent", _tangent_cubic, ((0, 1, 1),), (Cubic,)),
    125: SketchKind("curve-curve-tangent", _tangent_curves, ((0, 0, 2),), (Round, Cubic)),
    130: SketchKind("eq-radius", _equal_radius, ((0, 0, 2),)),
    200: SketchKind("lock-where-dragged", _dragged, ((1, 0, 0),)),
}  # fmt: skip
