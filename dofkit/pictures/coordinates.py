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
from dofkit.system import System

#: The number of coordinates that can be the axes of a picture.
COUNTS = (2, 3)
AXES = "The axes are the coordinates."


def has_set(system: System) -> bool:
    """Return whether the constraints of coordinates alone describe a set that can be seen: curves, surfaces, lines."""
    described = len(system.coordinates) == 2 and bool(system.constraints)
    return len(system.coordinates) in COUNTS and (described or bool(finite_relations(system)))


def coordinate_sketch(stage: StagedScene) -> Sketch:
    """Return the set that the constraints describe, with two or three coordinates as axes."""
    symbols = [coordinate(c.name) for c in stage.system.coordinates]
    values = [stage.arrangement.numbers.get(s, 0.0) for s in symbols]
    half = _half(stage, symbols, max(1.5, 1.4 * max(map(abs, values))))
    shapes = [*_axes(symbols, half), *_sets(stage, symbols, half)]
    state: State = "moving" if stage.motions else "plain"
    shapes.append(Shape("ball", (Vertex(POINT, (0.0, 0.0, 0.0)),), "point", state, POINT, 0.035 * half))
    return Sketch(
        title=stage.title,
        dimension=len(symbols),
        shapes=tuple(shapes),
        poses=stage.arrangement.poses,
        size=2 * half,
        answer=answer(stage.report),
        alternative=f"{alternative(stage.scene, stage.report)} {AXES}",
        notes=tuple(notes_of(stage)),
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
    if len(symbols) == 3 and len(equal) > 1:
        yield Shape("line", fixed(*curve(stage.arrangement, equal, symbols, half)), "locus")
    for name, relation in relations:
        if relation.expr not in finite:
            continue
        role: Role = "surface" if relation.sense != "=" or len(symbols) == 3 else "locus"
        for line in lines_of(stage.arrangement, relation.expr, symbols, half):
            yield Shape("line", fixed(*line), role, stage.state(name), name)
    if any(r.expr not in finite for _, r in relations) and len(symbols) == 2 and is_linear(stage.arrangement):
        yield from elements(Distribution(stage.arrangement), 0.9 * half)
