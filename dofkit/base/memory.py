"""Python's collection of garbage, held back while many small objects are made that form no cycles."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

#: Objects more than were freed before new ones are looked through; rounds before those that stayed are, and all.
MANY, SOME, FEW = 200_000, 20, 20
#: Fewer new objects than this are not worth asking whether somebody froze others: that counts these one by one.
WORTH_IT = 50_000
#: Objects that stay of every constraint: so many at least are made before any are looked through.
OF_EACH = 100


@contextmanager
def gc_rarely(constraints: int = 0) -> Iterator[None]:
    """Garbage is looked for seldom: expressions are trees, and to look through millions of them takes half the time.

    What was made before, and what stays of what is made within, is looked through as seldom as all that is old. Of many
    ``constraints`` more is made that stays.
    """
    before = gc.get_threshold()
    _grown_old()
    gc.set_threshold(max(before[0], MANY, OF_EACH * constraints), max(before[1], SOME), max(before[2], FEW))
    try:
        yield
    finally:
        _grown_old()
        gc.set_threshold(*before)


@contextmanager
def gc_paused() -> Iterator[None]:
    """No garbage is looked for: for what makes hardly any beside what it was asked for, and stays."""
    if not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        _grown_old()
        gc.enable()


def _grown_old() -> None:
    """Many new objects count as old, without being looked through; what somebody has frozen stays so."""
    if gc.get_count()[0] > WORTH_IT and not gc.get_freeze_count():
        gc.freeze()
        gc.unfreeze()
