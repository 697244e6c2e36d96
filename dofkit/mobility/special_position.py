"""Special positions in the geometry of dependent constraints: lines that are parallel or meet in one point, and so on.

They are searched among the constraints of one dependent set. A determinant that is 0 modulo p is exactly 0, except with
a probability of at most degree/p; with floats (p = 0, in units of the scene's size) it is so within the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from dofkit.base.wording import series
from dofkit.exact.matrices.sparse import Numbers, cross, perpendicular, rank_of_rows
from dofkit.expressions.text import to_text
from dofkit.mobility.placement import Placement
from dofkit.system import GROUND, Connection, System

#: Bound on the lines or points that are compared.
MOST = 40
#: Any so many points are on a conic.
CONIC = 5
_OTHERWISE = (
    "the cause is not parallel or concurrent lines: a loop has special proportions, or is symmetric or overconstrained"
)


@dataclass(frozen=True)
class NamedLine:
    """A line of the reference configuration with its name in sentences, and its ``ends`` if it is a bar."""

    name: str
    through: tuple[Any, ...]
    direction: tuple[Any, ...]
    ends: frozenset[str] = frozenset()


class Geometry:
    """Predicates on numbers modulo p, or on floats within ``tolerance``."""

    def __init__(self, system: System, placement: Placement, tolerance: float) -> None:
        self.system, self.placement, self._tolerance = system, placement, tolerance
        self.names = [c.name for c in system.constraints]

    def zero(self, *numbers: Any) -> bool:
        p = self.placement.p
        return all((n % p == 0) if p else abs(n) <= self._tolerance for n in numbers)

    def unit(self, n: Numbers) -> tuple[Any, ...]:
        """Return a vector with length 1 if numbers are floats; unchanged modulo p."""
        if self.placement.p:
            return tuple(n)
        size = sum(v * v for v in n) ** 0.5
        return tuple(v / size for v in n) if size else tuple(n)

    def parallel(self, a: Numbers, b: Numbers) -> bool:
        return self.zero(*_wedge(a, b))

    def on(self, line: NamedLine, point: Numbers) -> bool:
        return self.parallel(line.direction, _difference(point, line.through))

    def meet(self, a: NamedLine, b: NamedLine) -> bool:
        """Return whether two lines in space are in one plane, so that they meet or are parallel."""
        return self.zero(_dot(_difference(b.through, a.through), cross(a.direction, b.direction)))

    def concurrent(self, a: NamedLine, b: NamedLine, c: NamedLine) -> bool:
        """Return whether three lines in the plane meet in one point, or are parallel (dependent coordinates)."""
        return self.zero(_dot(_line(a), cross(_line(b), _line(c))))


def special_facts(
    system: System, placement: Placement, sets: Sequence[Sequence[int]], tolerance: float = 0.0
) -> list[str]:
    """Return sentences on what is special in each dependent set of constraints."""
    geometry = Geometry(system, placement, tolerance)
    facts: list[str] = []
    for members in sets:
        facts += _of_texts(geometry, members)
        facts += _facts_of_set(geometry, [system.connections[i] for i in members])
    return list(dict.fromkeys(facts)) or [_OTHERWISE]


def _of_texts(g: Geometry, members: Sequence[int]) -> Iterator[str]:
    """Yield a sentence if a set contains formulas and other constraints: these fit at the reference only."""
    texts = [g.names[i] for i in members if g.system.constraints[i].facts.written]
    if texts and len(texts) < len(members):
        yield (
            f"what {series(texts)} say{'s' * (len(texts) == 1)} is consistent with the others at the reference "
            "configuration only"
        )


def _facts_of_set(g: Geometry, members: Sequence[Connection]) -> Iterator[str]:
    """Yield what is special about axes, sliding directions, bars and points of some connections."""
    axes = list(_axes(g, members))
    bars = [*_links(g, members), *_bars(g, members)]
    if len(axes) > MOST or len(bars) > MOST:
        return
    yield from _of_axes(g, axes)
    yield from _of_slides(g, members)
    yield from _of_bars(g, bars, members)
    yield from _of_points(g, members)


def _axes(g: Geometry, members: Sequence[Connection]) -> Iterator[NamedLine]:
    """Yield the axes of joints in space, each with the name of its joint."""
    for c in members:
        at = g.placement.located[c.constraint]
        if g.system.dimension == 3 and c.facts.axial and at.places:
            yield from (NamedLine(g.names[c.constraint], at.places[0], g.unit(n)) for n in at.directions)


def _of_axes(g: Geometry, axes: Sequence[NamedLine]) -> Iterator[str]:
    """Yield what is special about axes: on one line, parallel, in one plane or through one point."""
    classes = _classes(axes, lambda a, b: g.parallel(a.direction, b.direction))
    alike = [c for c in classes if len(c) > 1]
    for same in alike:
        coaxial = [c for c in _classes(same, lambda a, b: g.on(a, b.through)) if len(c) > 1]
        yield from (f"the axes of {_names_of(c)} lie on one line" for c in coaxial)
        if len(coaxial) != 1 or len(coaxial[0]) < len(same):
            yield f"the axes of {_names_of(same)} are parallel"
    if len(axes) > 2 and len(classes) > 1 and _in_one_plane(g, axes):
        yield f"the axes of {_names_of(axes)} lie in one plane"
        return
    through = _through_one_point(g, [c[0] for c in classes])
    if through:
        yield f"the axes of {_names_of([a for a in axes if any(a is b for b in through)])} meet in one point"


def _in_one_plane(g: Geometry, axes: Sequence[NamedLine]) -> bool:
    """Return whether axes, not all of which are parallel, are in one plane."""
    first = axes[0]
    other = next(a for a in axes if not g.parallel(first.direction, a.direction))
    normal = cross(first.direction, other.direction)
    return all(g.zero(_dot(normal, a.direction), _dot(normal, _difference(a.through, first.through))) for a in axes)


def _through_one_point(g: Geometry, axes: Sequence[NamedLine]) -> list[NamedLine]:
    """Return the most ``axes`` in space, no two of them parallel, that meet in one point; [] for fewer than 3."""
    best: list[NamedLine] = []
    for a, b in combinations(axes, 2):
        if not g.meet(a, b):
            continue
        normal = cross(a.direction, b.direction)
        meeting = [c for c in axes if g.meet(a, c) and g.meet(b, c)]
        out = [c for c in meeting if not g.zero(_dot(normal, c.direction))]
        if len(out) + 2 > max(2, len(best)):
            best = [a, b, *out]
    return best


def _of_slides(g: Geometry, members: Sequence[Connection]) -> Iterator[str]:
    """Yield what is special about the directions of sliding joints: some are parallel, or all are in one plane."""
    slides = [
        NamedLine(g.names[c.constraint], (), g.unit(at.directions[0]))
        for c in members
        if c.facts.slides and (at := g.placement.located[c.constraint]).directions
    ]
    for same in _classes(slides, lambda a, b: g.parallel(a.direction, b.direction)):
        if len(same) > 1:
            yield f"{_names_of(same)} slide in parallel directions"
    if g.system.dimension == 3 and len(slides) > 2:
        triples = combinations([s.direction for s in slides[:MOST]], 3)
        if all(g.zero(_dot(a, cross(b, c))) for a, b, c in triples):
            yield f"{_names_of(slides)} slide parallel to one plane"


def _links(g: Geometry, members: Sequence[Connection]) -> Iterator[NamedLine]:
    """Yield the links between points, those of rigid sets, and in the plane the normals of contacts."""
    for c in members:
        at = g.placement.located[c.constraint]
        if c.facts.contact and g.system.dimension == 2:
            yield NamedLine(
                f"the normal of {g.names[c.constraint]}", at.points[0][1], g.unit(perpendicular(at.directions[0])[0])
            )
        if not c.facts.bars:
            continue
        for (k, p), (m, q) in combinations(enumerate(at.points), 2):
            ends = (_name_of_point(c, k), _name_of_point(c, m))
            name = "-".join(ends) if c.facts.complete else g.names[c.constraint]
            direction = _difference(q[1], p[1])
            if not g.zero(*direction):
                yield NamedLine(name, p[1], g.unit(direction), frozenset(ends))


def _bars(g: Geometry, connections: Sequence[Connection]) -> Iterator[NamedLine]:
    """Yield the lines through the two hinges of bodies in the plane."""
    hinges: dict[str, dict[str, tuple[Any, ...]]] = {}
    for c in connections:
        if g.system.dimension == 2 and c.facts.axial:
            at = g.placement.located[c.constraint].places[0]
            for m in c.members:
                hinges.setdefault(m, {})[_text(c.places[0])] = at
    for name, places in hinges.items():
        if name != GROUND and len(places) == 2:
            (end, p), (other, q) = places.items()
            yield NamedLine(name, p, g.unit(_difference(q, p)), frozenset((end, other)))


def _coincident_hinges(g: Geometry, connections: Sequence[Connection]) -> Iterator[str]:
    """Yield one sentence on the first two hinges in the plane that coincide at the reference and share no body."""
    hinges = [c for c in connections if c.facts.axial and g.system.dimension == 2]
    for a, b in combinations(hinges[:MOST], 2):
        place, other = (g.placement.located[c.constraint].places[0] for c in (a, b))
        if not set(a.members) & set(b.members) and g.zero(*_difference(place, other)):
            yield f"{g.names[a.constraint]} and {g.names[b.constraint]} coincide in the reference configuration"
            return


def _of_bars(g: Geometry, bars: Sequence[NamedLine], members: Sequence[Connection]) -> Iterator[str]:
    """Yield what is special about bars: parallel ones, and those through one point."""
    for same in _classes(bars, lambda a, b: g.parallel(a.direction, b.direction)):
        different = [c[0] for c in _classes(same, lambda a, b: g.on(a, b.through))]
        if len(different) > 2:
            yield f"{_names_of(same)} are parallel"
    if g.system.dimension == 2:
        for triple in combinations(bars[:MOST], 3):
            a, b, c = triple
            if a.ends & b.ends or b.ends & c.ends or a.ends & c.ends or g.parallel(a.direction, b.direction):
                continue
            if g.concurrent(a, b, c):
                yield f"the lines of {_names_of(triple)} meet in one point"
                break
    yield from _coincident_hinges(g, members)
    for a, b in combinations(bars, 2):
        if len(a.ends & b.ends) == 1 and g.parallel(a.direction, b.direction):
            points = sorted(a.ends | b.ends)
            yield f"the points {', '.join(points)} lie on one line"
            break


def _of_points(g: Geometry, members: Sequence[Connection]) -> Iterator[str]:
    """Yield a sentence if ends of links are on a line or plane in space, or a conic in the plane [BolkerRoth1980]."""
    points: dict[str, tuple[Any, ...]] = {}
    for c in members:
        at = g.placement.located[c.constraint]
        if c.facts.bars:
            points |= {_name_of_point(c, k): place for k, (_, place) in enumerate(at.points)}
    if len(points) > MOST:
        return
    first, *further = points.values() or [()]
    arms = [g.unit(_difference(q, first)) for q in further]
    if g.system.dimension == 3 and len(points) > 3:
        line = next((n for a, b in combinations(arms, 2) if not g.zero(*(n := cross(a, b)))), None)
        if line is None:
            yield f"the points {', '.join(points)} lie on one line"
        elif g.zero(*(_dot(line, a) for a in arms)):
            yield f"the points {', '.join(points)} lie in one plane"
    if g.system.dimension == 2 and len(points) > CONIC and g.placement.p:
        p = g.placement.p
        rows = [{i: v % p for i, v in enumerate((x * x, x * y, y * y, x, y, 1)) if v % p} for x, y in points.values()]
        if rank_of_rows(rows, p) <= CONIC:
            yield f"the points {', '.join(points)} lie on one conic"


def _name_of_point(c: Connection, k: int) -> str:
    point = c.points[k]
    return point.carrier if point.particle or point.at is None else _text(point.at)


def _text(place: Sequence[Any] | None) -> str:
    return "?" if place is None else f"({', '.join(to_text(part) for part in place)})"


def _classes(lines: Sequence[NamedLine], same: Callable[[NamedLine, NamedLine], bool]) -> list[list[NamedLine]]:
    """Return the lines in classes of an equivalence relation ``same``."""
    classes: list[list[NamedLine]] = []
    for line in lines:
        alike = next((c for c in classes if same(c[0], line)), None)
        if alike is None:
            classes.append([line])
        else:
            alike.append(line)
    return classes


def _names_of(lines: Sequence[NamedLine]) -> str:
    return series(list(dict.fromkeys(line.name for line in lines)))


def _difference(a: Numbers, b: Numbers) -> tuple[Any, ...]:
    return tuple(p - q for p, q in zip(a, b, strict=True))


def _dot(a: Numbers, b: Numbers) -> Any:
    return sum(p * q for p, q in zip(a, b, strict=True))


def _wedge(a: Numbers, b: Numbers) -> list[Any]:
    return [a[i] * b[j] - a[j] * b[i] for i, j in combinations(range(len(a)), 2)]


def _line(line: NamedLine) -> tuple[Any, ...]:
    """Return the coordinates (a, b, c) of the line a x + b y + c = 0 in the plane."""
    (x, y), (u, v) = line.through, line.direction
    return (v, -u, u * y - v * x)
