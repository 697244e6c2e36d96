"""What a worker is asked, and how that ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

#: What json can write: the only thing that comes back from a worker.
Json = Any

#: ``done``; ``failed``: it raised; ``overrun``: killed at its limit; ``memory``: it wanted more than it may take;
#: ``died``: its process ended; ``absent``: none could be started.
Ended = Literal["done", "failed", "overrun", "memory", "died", "absent"]


@dataclass(frozen=True)
class Job:
    """A function to call with one argument in a worker, and how long that may take.

    ``function``: one that the worker can import, or its name ``module:function``. It returns what json can write; or
    it is a generator of such values, each better than the one before: the last one stands where the job is cut short.
    ``payload`` is anything that can be pickled. ``seconds``: how long it may work without telling anything, in
    wall-clock time, before it is killed; ``first``: the same until it tells the first thing, where that differs.
    """

    function: str | Callable[[Any], Any]
    payload: Any
    seconds: float
    first: float | None = None

    @property
    def name(self) -> str:
        """``module:function``. Raises ValueError for a function that no other process can import."""
        if isinstance(self.function, str):
            return self.function
        module, name = self.function.__module__, self.function.__qualname__
        if module == "__main__" or "<" in name:
            raise ValueError(f"a worker cannot import {name!r} of {module!r}: put it into a module of its own")
        return f"{module}:{name}"

    @property
    def limits(self) -> tuple[float, float]:
        """Seconds until the first thing is told, and from each to the next."""
        return self.seconds if self.first is None else self.first, self.seconds


@dataclass(frozen=True)
class JobOutcome:
    """What a job told last (None: nothing), how it ended, and why where that is not ``done``.

    Of a ``failed`` job ``error`` is the name of the exception's type, and ``trace`` its traceback.
    """

    value: Json
    ended: Ended
    reason: str = ""
    error: str = ""
    trace: str = ""

    @property
    def finished(self) -> bool:
        """Is the value all that the job had to tell?"""
        return self.ended == "done"
