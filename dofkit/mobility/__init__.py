"""Who is joined to whom and where: pebble games, twists, general and special position, the counts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.mobility.graph.answers import linkage, redundant_links
    from dofkit.mobility.graph.result import Linkage
    from dofkit.mobility.kutzbach import kutzbach_count
    from dofkit.mobility.textbook_count import count
    from dofkit.mobility.twists import rows_of

__all__ = ["Linkage", "count", "kutzbach_count", "linkage", "redundant_links", "rows_of"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "Linkage": "dofkit.mobility.graph.result",
    "count": "dofkit.mobility.textbook_count",
    "kutzbach_count": "dofkit.mobility.kutzbach",
    "linkage": "dofkit.mobility.graph.answers",
    "redundant_links": "dofkit.mobility.graph.answers",
    "rows_of": "dofkit.mobility.twists",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
