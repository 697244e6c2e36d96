"""The graph of rigid links: what is redundant, rigid and what moves, in general position."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.mobility.graph.answer import Proof
    from dofkit.mobility.graph.answers import linkage, redundant_links
    from dofkit.mobility.graph.links import LinkageError
    from dofkit.mobility.graph.result import Group, Hinge, Linkage

__all__ = ["Group", "Hinge", "Linkage", "LinkageError", "Proof", "linkage", "redundant_links"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "Group": "dofkit.mobility.graph.result",
    "Hinge": "dofkit.mobility.graph.result",
    "Linkage": "dofkit.mobility.graph.result",
    "LinkageError": "dofkit.mobility.graph.links",
    "Proof": "dofkit.mobility.graph.answer",
    "linkage": "dofkit.mobility.graph.answers",
    "redundant_links": "dofkit.mobility.graph.answers",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
