"""Scenes of two or three coordinates: axes, and the directions that their constraints allow in the plane."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dofkit.pictures.arrangement import finite_relations, is_linear
from dofkit.pictures.directions import Distribution, elements
from dofkit.pictures.loci import half_of
from dofkit.pictures.mechanism import sketch_of
from dofkit.pictures.shapes import Shape, Sketch, fixed
from dofkit.pictures.stage import StagedScene

AXES = "The axes are the coordinates."


def coordinate_sketch(stage: StagedScene) -> Sketch:
    """Return the sketch of a particle whose position are the coordinates, with the axes."""
    sketch = sketch_of(stage)
    shapes = (*_axes(stage), *_field(stage), *sketch.shapes)
    return replace(sketch, shapes=shapes, axes=(), alternative=f"{sketch.alternative} {AXES}")


def _axes(stage: StagedScene) -> Iterator[Shape]:
    """Yield a line for each coordinate, with its name and marks at the whole numbers."""
    half = half_of(stage)
    for coordinate, direction in zip(stage.system.coordinates, np.eye(3), strict=False):
        yield Shape("line", fixed(-half * direction, half * direction), "axis")
        yield Shape("words", fixed(1.06 * half * direction), "name", text=coordinate.name)
        side = 0.03 * half * np.roll(direction, 1 if direction[1] == 0 else -1)
        for tick in range(-int(half), int(half) + 1):
            if tick and half < 12:
                yield Shape("line", fixed(tick * direction - side, tick * direction + side), "axis")
        yield Shape("words", fixed(direction - 2.6 * side), "name", text="1")


def _field(stage: StagedScene) -> Iterator[Shape]:
    """Yield the directions that constraints of velocities allow, over the plane of two coordinates."""
    system = stage.system
    finite = finite_relations(system, ("=", ">=", ">"))
    written = [r.expr for c in system.constraints for r in c.relations]
    if system.dimension == 2 and len(written) > len(finite) and is_linear(system):
        yield from elements(Distribution(stage.arrangement), 0.9 * half_of(stage))
