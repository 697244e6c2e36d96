"""The picture of a scene for who is to find the answer: what it is made of, and nothing that the report says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from dofkit.base.wording import many
from dofkit.pictures.coordinates import is_bare
from dofkit.pictures.mechanism import FREE_PLACES, sketch_of
from dofkit.pictures.stage import StagedScene
from dofkit.pictures.still import Picture, staged
from dofkit.report import Report
from dofkit.scene.scene import Scene


def unanswered(scene: Scene, report: Report, title: str) -> Picture | None:
    """The picture for a sheet of problems; None for a scene of coordinates alone, which has no places.

    Raises nothing but what `dofkit.draw` does. Equations are not told, nor what moves, follows or contradicts.
    """
    if not (scene.particles or scene.bodies):
        return None
    stage = staged(scene, report)
    if is_bare(stage.system):
        return None
    sketch = sketch_of(stage)
    told = f"{title}: {', '.join(_parts(scene))}."
    shapes = tuple(s._replace(state="moving" if s.role in ("body", "point") else "plain") for s in sketch.shapes)
    bare = replace(sketch, title="", answer="", alternative=told, shapes=shapes, meanings=None)
    return Picture(replace(bare, notes=tuple(_notes(stage))))


def _parts(scene: Scene) -> Iterator[str]:
    if scene.bodies:
        yield many(len(scene.bodies), "body")
    if scene.particles:
        yield many(len(scene.particles), "particle")
    yield many(len(scene.constraints), "constraint")


def _notes(stage: StagedScene) -> Iterator[str]:
    if stage.schematic:
        yield FREE_PLACES
