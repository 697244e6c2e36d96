"""The equations of motion of a scene, which need SymPy."""

from __future__ import annotations

from typing import Any

from dofkit.interface.show.decimals import as_the_scene
from dofkit.interface.show.motion import sheet_of_motion
from dofkit.motion.lagrange.equations import lagrange
from dofkit.scene.reading import loads
from dofkit.site.browser.shown import json_of_sheet


def equations(text: str) -> dict[str, Any]:
    """Return the equations of motion of a scene as a printed sheet."""
    scene = loads(text)
    return {"sheet": json_of_sheet(sheet_of_motion(as_the_scene(lagrange(scene), scene), scene.title))}
