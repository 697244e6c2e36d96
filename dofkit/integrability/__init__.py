"""Codistributions: the Lie algebra of admissible velocities, the derived flag, hidden relations, integrals.

`first_integrals` and `traits` stand in files of their own names, which hide a function that a room would hand on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.integrability.growth_vector import derived_flag, growth
    from dofkit.integrability.integrals.search import integrate
    from dofkit.integrability.lie_algebra import lie_span
    from dofkit.integrability.pfaffian_system import codistribution

__all__ = ["codistribution", "derived_flag", "growth", "integrate", "lie_span"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "codistribution": "dofkit.integrability.pfaffian_system",
    "derived_flag": "dofkit.integrability.growth_vector",
    "growth": "dofkit.integrability.growth_vector",
    "integrate": "dofkit.integrability.integrals.search",
    "lie_span": "dofkit.integrability.lie_algebra",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
