"""What a drawing fixes: its size, the reference configuration, and the pose in which its joints close."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from fractions import Fraction
from itertools import combinations, product
from math import dist
from operator import mul

from dofkit.expressions.enclosures import approximate
from dofkit.expressions.tree import ZERO, Expr, coordinate, num
from dofkit.expressions.vectors import Vec
from dofkit.scene.drawing import Drawing
from dofkit.system import GROUND

#: Up to this many points every pair is measured.
EVERY_PAIR = 1000


def size_of(points: Sequence[Vec]) -> float:
    """The largest distance between points whose positions are numbers; 1 if there are none."""
    found = {numbers for numbers in map(_numbers, points) if numbers is not None}
    return _diameter(sorted(found)) or 1.0


def centre_of(points: Sequence[Vec]) -> Vec | None:
    """Return the middle of the points whose positions are numbers, rounded to binary; None if there are none."""
    found = [numbers for numbers in map(_numbers, points) if numbers is not None]
    return tuple(num(Fraction((min(xs) + max(xs)) / 2)) for xs in zip(*found, strict=True)) or None


def _numbers(point: Vec) -> tuple[float, ...] | None:
    parts = [approximate(part) for part in point]
    return tuple(part for part in parts if part is not None) if None not in parts else None


def _diameter(points: list[tuple[float, ...]]) -> float:
    """Among many points, only the pairs that a first estimate leaves open: |p - q| <= |p - c| + |q - c|.

    If those are still too many, as on a sphere, the estimate: the extremes of a few dozen directions.
    """
    best = 0.0
    if len(points) > EVERY_PAIR:
        best = _diameter(_extremes(points))
        centre = tuple((min(column) + max(column)) / 2 for column in zip(*points, strict=True))
        reach = [dist(point, centre) for point in points]
        furthest = max(reach)
        points = [p for p, far in zip(points, reach, strict=True) if far + furthest > best * (1 + 1e-9)]
        if len(points) > EVERY_PAIR:
            return best
    return max(best, max((dist(p, q) for p, q in combinations(points, 2)), default=0.0))


def _extremes(points: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    """The points that reach furthest in some direction: of a direction and its opposite, the last and the first."""
    found = set()
    for way in product((-1, 0, 1), repeat=len(points[0])):
        if way > (0,) * len(way):
            reach = [sum(map(mul, point, way)) for point in points]
            found |= {points[reach.index(max(reach))], points[reach.index(min(reach))]}
    return list(found)


def drawn_bodies(placed: Iterable[str], welds: Iterable[tuple[str, str]]) -> frozenset[str]:
    """The bodies that the drawing places: those ``placed``, and those welded to the ground or to one that is placed."""
    drawn = set(placed) - {GROUND}
    welded: dict[str, list[str]] = {}
    for first, second in welds:
        if GROUND in (first, second):
            drawn |= {first, second} - {GROUND}
        else:
            welded.setdefault(first, []).append(second)
            welded.setdefault(second, []).append(first)
    stack = list(drawn)
    while stack:
        for other in welded.get(stack.pop(), ()):
            if other not in drawn:
                drawn.add(other)
                stack.append(other)
    return frozenset(drawn)


def pose_of(drawing: Drawing) -> dict[Expr, Expr]:
    """Values at which the joints close: bodies at their reference, particles and coordinates where given."""
    found: dict[Expr, Expr] = {}
    for particle in drawing.particles.values():
        if particle.reference is not None:
            found.update(zip(particle.over, particle.reference, strict=True))
    for frame in drawing.frames.values():
        found.update(zip(frame.position, frame.start, strict=True))
        turned = frame.initial if frame.chart != "gibbs" else (ZERO,) * len(frame.angles)
        found.update(zip(map(coordinate, frame.angles), turned, strict=True))
    for name, value in drawing.configuration.items():
        found.setdefault(coordinate(name), value)
    return found


def reference_of(
    drawing: Drawing, drawn: Set[str], pose: Mapping[Expr, Expr], touched: Callable[[], Set[str]]
) -> dict[Expr, Expr] | None:
    """The pose, where it is one of every coordinate that a constraint has ``touched``; of all where none has any.

    Its bodies are ``drawn``, and nothing is left to guess. What nothing constrains may stand anywhere; what is
    touched is asked for only where something is not drawn.
    """
    names = [q.name for q in drawing.vocabulary.table.coordinates]
    every = frozenset(names)
    if undrawn(drawing, drawn, pose, every) and undrawn(drawing, drawn, pose, touched() or every):
        return None
    return {s: pose.get(s, ZERO) for s in map(coordinate, names)}


def undrawn(drawing: Drawing, drawn: Set[str], pose: Mapping[Expr, Expr], touched: Set[str]) -> tuple[str, ...]:
    """The bodies, particles and coordinates that a constraint has ``touched`` and that are not drawn."""
    table, known = drawing.vocabulary.table, frozenset(str(s.args[1]) for s in pose)
    found = [b for b, names in table.bodies.items() if b not in drawn and not touched.isdisjoint(names)]
    bare = (q for q in table.coordinates if q.name in touched and q.name not in known)
    return tuple(dict.fromkeys([*found, *(q.owner or q.name for q in bare)]))
