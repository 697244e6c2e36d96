"""Lagrange's equations of a scene: energies, elimination, multipliers, conserved quantities, small motions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.motion.lagrange.equations import lagrange

__all__ = ["lagrange"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "lagrange": "dofkit.motion.lagrange.equations",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
