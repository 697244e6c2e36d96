"""The report on a scene as one types: its faults, what it declares, and what changes where constraints are left out."""

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
    """Return the names that a scene declares, for completion; a text with faults raises them, so there are none."""
    scene = loads(text)
    names = [c.name for c in coordinate_table(scene).coordinates]
    names += [f"d{name}" for name in names]
    names += [*scene.parameters, *scene.functions, *(p.name for p in scene.particles), *(b.name for b in scene.bodies)]
    return {"faults": [], "names": names}


def report(text: str, left_out: Sequence[str]) -> dict[str, Any]:
    """Return the report on a scene without the constraints that are left out, and what that changes."""
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
    """Return a scene as a mapping, without what is at its default."""
    return {"scene": loads(text).model_dump(mode="json", exclude_defaults=True, exclude_none=True)}
