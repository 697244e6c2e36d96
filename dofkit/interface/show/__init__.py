"""Rendering of what was found: each for a person at a terminal, imported when it is first asked for."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

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
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
