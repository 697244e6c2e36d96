"""Assignments, answers, judgements, results, and the platforms that take them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

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
    return handed_on(__name__, _HOMES, name)
