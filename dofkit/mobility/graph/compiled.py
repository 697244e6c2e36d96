"""Loops over integer arrays: compiled where numba is installed and the graph is large, else as they are written.

The functions are the same ones. Compiled they run on arrays, plain on lists, which Python reads faster.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from types import FunctionType, ModuleType
from typing import Any

from dofkit.base.libraries import np

#: Links from which compiling, or reading what was compiled before, takes less time than it saves.
WORTH_COMPILING = 40_000
#: Links from which functions that are ready are used.
WORTH_CALLING = 500
#: The modules whose functions were compiled in this process.
_ready: set[str] = set()


@dataclass(frozen=True)
class Engine:
    """``kernels`` has the functions as attributes; ``compiled`` tells what they run on."""

    kernels: Any
    compiled: bool

    def running(self, kernels: ModuleType) -> Any:
        """The functions of another module."""
        return compiled(kernels) if self.compiled else kernels

    def filled(self, size: int, value: int) -> Any:
        """An array of one value."""
        if not self.compiled:
            return [value] * size
        return np.full(size, value, dtype=np.int32)

    def array(self, values: Iterable[int]) -> Any:
        """The values as an array."""
        if not self.compiled:
            return values.tolist() if isinstance(values, np.ndarray) else list(values)
        return np.asarray(values if isinstance(values, np.ndarray) else list(values), dtype=np.int32)


def engine_for(kernels: ModuleType, links: int, if_ready: bool = False, faster: int = 1) -> Engine:
    """What runs the functions of a module, which it lists in ``KERNELS``, callees first.

    ``if_ready``: compiled ones for smaller graphs too, once a large one was met. ``faster``: so many times faster than
    these functions, as they are written, is what else there is.
    """
    worth = WORTH_COMPILING * faster
    least = min(worth, WORTH_CALLING) if if_ready and kernels.__name__ in _ready else worth
    if links < least or find_spec("numba") is None:
        return Engine(kernels, False)
    return Engine(compiled(kernels), True)


@cache
def compiled(kernels: ModuleType) -> Any:
    """The module's functions compiled; the machine code is kept on disk where there is a place for it."""
    import numba

    names = dict(vars(kernels))
    for name in kernels.KERNELS:
        written = names[name]
        own = FunctionType(written.__code__, names, name)
        own.__qualname__, own.__module__ = name, kernels.__name__
        try:
            names[name] = numba.njit(cache=True)(own)
        except RuntimeError:
            names[name] = numba.njit(own)
    _ready.add(kernels.__name__)
    found = ModuleType(kernels.__name__)
    vars(found).update(names)
    return found
