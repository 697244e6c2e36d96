"""Numbers that can be trusted: the canonical ring, points, balls, ranks, exclusion. Knows no mechanics."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.exact.errors import NoPointError, NoValueError, OutsideDomainError, PoleError, TooLargeError
    from dofkit.exact.matrices.sparse import echelon
    from dofkit.exact.points.field import field_point
    from dofkit.exact.points.frames import certified_rank
    from dofkit.exact.points.real_search import RealSearch
    from dofkit.exact.ring.canonical import Canon
    from dofkit.exact.ring.ring import Ring
    from dofkit.exact.zero.identity import is_zero

__all__ = [
    "Canon",
    "NoPointError",
    "NoValueError",
    "OutsideDomainError",
    "PoleError",
    "RealSearch",
    "Ring",
    "TooLargeError",
    "certified_rank",
    "echelon",
    "field_point",
    "is_zero",
]

#: Where the names live: a module is imported when a name of it is first asked for.
_HOMES = {
    "Canon": "dofkit.exact.ring.canonical",
    "NoPointError": "dofkit.exact.errors",
    "NoValueError": "dofkit.exact.errors",
    "OutsideDomainError": "dofkit.exact.errors",
    "PoleError": "dofkit.exact.errors",
    "RealSearch": "dofkit.exact.points.real_search",
    "Ring": "dofkit.exact.ring.ring",
    "TooLargeError": "dofkit.exact.errors",
    "certified_rank": "dofkit.exact.points.frames",
    "echelon": "dofkit.exact.matrices.sparse",
    "field_point": "dofkit.exact.points.field",
    "is_zero": "dofkit.exact.zero.identity",
}


def __getattr__(name: str) -> Any:
    found = globals()[name] = handed_on(__name__, _HOMES, name)
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
