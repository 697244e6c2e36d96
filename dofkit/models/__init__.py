"""Models of others, each made into a scene as a person would write it: MJCF, URDF, SolveSpace sketches.

A reader takes a file's bytes and gives a `ModelDocument`: a scene's mapping, where in the file each part of it is from,
and what was not read. Nothing here knows what a scene means; `scene/` reads the mapping like any other.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.models.formats import format_of, read_model
    from dofkit.models.model_document import ModelDocument, ModelFile

__all__ = ["ModelDocument", "ModelFile", "format_of", "read_model"]

#: What is handed on, imported when it is first asked for.
_HOMES = {
    "ModelDocument": "dofkit.models.model_document",
    "ModelFile": "dofkit.models.model_document",
    "format_of": "dofkit.models.formats",
    "read_model": "dofkit.models.formats",
}


def __getattr__(name: str) -> Any:
    found = globals()[name] = handed_on(__name__, _HOMES, name)
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
