"""The figures of a run. Needs matplotlib, which is imported when the first of them is drawn."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dofkit.benchmark.figures.table import FIGURES, write

__all__ = ["FIGURES", "write"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module("dofkit.benchmark.figures.table"), name)
