"""Finite relations that Pfaffian forms integrate to, each proved by differentiating."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.integrability.integrals.search import Integral, integrate

__all__ = ["Integral", "integrate"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "Integral": "dofkit.integrability.integrals.search",
    "integrate": "dofkit.integrability.integrals.search",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
