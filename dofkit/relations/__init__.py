"""What each relation says over the reals, in blocks that share no coordinate, ready for the engines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.relations.answer import Answer
    from dofkit.relations.blocks import Block, Row, split
    from dofkit.relations.chart import Chart
    from dofkit.relations.normal.normal_form import normalise
    from dofkit.relations.normal.pieces import Finite, Nonlinear, Normal, Pfaffian
    from dofkit.relations.reductions import REDUCTIONS
    from dofkit.relations.setting import Setting

__all__ = [
    "REDUCTIONS",
    "Answer",
    "Block",
    "Chart",
    "Finite",
    "Nonlinear",
    "Normal",
    "Pfaffian",
    "Row",
    "Setting",
    "normalise",
    "split",
]

#: Where the names live: a module is imported when a name of it is first asked for.
_HOMES = {
    "Answer": "dofkit.relations.answer",
    "Block": "dofkit.relations.blocks",
    "Chart": "dofkit.relations.chart",
    "Finite": "dofkit.relations.normal.pieces",
    "Nonlinear": "dofkit.relations.normal.pieces",
    "Normal": "dofkit.relations.normal.pieces",
    "Pfaffian": "dofkit.relations.normal.pieces",
    "REDUCTIONS": "dofkit.relations.reductions",
    "Row": "dofkit.relations.blocks",
    "Setting": "dofkit.relations.setting",
    "normalise": "dofkit.relations.normal.normal_form",
    "split": "dofkit.relations.blocks",
}


def __getattr__(name: str) -> Any:
    found = globals()[name] = handed_on(__name__, _HOMES, name)
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
