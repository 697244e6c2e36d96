"""Libraries that are imported when something of them is first used (SPEC 1)."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import TYPE_CHECKING, Any

__all__ = ["HAS_NUMPY", "np", "nx"]

#: Whether numpy is installed: in a browser it is not.
HAS_NUMPY = find_spec("numpy") is not None


class _LaterModule(ModuleType):
    """A module that is imported when something of it is first used, also one that is installed meanwhile."""

    def __getattr__(self, name: str) -> Any:
        library = import_module(self.__name__)
        self.__dict__.update(vars(library))
        return getattr(library, name)


if TYPE_CHECKING:
    import networkx as nx
    import numpy as np
else:
    nx, np = _LaterModule("networkx"), _LaterModule("numpy")
