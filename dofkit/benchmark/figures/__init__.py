"""The figures of a run. Needs matplotlib, which is imported when the first of them is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.benchmark.figures.table import FIGURES, write

__all__ = ["FIGURES", "write"]


def __getattr__(name: str) -> Any:
    return handed_on(__name__, dict.fromkeys(__all__, "dofkit.benchmark.figures.table"), name)
