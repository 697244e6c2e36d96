"""Assignments, answers, judgements, results, and the platforms that take them."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dofkit.homework.assignment import load_assignment
    from dofkit.homework.grading import grade

__all__ = ["grade", "load_assignment"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "grade": "dofkit.homework.grading",
    "load_assignment": "dofkit.homework.assignment",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module(_HOMES[name]), name)
