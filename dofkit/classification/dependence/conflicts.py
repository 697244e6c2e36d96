"""A minimal set of constraints that cannot hold together."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from dofkit.classification.freedom.branches import Outcome, solve
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.linear import linear, presolve
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.reduced import Reduced
from dofkit.relations.setting import Setting
from dofkit.system import System

#: Seconds spent on leaving constraints out.
CONFLICT_SECONDS = 5.0


class Conflict(NamedTuple):
    """Constraints that cannot hold together; ``minimal``: it is proved that none of them can be left out."""

    members: list[int]
    minimal: bool = False


def conflict(system: System, reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> Conflict:
    """Constraints that cannot hold together, none of which can be left out: a deletion filter, the last written first.

    What is left out must leave the others proved to be inconsistent, so the set conflicts also where some of the
    checks are undecided; it is then perhaps not minimal.
    """
    if outcome.impossible:
        return Conflict([outcome.impossible[0]], True)
    plain = replace(setting, grows=False, flag=False)
    guilty = next(b for b, a in zip(outcome.blocks, outcome.answers, strict=True) if a.consistent is False)
    kept = sorted({row.constraint for row in guilty.rows})
    shown = next(a.conflict for a in outcome.answers if a.consistent is False)
    if shown and set(shown) <= set(kept):
        return Conflict(list(shown), True)
    sets = ConstraintSets(system, reduced, plain)
    if not sets.inconsistent(kept):
        kept = [i for i, r in enumerate(reduced) if r.normals]
    kept = _filtered(sets, kept)
    return Conflict(kept, all(sets.consistent(kept[:k] + kept[k + 1 :]) for k in range(len(kept))))


def _linear(some: Sequence[Reduced]) -> list[Expr] | None:
    """The relations where all are finite and linear, on one branch; else None."""
    branches = [branch for r in some for normal in r.normals for branch in (normal.branches or ((),))]
    pieces = [p for branch in branches for p in branch]
    relations = [p.expr for p in pieces if isinstance(p, Finite) and linear(p.expr) is not None]
    single = all(len(normal.branches) == 1 for r in some for normal in r.normals)
    timed = any(ex.TIME in e.symbols for e in relations)
    return relations if single and len(relations) == len(pieces) and len(relations) > 1 and not timed else None


def _filtered(sets: ConstraintSets, kept: list[int]) -> list[int]:
    """Leave out parts of half the size, of a quarter, and so on down to single constraints."""
    until = time.process_time() + CONFLICT_SECONDS
    size = max(1, len(kept) // 2)
    while True:
        for end in range(len(kept), 0, -size):
            if time.process_time() > until:
                return kept
            fewer = kept[: max(0, end - size)] + kept[end:]
            if fewer and sets.inconsistent(fewer):
                kept = fewer
        if size == 1:
            return kept
        size = max(1, size // 2)


class ConstraintSets:
    """Sets of a system's constraints, with what was found of each."""

    def __init__(self, system: System, reduced: Sequence[Reduced], setting: Setting) -> None:
        self.system, self.reduced, self.setting = system, reduced, setting
        self._known: dict[tuple[int, ...], tuple[bool | None, bool]] = {(): (True, True)}

    def inconsistent(self, numbers: Sequence[int]) -> bool:
        """Are some constraints proved, or as good as proved, to be inconsistent?"""
        key = tuple(numbers)
        if key not in self._known:
            self._known[key] = self._looked(numbers)
        return self._known[key][0] is False

    def consistent(self, numbers: Sequence[int]) -> bool:
        """Was it proved, when they were looked at, that they hold somewhere?"""
        return self._known.get(tuple(numbers)) == (True, True)

    def _looked(self, numbers: Sequence[int]) -> tuple[bool | None, bool]:
        """(consistent, proved); linear ones alone are simply solved."""
        straight = _linear([self.reduced[i] for i in numbers])
        if straight is not None:
            return not presolve(straight).contradiction, True
        some = [r if i in set(numbers) else Reduced(r.constraint, (), ()) for i, r in enumerate(self.reduced)]
        found = solve(self.system, some, self.setting)
        return found.consistent, all(a.exists or a.verdict == "proved" for a in found.answers)
