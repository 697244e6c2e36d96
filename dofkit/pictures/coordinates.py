"""Scenes of coordinates only: the set of up to three coordinates, in which the configuration is a moving point."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from dofkit.expressions.tree import Expr, coordinate
from dofkit.pictures.arrangement import POINT, finite_relations, is_linear
from dofkit.pictures.directions import Distribution, elements
from dofkit.pictures.loci import curve, lines_of
from dofkit.pictures.mechanism import notes_of
from dofkit.pictures.shapes import Role, Shape, Sketch, State, Vertex, fixed
from dofkit.pictures.stage import StagedScene
from dofkit.pictures.words import alternative, answer
from dofkit.system import GROUND

#: Up to this many coordinates are axes of a picture; so many lines of single coordinates fit on a sheet.
MOST, MOST_GAUGES = 3, 24
AXES = "The axes are the coordinates."
GAUGES = "Each coordinate is on a line of its own, with marks at -1, 0 and 1."


def coordinate_sketch(stage: StagedScene) -> Sketch:
    """Return the set that the constraints describe, with one to three coordinates as axes."""
    symbols = [coordinate(c.name) for c in stage.system.coordinates]
    values = [stage.arrangement.numbers.get(s, 0.0) for s in symbols]
    half = _half(stage, symbols, max(1.5, 1.4 * max(map(abs, values))))
    shapes = [*_axes(symbols, half), *_sets(stage, symbols, half)]
    state: State = "moving" if stage.motions else "plain"
    shapes.append(Shape("ball", (Vertex(POINT, (0.0, 0.0, 0.0)),), "point", state, POINT, 0.035 * half))
    return _sketch(stage, shapes, half, AXES, 3 if len(symbols) == MOST else 2)


def _sketch(stage: StagedScene, shapes: Sequence[Shape], half: float, about: str, dimension: int) -> Sketch:
    return Sketch(
        title=stage.title,
        dimension=dimension,
        shapes=tuple(shapes),
        poses=stage.arrangement.poses,
        size=2 * half,
        answer=answer(stage.report),
        alternative=f"{alternative(stage.scene, stage.report)} {about}",
        notes=((about,) if about is GAUGES else ()) + tuple(notes_of(stage)),
        meanings=stage.meanings,
        axes=(),
    )


def _half(stage: StagedScene, symbols: Sequence[Expr], half: float) -> float:
    """Return half of the box that is shown, larger if a curve of the plane would not be seen."""
    if len(symbols) != 2:
        return half
    equal = [e for e in finite_relations(stage.system) if e.symbols & set(symbols)]
    for wider in (half, 2.5 * half, 6.0 * half):
        if all(any(True for _ in lines_of(stage.arrangement, e, symbols, wider)) for e in equal):
            return wider
    return half


def gauge_sketch(stage: StagedScene) -> Sketch:
    """Return each coordinate on a line of its own, for motions of more coordinates than a picture has axes."""
    values = [pose.shift[0] for name, pose in stage.arrangement.poses.items() if name != GROUND]
    half = max(1.5, 1.4 * max((abs(float(v)) for v in values), default=0.0))
    apart = min(0.35 * half, 2.0 * half / max(1, len(stage.system.coordinates)))
    moving = {str(s.args[1]) for m in stage.motions for s, rate in m.rates.items() if abs(rate) > 1e-9}
    shapes: list[Shape] = []
    for k, c in enumerate(stage.system.coordinates[:MOST_GAUGES]):
        height, tick = -apart * k, 0.06 * apart
        ends = fixed((-half, height), (half, height))
        shapes.append(Shape("line", ends, "axis"))
        shapes += [Shape("line", fixed((x, height - tick), (x, height + tick)), "axis") for x in (-1.0, 0.0, 1.0)]
        dot = (Vertex(c.name, (0.0, height, 0.0)),)
        shapes.append(Shape("ball", dot, "point", "moving" if c.name in moving else "plain", c.name, 0.12 * apart))
        shapes.append(Shape("words", (ends[0],), "name", text=c.name))
    return _sketch(stage, shapes, half, GAUGES, 2)


def _axes(symbols: Sequence[Expr], half: float) -> Iterator[Shape]:
    """Yield a line for each coordinate, with its name and marks at the whole numbers."""
    for symbol, way in zip(symbols, np.eye(3), strict=False):
        yield Shape("line", fixed(-half * way, half * way), "axis")
        yield Shape("words", fixed(1.06 * half * way), "name", text=str(symbol.args[1]))
        side = 0.03 * half * np.roll(way, 1 if way[1] == 0 else -1)
        for tick in range(-int(half), int(half) + 1):
            if tick and half < 12:
                yield Shape("line", fixed(tick * way - side, tick * way + side), "axis")
        yield Shape("words", fixed(way - 2.6 * side), "name", text="1")


def _sets(stage: StagedScene, symbols: Sequence[Expr], half: float) -> Iterator[Shape]:
    """Yield curves and surfaces of the equations, and the field of the directions that the others allow."""
    relations = [(c.name, r) for c in stage.system.constraints for r in c.relations]
    finite = set(finite_relations(stage.system, ("=", ">=", ">")))
    equal = [r.expr for _, r in relations if r.sense == "=" and r.expr in finite]
    if len(symbols) == MOST and len(equal) > 1:
        yield Shape("line", fixed(*curve(stage.arrangement, equal, symbols, half)), "locus")
    for name, relation in relations:
        if relation.expr not in finite or len(symbols) == 1:
            continue
        role: Role = "surface" if relation.sense != "=" or len(symbols) == MOST else "locus"
        for line in lines_of(stage.arrangement, relation.expr, symbols, half):
            yield Shape("line", fixed(*line), role, stage.state(name), name)
    if any(r.expr not in finite for _, r in relations) and len(symbols) > 1 and is_linear(stage.arrangement):
        yield from elements(Distribution(stage.arrangement), range(len(symbols)), 0.9 * half)
