"""The picture of a scene within what a notebook shows, where pictures are installed."""

from __future__ import annotations

from typing import Any

from dofkit.base.deadline import limited
from dofkit.base.errors import DofkitError
from dofkit.report import Report

#: Seconds for a picture; without a report the scene is classified for it.
DRAWING = 5.0


def picture_of(scene: Any, report: Report | None = None) -> str | None:
    """An inline SVG of a scene; None without pictures, or where it cannot be drawn in time."""
    try:
        from dofkit.pictures.still import svg  # most values are shown without a picture

        with limited(DRAWING):
            return svg(scene, report)
    except (ImportError, DofkitError):
        return None
