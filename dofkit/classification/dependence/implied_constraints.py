"""Redundant constraints by implication: satisfied at every state that the others allow; and minimal conflicts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

from dofkit.base.deadline import limited, unless_late
from dofkit.base.verdicts import OPEN, About, Claim
from dofkit.classification.dependence.implication import IMPLIED, follows
from dofkit.classification.dependence.minimal_sets import largest_redundant_set, minimal_set
from dofkit.classification.freedom.branches import AnsweredBlocks, Outcome, solve
from dofkit.classification.freedom.preparation import all_of
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import BITS, Redundancies, undecided_dependence
from dofkit.relations.blocks import expressions_of
from dofkit.relations.normal.domain import DomainCondition, conditions_of, is_always_satisfied
from dofkit.relations.normal.no_solution import hold_nowhere
from dofkit.relations.normal.pieces import Finite, Normal, Reduced
from dofkit.relations.setting import Setting

#: Bound on the constraints of a set that is analysed, and seconds for the search of redundant ones.
MAX_CHOICES, LEAVING_SECONDS = 40, 5.0


def implied(reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int]) -> Redundancies:
    """Return the redundancies among ``numbers`` by implication; undecided if these are too many or time runs out."""
    if len(numbers) > MAX_CHOICES:
        return undecided_dependence(numbers)
    return unless_late(partial(_by_implication, reduced, setting, numbers), undecided_dependence(numbers))


def _by_implication(reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int]) -> Redundancies:
    """Return the redundancies: a largest set of constraints that the others imply on all their branches, last first."""
    rows = [b for i in numbers for n in reduced[i].normals for b in n.branches]
    exchange = len(rows) == len(numbers) and all(len(b) == 1 and isinstance(b[0], Finite) for b in rows)
    with limited(LEAVING_SECONDS):
        implied = _Implied(reduced, setting, numbers)
        dropped, undecided = largest_redundant_set(reversed(numbers), implied.in_time, exchange)
    kept = [i for i in numbers if i not in dropped]
    circuits = {i: _needed(reduced, reduced[i].normals, kept, setting) for i in dropped}
    groups = [(reduced[i].equations, sorted({i, *circuits[i]})) for i in dropped]
    independent, more = _equation_by_equation(reduced, setting, numbers, kept)
    decided = {i: n for i, n in independent.items() if i not in undecided}
    about: About = "everywhere" if setting.reference is None else "reference"
    claim = replace(IMPLIED, about=about)
    return Redundancies(decided, dropped, [*groups, *more], circuits, tuple(undecided), claim=claim)


def _equation_by_equation(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], kept: Sequence[int]
) -> tuple[dict[int, int], list[tuple[int, list[int]]]]:
    """Return the number of independent equations of each constraint, and the dependent groups among ``kept``.

    Each of ``numbers`` is compared with those before it, implied differential ones last. ``kept`` are constraints none
    of which is implied by the others. A group is (number of implied equations, constraints concerned).
    """
    forms = {i for i in numbers if not all(isinstance(p, Finite) for n in reduced[i].normals for p in n.pieces)}
    order = sorted(numbers, key=lambda i: i in forms and i not in kept)
    independent: dict[int, int] = {}
    groups: list[tuple[int, list[int]]] = []
    for k, i in enumerate(order):
        before = [j for j in order[:k] if j in kept]
        single = reduced[i].equations == 1
        is_needed = single and i in kept and before == order[:k]
        implied = [] if is_needed else _equations_implied(reduced, i, order[:k], setting)
        independent[i] = reduced[i].equations - len(implied)
        if i in kept and not single:
            implied = implied if before == order[:k] else _equations_implied(reduced, i, before, setting)
            groups += [(len(implied), sorted({i, *_needed(reduced, implied, before, setting)}))] if implied else []
    return independent, groups


@dataclass
class _Implied:
    """Tests whether sets of constraints are implied by the others of ``numbers``, and remembers redundant sets."""

    reduced: Sequence[Reduced]
    setting: Setting
    numbers: Sequence[int]
    _redundant: set[frozenset[int]] = field(default_factory=set)

    def in_time(self, choice: Sequence[int]) -> bool | None:
        """Return whether the constraints outside ``choice`` imply all in it; None if undecided or out of time.

        If all but the last one of ``choice`` are known to be redundant together, only the last one is tested.
        """
        kept = [j for j in self.numbers if j not in choice]
        tested = choice[-1:] if frozenset(choice[:-1]) in self._redundant else choice
        follow = (constraint_follows(self.reduced, i, kept, self.setting) for i in tested)
        redundant = unless_late(lambda: all_of(follow), None)
        if redundant:
            self._redundant.add(frozenset(choice))
        return redundant


def _equations_implied(reduced: Sequence[Reduced], i: int, before: Sequence[int], setting: Setting) -> list[Normal]:
    """Return the equations of constraint i that the constraints ``before`` and its earlier equations imply."""
    premises = _premises(reduced, before, setting)
    implied = []
    for n in reduced[i].normals:
        if follows(n, premises, setting):
            implied.append(n)
        else:
            premises.append(n)
    return implied


def _premises(reduced: Sequence[Reduced], numbers: Iterable[int], setting: Setting) -> list[Normal]:
    """Return the equations of some constraints, and what these as written require if the equations do not."""
    selected = [reduced[i] for i in numbers]
    required = [Normal((r.domain(),)) for r in selected if _loses_domain(r, setting.positive)]
    return [*(n for r in selected for n in r.normals), *required]


def _loses_domain(r: Reduced, positive: frozenset[Expr]) -> bool:
    """Return whether the equations as written may have no value where those analysed do, as x^2/x = y at x = 0."""
    written = [c for c in r.domain() if not is_always_satisfied(c, positive)]
    pieces = [p for n in r.normals for b in n.branches for p in b] if written else []
    kept = [c for p in pieces for e in expressions_of(p) for c in conditions_of(e, positive)]
    kept += [p for p in pieces if isinstance(p, DomainCondition)]
    outside = (([c.expr], kept) if c.sense == "!=" else ([], [*kept, DomainCondition(-c.expr, ">")]) for c in written)
    return not all(hold_nowhere(*claims, positive) for claims in outside)


def constraint_follows(reduced: Sequence[Reduced], i: int, others: Sequence[int], setting: Setting) -> bool | None:
    """Return whether all equations of a constraint are implied by others; None if undecided."""
    premises = _premises(reduced, others, setting)
    return all_of(follows(n, premises, setting) for n in reduced[i].normals)


def _needed(
    reduced: Sequence[Reduced], normals: Sequence[Normal], others: Sequence[int], setting: Setting
) -> list[int]:
    """Return a minimal set of the others that implies some equations."""

    def imply(kept: Sequence[int]) -> bool:
        premises = _premises(reduced, kept, setting)
        return all(follows(n, premises, setting) for n in normals)

    return minimal_set(others, imply)


#: Seconds for the search of a minimal conflict.
CONFLICT_SECONDS = 5.0
#: The claims that a conflict is minimal: without any one constraint the others are consistent.
MINIMAL, PROBABLY_MINIMAL = Claim("proved", "leaving out"), Claim("probable", "leaving out", bits=BITS)


class Conflict(NamedTuple):
    """Constraints that contradict each other; ``claim``: that the set is minimal."""

    members: list[int]
    claim: Claim = OPEN


def conflict(reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> Conflict:
    """Return a minimal set of constraints that contradict each other, by a deletion filter, the last written first.

    A constraint is left out only if the others are proved to be inconsistent. If a check is undecided, the set still
    conflicts, but is perhaps not minimal.
    """
    sets = ConstraintSets(reduced, replace(setting, grows=False, flag=False))
    against = [(b, a) for b, a in zip(outcome.blocks, outcome.answers, strict=True) if a.consistent is False]
    kept = sorted({*outcome.impossible} or {row.constraint for b, _ in against[:1] for row in b.rows})
    members = next((a.conflict for _, a in against), ())
    plain = all(len(n.branches) == 1 for i in members for n in reduced[i].normals)  # in all choices of branches
    if plain and members and set(members) <= set(kept):
        return Conflict(list(members), MINIMAL)
    if not sets.inconsistent(kept):
        kept = [i for i, r in enumerate(reduced) if r.normals]
    with limited(CONFLICT_SECONDS):
        kept = minimal_set(kept, sets.inconsistent_in_time, len(kept) // 2 or 1)
    satisfied = {sets.satisfied(kept[:k] + kept[k + 1 :]) for k in range(len(kept))}
    return Conflict(kept, OPEN if OPEN in satisfied else PROBABLY_MINIMAL if PROBABLY_MINIMAL in satisfied else MINIMAL)


class ConstraintSets:
    """Tests the consistency of sets of a system's constraints, and remembers the results."""

    def __init__(self, reduced: Sequence[Reduced], setting: Setting) -> None:
        self.reduced, self.answered = reduced, AnsweredBlocks(setting)
        self._answers: dict[tuple[int, ...], tuple[bool | None, bool]] = {(): (True, True)}

    def inconsistent(self, numbers: Sequence[int]) -> bool:
        """Return whether the answer for some constraints is that they are inconsistent, proved or not."""
        key = tuple(numbers)
        if key not in self._answers:
            self._answers[key] = self._solved(numbers)
        return self._answers[key][0] is False

    def inconsistent_in_time(self, numbers: Sequence[int]) -> bool:
        """Return whether some constraints are inconsistent; False also if time runs out."""
        return bool(numbers) and unless_late(partial(self.inconsistent, numbers), False)

    def satisfied(self, numbers: Sequence[int]) -> Claim:
        """Return how certain it is that some constraints are consistent, as they are if a larger tested set is."""
        proved = {sure for tested, (answer, sure) in self._answers.items() if answer and {*numbers} <= {*tested}}
        return MINIMAL if True in proved else PROBABLY_MINIMAL if proved else OPEN

    def _solved(self, numbers: Sequence[int]) -> tuple[bool | None, bool]:
        """Return (whether some constraints are consistent, whether this is proved)."""
        some = [r if i in set(numbers) else Reduced(r.constraint, (), ()) for i, r in enumerate(self.reduced)]
        result = solve(some, self.answered.setting, self.answered)
        return result.consistent, all(a.exists or a.verdict == "proved" for a in result.answers)
