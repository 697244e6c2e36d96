"""What can go because it holds at every state of motion that the others leave, on all their branches."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations
from typing import NamedTuple

from dofkit.base.deadline import unless_late
from dofkit.base.verdicts import About
from dofkit.classification.dependence.implication import follows
from dofkit.classification.freedom.branches import Outcome, solve
from dofkit.classification.freedom.preparation import all_of
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Redundancies, undecided_dependence
from dofkit.relations.linear_relations import linear, presolve
from dofkit.relations.normal.pieces import Finite, Normal, Reduced
from dofkit.relations.setting import Setting
from dofkit.system import System

#: Constraints of one set that are tried one by one, and seconds spent on leaving constraints out.
MAX_CHOICES, LEAVING_SECONDS = 40, 5.0


def implied(reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int]) -> Redundancies:
    """By implication; left open where the constraints are too many or there is no time left for them."""
    if len(numbers) > MAX_CHOICES:
        return undecided_dependence(numbers)
    return unless_late(partial(_by_implication, reduced, setting, numbers), undecided_dependence(numbers))


def _by_implication(reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int]) -> Redundancies:
    """A constraint is redundant where it holds at every state of motion that the others leave, on all their branches.

    The last in the order goes first; where more can go together in its place, they do.
    """
    until = time.process_time() + LEAVING_SECONDS
    kept, unknown = list(numbers), list[int]()
    for i in reversed(numbers):
        answer = (
            None
            if time.process_time() > until
            else constraint_follows(reduced, i, [j for j in kept if j != i], setting)
        )
        if answer:
            kept.remove(i)
        elif answer is None:
            unknown.append(i)
    dropped = _more(reduced, setting, numbers, [i for i in numbers if i not in kept], until)
    kept = [i for i in numbers if i not in dropped]
    circuits = {i: _needed(reduced, reduced[i].normals, kept, setting) for i in dropped}
    groups = [(reduced[i].equations, sorted({i, *circuits[i]})) for i in dropped]
    undecided = [i for i in unknown if i in kept]
    independent, more = _equation_by_equation(reduced, setting, numbers, kept)
    decided = {i: n for i, n in independent.items() if i not in undecided}
    about: About = "everywhere" if setting.reference is None else "reference"
    return Redundancies(decided, dropped, [*groups, *more], circuits, tuple(undecided), about=about)


def _equation_by_equation(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], kept: Sequence[int]
) -> tuple[dict[int, int], list[tuple[int, list[int]]]]:
    """(equations of each that are independent of all before it, groups of equations within what is kept).

    What is finite comes before what is differential.
    """
    order = sorted(numbers, key=lambda i: any(not isinstance(p, Finite) for n in reduced[i].normals for p in n.pieces))
    independent: dict[int, int] = {}
    groups: list[tuple[int, list[int]]] = []
    for k, i in enumerate(order):
        before = [j for j in order[:k] if j in kept]
        single = reduced[i].equations == 1
        known_not_to = single and i in kept and before == order[:k]
        said = [] if known_not_to else _equations_implied(reduced, i, order[:k], setting)
        independent[i] = reduced[i].equations - len(said)
        if i in kept and not single:
            said = said if before == order[:k] else _equations_implied(reduced, i, before, setting)
            groups += [(len(said), sorted({i, *_needed(reduced, said, before, setting)}))] if said else []
    return independent, groups


def _more(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], dropped: list[int], until: float
) -> list[int]:
    """More constraints that can go together than ``dropped``, where there are: x = 0 and y = 0 beside x^2 + y^2 = 0.

    Where every constraint is one row there are none (the exchange of bases).
    """
    rows = [b for i in numbers for n in reduced[i].normals for b in n.branches]
    if not dropped or (len(rows) == len(numbers) and all(len(b) == 1 for b in rows)):
        return dropped
    single = [i for i in numbers if constraint_follows(reduced, i, [j for j in numbers if j != i], setting)]
    for choice in combinations(reversed(single), len(dropped) + 1):
        if time.process_time() > until:
            break
        kept = [j for j in numbers if j not in choice]
        if all(constraint_follows(reduced, i, kept, setting) for i in choice):
            return _more(reduced, setting, numbers, sorted(choice), until)
    return dropped


def _equations_implied(reduced: Sequence[Reduced], i: int, before: Sequence[int], setting: Setting) -> list[Normal]:
    """The equations of a constraint that follow from those before it and from its own first ones."""
    premises = [n for j in before for n in reduced[j].normals]
    said = []
    for n in reduced[i].normals:
        if follows(n, premises, setting):
            said.append(n)
        else:
            premises.append(n)
    return said


def constraint_follows(reduced: Sequence[Reduced], i: int, others: Sequence[int], setting: Setting) -> bool | None:
    """Return whether all equations of a constraint are implied by others; None if undecided."""
    premises = [n for j in others for n in reduced[j].normals]
    return all_of(follows(n, premises, setting) for n in reduced[i].normals)


def _needed(
    reduced: Sequence[Reduced], normals: Sequence[Normal], others: Sequence[int], setting: Setting
) -> list[int]:
    """A minimal set of the others that some equations follow from."""
    kept = list(others)
    for j in reversed(others):
        fewer = [n for k in kept if k != j for n in reduced[k].normals]
        if all(follows(n, fewer, setting) for n in normals):
            kept.remove(j)
    return kept


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
    members = next(a.conflict for a in outcome.answers if a.consistent is False)
    if members and set(members) <= set(kept):
        return Conflict(list(members), True)
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
        self._answers: dict[tuple[int, ...], tuple[bool | None, bool]] = {(): (True, True)}

    def inconsistent(self, numbers: Sequence[int]) -> bool:
        """Return whether some constraints are proved, or as good as proved, to be inconsistent."""
        key = tuple(numbers)
        if key not in self._answers:
            self._answers[key] = self._looked(numbers)
        return self._answers[key][0] is False

    def consistent(self, numbers: Sequence[int]) -> bool:
        """Return whether it was proved, when they were examined, that they are satisfied somewhere."""
        return self._answers.get(tuple(numbers)) == (True, True)

    def _looked(self, numbers: Sequence[int]) -> tuple[bool | None, bool]:
        """(consistent, proved); linear ones alone are simply solved."""
        straight = _linear([self.reduced[i] for i in numbers])
        if straight is not None:
            return not presolve(straight).contradiction, True
        some = [r if i in set(numbers) else Reduced(r.constraint, (), ()) for i, r in enumerate(self.reduced)]
        result = solve(self.system, some, self.setting)
        return result.consistent, all(a.exists or a.verdict == "proved" for a in result.answers)
