"""Lagrange's equations of a scene: energies, elimination, multipliers, conserved quantities, small motions."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dofkit.motion.lagrange.equations import lagrange

__all__ = ["lagrange"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "lagrange": "dofkit.motion.lagrange.equations",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module(_HOMES[name]), name)
