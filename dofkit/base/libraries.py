"""numpy and networkx, each imported when an attribute is first used (SPEC 1)."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import TYPE_CHECKING, Any

__all__ = ["HAS_NUMPY", "np", "nx"]

#: Whether numpy is installed: in a browser it is not.
HAS_NUMPY = find_spec("numpy") is not None


class _LaterModule(ModuleType):
    """A module that is imported when an attribute is first used; it may be installed in the meantime."""

    def __getattr__(self, name: str) -> Any:
        library = import_module(self.__name__)
        self.__dict__.update(vars(library))
        return getattr(library, name)


if TYPE_CHECKING:
    import networkx as nx
    import numpy as np
else:
    nx, np = _LaterModule("networkx"), _LaterModule("numpy")
