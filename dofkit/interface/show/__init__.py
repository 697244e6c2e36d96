"""Rendering of what was found: each for a person at a terminal, imported when it is first asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.interface.show.faults import complaint
    from dofkit.interface.show.motion import as_lines
    from dofkit.interface.show.terminal import as_text

__all__ = ["as_lines", "as_text", "complaint"]

_HOMES = {
    "as_lines": "dofkit.interface.show.motion",
    "as_text": "dofkit.interface.show.terminal",
    "complaint": "dofkit.interface.show.faults",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
