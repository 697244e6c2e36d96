"""Finite relations that Pfaffian forms integrate to, each proved by differentiating."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dofkit.integrability.integrals.search import Integral, integrate

__all__ = ["Integral", "integrate"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "Integral": "dofkit.integrability.integrals.search",
    "integrate": "dofkit.integrability.integrals.search",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module(_HOMES[name]), name)
