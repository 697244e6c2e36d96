"""A bound on the time of one scene: long loops call `check`, which raises when the time is used up.

`gc_rarely` saves time: expressions are trees, and searching millions of them for garbage takes half of it.
"""

from __future__ import annotations

import gc
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

from dofkit.base.errors import DofkitError

#: Seconds for one scene where the caller gives no budget.
DEFAULT_SECONDS = 60.0
#: Past that, work has so many seconds (or that part of the time, if it is more) to see it and to end by itself.
GRACE_SECONDS, GRACE_PART = 1.0, 0.25
#: rows * columns * min(rows, columns) of a dense matrix that is still eliminated, and how much of that a second does.
MAX_WORK, WORK_A_SECOND = 30_000_000_000, 3e9
#: New objects before garbage is searched for, and rounds before older objects are.
GC_THRESHOLD = (200_000, 20, 20)
#: Between two looks at the clock so many functions are called or return: more often it takes longer than they do.
CALLS = 64
OUT_OF_TIME = "the time allowed for the scene was used up"

#: Seconds of processor time of this thread; of the clock on a platform that does not count them (WebAssembly).
thread_time: Callable[[], float] = getattr(time, "thread_time", time.monotonic)

T = TypeVar("T")
_until: ContextVar[float] = ContextVar("until", default=float("inf"))
_clock: ContextVar[Callable[[], float] | None] = ContextVar("clock", default=None)


class OutOfTimeError(DofkitError):
    """The time allowed for the scene was used up; what was asked is undecided."""


@contextmanager
def gc_rarely() -> Iterator[None]:
    """Search for garbage rarely within the block."""
    before = gc.get_threshold()
    gc.set_threshold(*map(max, before, GC_THRESHOLD))
    try:
        yield
    finally:
        gc.set_threshold(*before)


def limit(seconds: float) -> float:
    """Return the seconds after which work is killed that should have ended by itself after ``seconds``."""
    return seconds + max(GRACE_SECONDS, GRACE_PART * seconds)


def _now() -> float:
    clock = _clock.get()
    return time.monotonic() if clock is None else clock()


@contextmanager
def by_processor(seconds: float) -> Iterator[None]:
    """Let `check` raise after so many seconds of this thread's processor time, whatever else the machine does.

    Limits within the block are counted so too, so that the same work ends at the same place.
    """
    clock, token = _clock.set(thread_time), _until.set(thread_time() + seconds)
    try:
        yield
    finally:
        _until.reset(token)
        _clock.reset(clock)


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Let `check` raise after so many seconds, or at an outer limit if that comes first."""
    token = _until.set(min(_until.get(), _now() + seconds))
    try:
        yield
    finally:
        _until.reset(token)


def remaining_seconds() -> float:
    """Return the seconds that are left."""
    return max(0.0, _until.get() - _now())


@contextmanager
def part(share: float) -> Iterator[None]:
    """Let `check` raise after this share of the time that is left, so that the remainder serves what comes after."""
    with limited(share * remaining_seconds()):
        yield


def unless_late(work: Callable[[], T], otherwise: T) -> T:
    """Return the result of ``work``, or ``otherwise`` where the time is used up before."""
    try:
        return work()
    except OutOfTimeError:
        return otherwise


def check() -> None:
    """Raise OutOfTimeError where the time is used up."""
    if _now() > _until.get():
        raise OutOfTimeError(OUT_OF_TIME)


@contextmanager
def checked_calls() -> Iterator[None]:
    """Run `check` at every `CALLS`-th call or return in the block: for a library whose loops never run it."""
    before, asked = sys.getprofile(), 0

    def count(*_event: object) -> None:
        nonlocal asked
        asked += 1
        if asked % CALLS == 0:
            check()

    sys.setprofile(count)
    try:
        yield
    finally:
        sys.setprofile(before)


def affordable(rows: int, columns: int) -> None:
    """Raise OutOfTimeError for a matrix too large for elimination in the time of a scene, or in what is left of it."""
    if rows * columns * min(rows, columns) > min(MAX_WORK, WORK_A_SECOND * remaining_seconds()):
        raise OutOfTimeError(f"a matrix of {rows} rows and {columns} columns is too large here")


def expired() -> bool:
    """Return whether the time is used up."""
    return _now() > _until.get()
