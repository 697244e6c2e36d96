"""Libraries that take long to import, each imported when something of it is first asked for.

Most scenes are answered without them, and a cold start is then shorter by a third of its time. So are modules of
dofkit's own that few scenes need.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__all__ = ["np", "nx"]


class LateLibrary:
    """A module by its name, which is imported when one of its attributes is first asked for."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, attribute: str) -> Any:
        """The module's attribute, kept here from then on. Raises AttributeError where it has none."""
        found = self.__dict__[attribute] = getattr(import_module(self._name), attribute)
        return found


if TYPE_CHECKING:
    import networkx as nx
    import numpy as np
else:
    nx, np = LateLibrary("networkx"), LateLibrary("numpy")
