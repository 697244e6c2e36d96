"""The picture of a scene within what a notebook shows, where pictures are installed."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

#: The room that draws, and its function from a scene to an inline SVG.
_ROOM, _FUNCTION = "dofkit.pictures", "inline_svg"


def picture_of(scene: object) -> str | None:
    """An inline SVG of a scene; None without a scene, without pictures, or where it cannot be drawn."""
    if scene is None or find_spec(_ROOM) is None:
        return None
    try:
        inline = getattr(import_module(_ROOM), _FUNCTION, None)
    except ImportError:
        return None
    drawn = None if inline is None else inline(scene)
    return drawn if isinstance(drawn, str) else None
