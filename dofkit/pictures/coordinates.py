"""Scenes without bodies and particles: the set of their coordinates, up to three; what moves is the configuration."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from dofkit.expressions.tree import Expr, coordinate
from dofkit.pictures.alternative import alternative, answer
from dofkit.pictures.arrangement import POINT, finite_relations
from dofkit.pictures.fields import Distribution, elements
from dofkit.pictures.loci import curve, lines_of_plane, lines_of_space
from dofkit.pictures.mechanism import notes_of
from dofkit.pictures.rates import is_linear
from dofkit.pictures.shapes import Array, Role, Shape, Sketch, State, Vertex, place
from dofkit.pictures.stage import StagedScene
from dofkit.system import GROUND, System

#: Up to so many coordinates are axes of a picture.
MOST = 3
#: So many lines of single coordinates fit on a sheet.
MOST_GAUGES = 24
GAUGES = "Each coordinate is on a line of its own, with marks at -1, 0 and 1."


def is_bare(system: System) -> bool:
    """Is there nothing but coordinates?"""
    return not system.bodies and not system.particles


def coordinate_sketch(stage: StagedScene) -> Sketch:
    """The set that the constraints describe, over one to three coordinates as axes."""
    system = stage.system
    symbols = [coordinate(c.name) for c in system.coordinates]
    values = [stage.arrangement.numbers.get(s, 0.0) for s in symbols]
    half = _half(stage, symbols, max(1.5, 1.4 * max(map(abs, values))))
    shapes = [*_axes(stage, symbols, half), *_sets(stage, symbols, half)]
    state: State = "moving" if stage.motions else "plain"
    point = (Vertex(POINT, (0.0, 0.0, 0.0)),)
    shapes.append(Shape("ball", point, "point", state, "configuration", 0.035 * half))
    return Sketch(
        title=stage.scene.title or stage.scene.name,
        dimension=3 if len(symbols) == MOST else 2,
        shapes=tuple(shapes),
        poses=stage.arrangement.poses,
        size=2 * half,
        answer=answer(stage.report),
        alternative=f"{alternative(stage.scene, stage.report)} The axes are the coordinates.",
        notes=tuple(notes_of(stage)),
        meanings=stage.meanings,
        axes=(),
    )


def _half(stage: StagedScene, symbols: Sequence[Expr], half: float) -> float:
    """Half of the box that is shown: larger where a curve of the plane would be left out."""
    if len(symbols) != 2:
        return half
    equal = [e for e in finite_relations(stage.system) if e.symbols & set(symbols)]
    for wider in (half, 2.5 * half, 6.0 * half):
        bounds = np.array([[-wider, wider]] * MOST)
        if all(any(True for _ in lines_of_plane(stage.arrangement, e, symbols, bounds)) for e in equal):
            return wider
    return half


def gauge_sketch(stage: StagedScene) -> Sketch:
    """Each coordinate on a line of its own: for motions of more coordinates than a picture has axes."""
    shapes: list[Shape] = []
    values = [pose.shift[0] for name, pose in stage.arrangement.poses.items() if name != GROUND]
    half = max(1.5, 1.4 * max((abs(float(v)) for v in values), default=0.0))
    apart = min(0.35 * half, 2.0 * half / max(1, len(stage.system.coordinates)))
    moved = {str(s.args[1]) for m in stage.motions for s, rate in m.rates.items() if abs(rate) > 1e-9}
    for k, c in enumerate(stage.system.coordinates[:MOST_GAUGES]):
        height = -apart * k
        ends = (Vertex(GROUND, (-half, height, 0.0)), Vertex(GROUND, (half, height, 0.0)))
        ticks = ((x, height - 0.06 * apart, height + 0.06 * apart) for x in (-1.0, 0.0, 1.0))
        shapes.append(Shape("line", ends, "axis"))
        shapes += [
            Shape("line", (Vertex(GROUND, (x, a, 0.0)), Vertex(GROUND, (x, b, 0.0))), "axis") for x, a, b in ticks
        ]
        dot = (Vertex(c.name, (0.0, height, 0.0)),)
        shapes.append(Shape("ball", dot, "point", "moving" if c.name in moved else "plain", c.name, 0.12 * apart))
        shapes.append(Shape("words", (ends[0],), "name", text=c.name))
    return Sketch(
        title=stage.scene.title or stage.scene.name,
        dimension=2,
        shapes=tuple(shapes),
        poses=stage.arrangement.poses,
        size=2 * half,
        answer=answer(stage.report),
        alternative=f"{alternative(stage.scene, stage.report)} {GAUGES}",
        notes=(GAUGES, *notes_of(stage)),
        meanings=stage.meanings,
        axes=(),
    )


def _axes(stage: StagedScene, symbols: Sequence[Expr], half: float) -> Iterator[Shape]:
    """A line for each coordinate, with its name and a mark at 1."""
    del stage
    for symbol, way in zip(symbols, np.eye(3), strict=False):
        ends = (-half * way, half * way)
        yield Shape("line", tuple(Vertex(GROUND, place(p)) for p in ends), "axis")
        yield Shape("words", (Vertex(GROUND, place(1.06 * half * way)),), "name", text=str(symbol.args[1]))
        side = 0.03 * half * np.roll(way, 1 if way[1] == 0 else -1)
        for tick in range(-int(half), int(half) + 1):
            if tick and half < 12:
                spots = (tick * way - side, tick * way + side)
                yield Shape("line", tuple(Vertex(GROUND, place(p)) for p in spots), "axis")
        yield Shape("words", (Vertex(GROUND, place(way - 2.6 * side)),), "name", text="1")


def _sets(stage: StagedScene, symbols: Sequence[Expr], half: float) -> Iterator[Shape]:
    """Curves and surfaces of finite relations; and the field of what differential ones allow."""
    relations = [(c.name, r) for c in stage.system.constraints for r in c.relations]
    finite = set(finite_relations(stage.system, ("=", ">=", ">")))
    equal = [r.expr for _, r in relations if r.sense == "=" and r.expr in finite]
    bounds = np.array([[-half, half]] * 3)
    lines = lines_of_plane if len(symbols) == 2 else lines_of_space
    if len(symbols) == MOST and len(equal) > 1:
        meeting = curve(stage.arrangement, equal, symbols, half)
        yield Shape("line", _grounded(meeting), "locus")
    for name, relation in relations:
        if relation.expr not in finite or len(symbols) == 1:
            continue
        thin = relation.sense != "=" or len(symbols) == MOST
        role: Role = "surface" if thin else "locus"
        for line in lines(stage.arrangement, relation.expr, symbols, bounds):
            yield Shape("line", _grounded(line), role, stage.state(name), name)
    if any(r.expr not in finite for _, r in relations) and len(symbols) > 1 and is_linear(stage.arrangement):
        distribution = Distribution(stage.arrangement)
        yield from elements(distribution, range(len(symbols)), 0.9 * half)


def _grounded(line: Iterable[Array]) -> tuple[Vertex, ...]:
    return tuple(Vertex(GROUND, place(p)) for p in line)
