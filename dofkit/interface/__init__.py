"""The command line: files in, lines and an exit status out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.interface.cli import main

__all__ = ["main"]


def __getattr__(name: str) -> Any:
    return handed_on(__name__, {"main": "dofkit.interface.cli"}, name)


def __dir__() -> list[str]:
    return sorted(__all__)
