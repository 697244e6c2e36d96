"""The command line: files in, lines and an exit status out."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dofkit.interface.cli import main

__all__ = ["main"]


def __getattr__(name: str) -> Any:
    if name != "main":
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return import_module("dofkit.interface.cli").main


def __dir__() -> list[str]:
    return sorted(__all__)
