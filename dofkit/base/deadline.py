"""A limit on the time of one scene: long loops call `check`, which raises when the time is used up.

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

#: Seconds for one scene if the caller gives no budget.
DEFAULT_SECONDS = 60.0
#: After its time, work has this many seconds (or this part of the time, if it is more) to end by itself.
GRACE_SECONDS, GRACE_PART = 1.0, 0.25
#: The largest work rows * columns * min(rows, columns) of a dense elimination, and the work done in a second.
MAX_WORK, WORK_A_SECOND = 30_000_000_000, 3e9
#: Python's thresholds for garbage collection: new objects, and collections until older objects are searched too.
GC_THRESHOLD = (1_000_000, 20, 20)
#: `checked_calls` reads the clock once in this many calls and returns, so that reading takes little time.
CALLS = 64
OUT_OF_TIME = "the time allowed for the scene was used up"

#: Seconds of processor time of this thread; of the clock on a platform that does not count them (WebAssembly).
thread_time: Callable[[], float] = getattr(time, "thread_time", time.monotonic)

T = TypeVar("T")
_until: ContextVar[float] = ContextVar("until", default=float("inf"))
_clock: ContextVar[Callable[[], float] | None] = ContextVar("clock", default=None)


class OutOfTimeError(DofkitError):
    """The time allowed for the scene was used up; the question is undecided."""


@contextmanager
def gc_rarely() -> Iterator[None]:
    """Collect garbage rarely within the block."""
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
    """Within the block `check` raises after ``seconds`` of this thread's processor time.

    Inner limits count processor time too, so that the same work ends at the same point on a busy machine.
    """
    clock, token = _clock.set(thread_time), _until.set(thread_time() + seconds)
    try:
        yield
    finally:
        _until.reset(token)
        _clock.reset(clock)


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Within the block `check` raises after ``seconds``, or at an outer limit if that comes first."""
    token = _until.set(min(_until.get(), _now() + seconds))
    try:
        yield
    finally:
        _until.reset(token)


def remaining_seconds() -> float:
    """Return the seconds until `check` raises, at least 0; infinity without a limit."""
    return max(0.0, _until.get() - _now())


@contextmanager
def part(share: float) -> Iterator[None]:
    """Within the block `check` raises after this share of the remaining time; the remainder is for later work."""
    with limited(share * remaining_seconds()):
        yield


def unless_late(work: Callable[[], T], otherwise: T) -> T:
    """Return the result of ``work``, or ``otherwise`` if the time is used up first."""
    try:
        return work()
    except OutOfTimeError:
        return otherwise


def check() -> None:
    """Raise OutOfTimeError if the time is used up."""
    if _now() > _until.get():
        raise OutOfTimeError(OUT_OF_TIME)


@contextmanager
def checked_calls() -> Iterator[None]:
    """Run `check` at every `CALLS`-th call or return in the block: for a library whose loops never run it."""
    before, events = sys.getprofile(), 0

    def count(*_event: object) -> None:
        nonlocal events
        events += 1
        if events % CALLS == 0:
            check()

    sys.setprofile(count)
    try:
        yield
    finally:
        sys.setprofile(before)


def affordable(rows: int, columns: int) -> None:
    """Raise OutOfTimeError if the elimination of a dense matrix takes too long, or longer than the remaining time."""
    if rows * columns * min(rows, columns) > min(MAX_WORK, WORK_A_SECOND * remaining_seconds()):
        raise OutOfTimeError(f"a matrix of {rows} rows and {columns} columns is too large here")


def expired() -> bool:
    """Return whether the time is used up."""
    return _now() > _until.get()
