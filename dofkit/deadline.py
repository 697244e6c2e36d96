"""A bound on the time one scene may take: long loops ask `check`, which raises when it is used up."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from dofkit.errors import DofkitError

#: Seconds for one scene where the caller gives no budget.
DEFAULT_SECONDS = 60.0
#: Past that, work has so many seconds (or that part of the time, if it is more) to see it and to end by itself.
GRACE_SECONDS, GRACE_PART = 1.0, 0.25
OUT_OF_TIME = "the time allowed for the scene was used up"

_until: ContextVar[float] = ContextVar("until", default=float("inf"))


class OutOfTimeError(DofkitError):
    """The time allowed for the scene was used up; what was asked is undecided."""


def limit(seconds: float) -> float:
    """The seconds after which work is killed that should have ended by itself after ``seconds``."""
    return seconds + max(GRACE_SECONDS, GRACE_PART * seconds)


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Let `check` raise after so many seconds, or at an outer limit if that comes first."""
    token = _until.set(min(_until.get(), time.monotonic() + seconds))
    try:
        yield
    finally:
        _until.reset(token)


def check() -> None:
    """Raise OutOfTimeError where the time is used up."""
    if time.monotonic() > _until.get():
        raise OutOfTimeError(OUT_OF_TIME)


def expired() -> bool:
    """Is the time used up?"""
    return time.monotonic() > _until.get()
