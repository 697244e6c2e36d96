"""A classified system in time: Lagrange's equations, and configurations along a motion.

The room of Lagrange's equations bears the name of its function, so ``lagrange`` is handed on by that room, not here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.motion.sampled.configurations import configurations

__all__ = ["configurations"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "configurations": "dofkit.motion.sampled.configurations",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
