"""SolveSpace's sketches as scenes: in a plane where one plane holds everything, else in space.

Names are those that SolveSpace shows: r004 for what was drawn fourth, c001 for the first constraint. All groups hold
at once: SolveSpace solves each after those before it, which stay where they are then.
"""

from __future__ import annotations

from collections import Counter

from dofkit.base.errors import Fault, SceneError
from dofkit.models.model_document import ModelDocument, ModelFile, SceneDraft
from dofkit.models.plane_sketch import PlaneSketch
from dofkit.models.sketch_file import SketchFile, read_sketch
from dofkit.models.sketch_scene import SketchScene
from dofkit.models.sketch_types import POINT_2D, is_own
from dofkit.models.spatial_sketch import SpatialSketch
from dofkit.system import BINDING


def read(file: ModelFile) -> ModelDocument:
    """The scene of a sketch. Raises SceneError for what is no such file."""
    found = read_sketch(file)
    planes = _planes(found)
    title = f"SolveSpace sketch {file.name}"
    scenes: list[SketchScene] = []
    if planes:
        scenes.append(PlaneSketch(found, SceneDraft(title, dimension=2), planes.most_common(1)[0][0]))
    scenes.append(SpatialSketch(found, SceneDraft(title)))
    best: tuple[ModelDocument, tuple[int, int]] | None = None
    for scene in scenes:
        document = scene.document()
        lost = (scene.missed, sum(told.startswith(BINDING) for told in scene.draft.left_out))
        if best is None or lost < best[1] or (scene.missed and lost == best[1]):
            best = document, lost
        if not any(lost):
            break
    if best is None or "particles" not in best[0].value:
        hint = "draw something: points, lines, circles"
        raise SceneError((Fault("this file has no point that dofkit reads", line=1, column=1, hint=hint),), file.name)
    return best[0]


def _planes(file: SketchFile) -> Counter[int]:
    """The workplanes in which points were drawn, and how many."""
    drawn = [e for h, e in file.entities.items() if is_own(h) and e.whole("type") == POINT_2D]
    return Counter(plane for e in drawn if (plane := e.handle("workplane.v")) in file.entities)
