"""Trials whose answers are known by construction, every method on each of them, and the charts of it."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dofkit.benchmark.command import run as chart

__all__ = ["chart"]

#: What is handed on, where it lives, and its name there: imported when it is first asked for.
_HOMES = {"chart": ("dofkit.benchmark.command", "run")}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    home, function = _HOMES[name]
    return getattr(import_module(home), function)
