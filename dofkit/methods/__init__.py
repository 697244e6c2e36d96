"""The ways to answer as a table, and the doors `ask` and `derived_flag` that choose among them.

The door `classify` stands in a file of its own name, which hides a function that a room would hand on; so does `ask`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.methods.classify import derived_flag
    from dofkit.methods.table import METHODS

__all__ = ["METHODS", "derived_flag"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {"METHODS": "dofkit.methods.table", "derived_flag": "dofkit.methods.classify"}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
