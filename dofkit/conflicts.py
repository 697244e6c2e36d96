"""A minimal set of constraints that cannot hold together."""

from __future__ import annotations

import time
from collections.abc import Sequence

from dofkit.answers import Setting
from dofkit.solving import Outcome, Reduced, solve
from dofkit.system import System

#: Constraints of a conflict that are tried one by one for a minimal set, and the seconds spent on it.
MAX_CONFLICT, CONFLICT_SECONDS = 60, 5.0


def conflict(system: System, reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> list[int]:
    """A minimal set of constraints that cannot hold together: leaving one out at a time, the last written first."""
    if outcome.impossible:
        return [outcome.impossible[0]]
    guilty = next(b for b, a in zip(outcome.blocks, outcome.answers, strict=True) if a.consistent is False)
    kept = sorted({row.constraint for row in guilty.rows})
    if not _inconsistent(system, reduced, setting, kept):
        kept = [i for i, r in enumerate(reduced) if r.normals]
    if len(kept) > MAX_CONFLICT:
        return kept
    until = time.monotonic() + CONFLICT_SECONDS
    for i in reversed(list(kept)):
        if time.monotonic() > until:
            break
        fewer = [j for j in kept if j != i]
        if fewer and _inconsistent(system, reduced, setting, fewer):
            kept = fewer
    return kept


def _inconsistent(system: System, reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int]) -> bool:
    some = [r if i in set(numbers) else Reduced(r.constraint, (), ()) for i, r in enumerate(reduced)]
    return solve(system, some, setting).consistent is False
