"""What functions are given from outside: names of a list, seconds; anything else is told in one sentence."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Iterable
from numbers import Real

from dofkit.base.errors import ArgumentError
from dofkit.base.spelling import no_such


def description_of(value: object) -> str:
    """A value on one short line, with its type.

    >>> description_of(["x"]), description_of(None)
    ("['x'] (a list)", 'None')
    """
    if value is None:
        return "None"
    name = type(value).__name__
    return f"{' '.join(reprlib.repr(value).split())} ({'an' if name[0] in 'aeiouAEIOU' else 'a'} {name})"


def require_one_of(value: object, known: Iterable[str], what: str) -> None:
    """Raise ArgumentError, with the nearest of the ``known`` names and all of them, for what is none of them.

    >>> require_one_of("exact", ["count", "exact"], "method")
    """
    names = list(known)
    if not isinstance(value, str):
        raise ArgumentError(f"a {what} is one of {', '.join(names)}, not {description_of(value)}")
    if value not in names:
        raise ArgumentError(no_such(value, names, what))


def seconds_of(budget: object) -> float:
    """A budget in seconds, not below 0. Raises ArgumentError where it is no number.

    >>> seconds_of(-2), seconds_of(1.5)
    (0.0, 1.5)
    """
    if not isinstance(budget, Real) or isinstance(budget, bool) or math.isnan(budget):
        raise ArgumentError(f"the budget is a number of seconds, not {description_of(budget)}")
    return max(0.0, float(budget))
