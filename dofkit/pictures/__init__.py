"""Pictures of scenes: still, moving, as graphs, and of the directions that forms allow.

They read a scene and its report. What needs matplotlib says so; pages play and turn by a small script of their own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.pictures.animation import Animation, animate
    from dofkit.pictures.still import Picture, draw, graph, phase, svg

__all__ = ["Animation", "Picture", "animate", "draw", "graph", "phase", "svg"]

_HOMES = {
    "Animation": "dofkit.pictures.animation",
    "Picture": "dofkit.pictures.still",
    "animate": "dofkit.pictures.animation",
    "draw": "dofkit.pictures.still",
    "graph": "dofkit.pictures.still",
    "phase": "dofkit.pictures.still",
    "svg": "dofkit.pictures.still",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)


def __dir__() -> list[str]:
    return sorted(__all__)
