"""Right, wrong or undecided: what was told against what holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dofkit.benchmark.record import Outcome


def outcome_of(truth: Any, told: Any) -> Outcome:
    """How an answer compares with the truth. None is undecided, also for a single constraint of a mapping.

    >>> outcome_of(2, 2), outcome_of(2, None), outcome_of(["c"], ["b"])
    ('right', 'undecided', 'wrong')
    >>> outcome_of({"a": True, "b": False}, {"a": True}), outcome_of({"a": True, "b": False}, {"a": False})
    ('undecided', 'wrong')
    """
    if told is None:
        return "undecided"
    if not isinstance(truth, Mapping) or not isinstance(told, Mapping):
        return "right" if _same(truth, told) else "wrong"
    decided = {name: value for name, value in told.items() if value is not None}
    if any(name not in truth or not _same(truth[name], value) for name, value in decided.items()):
        return "wrong"
    return "right" if len(decided) == len(truth) else "undecided"


def _same(truth: Any, told: Any) -> bool:
    """True is not 1 here, and the order of what is redundant does not matter."""
    if isinstance(truth, list | tuple) and isinstance(told, list | tuple):
        return sorted(map(str, truth)) == sorted(map(str, told))
    return isinstance(truth, bool) == isinstance(told, bool) and bool(truth == told)
