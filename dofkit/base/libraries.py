"""Libraries that are imported when something of them is first used (SPEC 1)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import lazy_loader as lazy

__all__ = ["np", "nx"]

if TYPE_CHECKING:
    import networkx as nx
    import numpy as np
else:
    nx, np = lazy.load("networkx"), lazy.load("numpy")
