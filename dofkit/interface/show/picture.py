"""The picture of a scene within what a notebook shows, where pictures are installed."""

from __future__ import annotations

from importlib.util import find_spec

from dofkit.base.deadline import limited
from dofkit.base.errors import DofkitError
from dofkit.base.surface import handed_on

#: The room that draws, and its function from a scene and its report to an inline SVG.
_ROOM, _FUNCTION = "dofkit.pictures", "svg"
#: Seconds for a picture; without a report the scene is classified for it.
DRAWING = 5.0


def picture_of(scene: object, report: object = None) -> str | None:
    """An inline SVG of a scene; None without pictures, or where it cannot be drawn in time."""
    if find_spec(_ROOM) is None:
        return None
    try:
        with limited(DRAWING):
            drawn = handed_on(__name__, {_FUNCTION: _ROOM}, _FUNCTION)(scene, report)
    except (ImportError, AttributeError, DofkitError):
        return None
    return drawn if isinstance(drawn, str) else None
