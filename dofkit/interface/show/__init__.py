"""Rendering of what was found: each for a person at a terminal, imported when it is first asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import lazy_loader as lazy

if TYPE_CHECKING:
    from dofkit.interface.show.brief import brief_line
    from dofkit.interface.show.faults import complaint
    from dofkit.interface.show.motion import sheet_of_motion
    from dofkit.interface.show.report import sheet_of_report
    from dofkit.interface.show.terminal import Screen, as_text

__all__ = ["Screen", "as_text", "brief_line", "complaint", "sheet_of_motion", "sheet_of_report"]

__getattr__, __dir__, _ = lazy.attach(
    __name__,
    submod_attrs={
        "brief": ["brief_line"],
        "faults": ["complaint"],
        "motion": ["sheet_of_motion"],
        "report": ["sheet_of_report"],
        "terminal": ["Screen", "as_text"],
    },
)
