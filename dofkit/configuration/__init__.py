"""The set {g = 0}: is it empty, its generic points, its dimension, and what can move at the drawing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.configuration.drawing.at_reference import at_reference
    from dofkit.configuration.finite_blocks import finite_answer
    from dofkit.configuration.search import find
    from dofkit.configuration.states import States
    from dofkit.configuration.variety import Variety

__all__ = ["States", "Variety", "at_reference", "find", "finite_answer"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "States": "dofkit.configuration.states",
    "Variety": "dofkit.configuration.variety",
    "at_reference": "dofkit.configuration.drawing.at_reference",
    "find": "dofkit.configuration.search",
    "finite_answer": "dofkit.configuration.finite_blocks",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
