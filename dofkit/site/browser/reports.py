"""The report on a scene that is being typed: its faults, its names, and the effect of leaving out constraints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from dofkit.interface.show.decimals import as_the_scene
from dofkit.interface.show.report import changed, sheet_of_report
from dofkit.methods.classify import classify
from dofkit.scene.names import coordinate_table
from dofkit.scene.reading import loads
from dofkit.scene.scene import without
from dofkit.site.browser.shown import json_of_sheet


def check(text: str) -> dict[str, Any]:
    """Return the names that a scene declares, for completion. Raises SceneError if the text has faults."""
    scene = loads(text)
    names = [c.name for c in coordinate_table(scene).coordinates]
    names += [f"d{name}" for name in names]
    names += [*scene.parameters, *scene.functions, *(p.name for p in scene.particles), *(b.name for b in scene.bodies)]
    return {"faults": [], "names": names}


def report(text: str, left_out: Sequence[str]) -> dict[str, Any]:
    """Return the report on a scene without the constraints ``left_out``, and what changes by leaving them out."""
    whole = loads(text)
    names = [constraint.name or f"c{i}" for i, constraint in enumerate(whole.constraints, 1)]
    dropped = [name for name in left_out if name in names]
    scene = without(whole, dropped) if dropped else whole
    classified = classify(scene)
    sections = [changed(classify(whole), classified, dropped)] if dropped else []
    sheet = sheet_of_report(as_the_scene(classified, scene), whole.title)
    return {
        "faults": [],
        "sheet": json_of_sheet(sheet._replace(sections=(*sections, *sheet.sections))),
        "constraints": names,
        "report": classified.model_dump(mode="json"),
    }


def as_json(text: str) -> dict[str, Any]:
    """Return a scene as a mapping, without fields of default value."""
    return {"scene": loads(text).model_dump(mode="json", exclude_defaults=True, exclude_none=True)}
