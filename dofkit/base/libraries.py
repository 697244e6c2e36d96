"""Libraries that are imported when something of them is first used (SPEC 1)."""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

import lazy_loader as lazy

__all__ = ["HAS_NUMPY", "np", "nx"]

#: Whether numpy is installed: in a browser it is not. This is asked before it is in `sys.modules` to be imported later.
HAS_NUMPY = find_spec("numpy") is not None

if TYPE_CHECKING:
    import networkx as nx
    import numpy as np
else:
    nx, np = lazy.load("networkx"), lazy.load("numpy")
