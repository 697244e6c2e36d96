"""Rendering of what was found: each for a person at a terminal, imported when it is first asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.interface.show.brief import brief_line
    from dofkit.interface.show.faults import complaint
    from dofkit.interface.show.motion import sheet_of_motion
    from dofkit.interface.show.report import sheet_of_report
    from dofkit.interface.show.terminal import Screen, as_text

__all__ = ["Screen", "as_text", "brief_line", "complaint", "sheet_of_motion", "sheet_of_report"]

_HOMES = {
    "Screen": "dofkit.interface.show.terminal",
    "as_text": "dofkit.interface.show.terminal",
    "brief_line": "dofkit.interface.show.brief",
    "complaint": "dofkit.interface.show.faults",
    "sheet_of_motion": "dofkit.interface.show.motion",
    "sheet_of_report": "dofkit.interface.show.report",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
