"""A system made ready for the engines: every relation as what it says, and what may be assumed of its symbols."""

from __future__ import annotations

from dofkit import expr as ex
from dofkit.answers import Setting
from dofkit.reductions import ALL, Reductions
from dofkit.solving import Reduced, reduce_all
from dofkit.system import System


def prepared(system: System, reductions: Reductions = ALL) -> tuple[list[Reduced], Setting]:
    """Each relation as what it says, and what may be assumed of the symbols."""
    positive = frozenset(ex.parameter(p) for p, sign in system.parameters.items() if sign == "positive")
    positive |= frozenset(ex.parameter(p) for p in system.generic if p.startswith("_L"))
    reduced = reduce_all(system, positive)
    setting = Setting(
        positive,
        tuple(ex.parameter(p) for p in system.generic),
        system.pose,
        system.reference,
        system.coordinates,
        system.tolerance,
        system.size,
        dimension=system.dimension,
        distances={} if system.tolerance else system.distances,
        links=_links(system),
        reductions=reductions,
        welds=frozenset(i for i, c in enumerate(system.constraints) if c.type == "weld"),
    )
    return reduced, setting


def _links(system: System) -> dict[int, list[tuple[str, str]]]:
    """The particles that rigid links join, by constraint."""
    found: dict[int, list[tuple[str, str]]] = {}
    for i, a, b in system.links:
        found.setdefault(i, []).append((a, b))
    return found
