"""Trials whose answers are known by construction, every method on each of them, and the charts of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.benchmark.command import chart

__all__ = ["chart"]


def __getattr__(name: str) -> Any:
    return handed_on(__name__, {"chart": "dofkit.benchmark.command"}, name)
