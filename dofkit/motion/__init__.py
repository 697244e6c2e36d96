"""A classified system in time: Lagrange's equations, and configurations along a motion.

The room of Lagrange's equations bears the name of its function, so ``lagrange`` is handed on by that room, not here.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dofkit.motion.sampled.configurations import configurations

__all__ = ["configurations"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "configurations": "dofkit.motion.sampled.configurations",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module(_HOMES[name]), name)
