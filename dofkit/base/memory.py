"""Python's collection of garbage, held back while many small objects are made that form no cycles."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

#: Objects more than were freed before new ones are looked through; rounds before those that stayed are, and all.
MANY, SOME, FEW = 200_000, 20, 20


@contextmanager
def unhurried() -> Iterator[None]:
    """Garbage is looked for seldom: expressions are trees, and to look through millions of them takes half the time.

    What was made before is looked through as seldom as what is made within.
    """
    before = gc.get_threshold()
    gc.set_threshold(max(before[0], MANY), max(before[1], SOME), max(before[2], FEW))
    try:
        yield
    finally:
        gc.set_threshold(*before)
