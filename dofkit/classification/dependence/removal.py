"""Redundant constraints of a block found by removing them, and independent equations counted near the reference.

Removal: a constraint is needed if the freedom is larger without it. If not, it is redundant if the others imply it;
otherwise its removal may add a component of the same dimension.

Counting (`counted`), if relations are dependent at the reference: an equation is independent of those before it if it
is no combination of them with coefficients that are analytic near the reference. This is so if its row at the reference
is no combination of rows before it. If it is one, the equation is dependent if it vanishes on the manifold of the
independent equations before it [ImplicitFunctions]; the first equation that does not is independent, and then no
further one is allowed. Of several such equations of one constraint all but one are dependent if they are satisfied, in
numbers, at the points near the reference where that one is: creases that meet in a point close up by one condition of
second order, which several equations state. The numbers must agree with the freedom.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import groupby
from typing import NamedTuple

from dofkit.base.deadline import OutOfTimeError, check, limited, unless_late
from dofkit.base.verdicts import About, Claim, Verdict, weakest
from dofkit.classification.dependence.implication import Everywhere
from dofkit.classification.dependence.implied_constraints import LEAVING_SECONDS
from dofkit.classification.dependence.minimal_sets import SufficientSets, largest_redundant_set, minimal_set
from dofkit.classification.dependence.near_reference import NearReference, freedom, is_at_reference
from dofkit.classification.freedom.preparation import all_of
from dofkit.exact.matrices.sparse import components, echelon
from dofkit.relations.answer import BITS, GAP, Answer, Redundancies
from dofkit.relations.blocks import Block
from dofkit.relations.setting import Setting


def by_removal(block: Block, setting: Setting, a: Answer, nullity: int, numbered: Sequence[int]) -> Redundancies:
    """Return the redundancies of a block of geometric equations by removal, the last written first.

    ``nullity``: the number of dependent rows by the freedom; ``numbered``: the equation to which each row belongs.
    """
    owners = owners_of(block)
    order = list(dict.fromkeys(owners))
    removal = Removal(block, setting, a)
    with limited(LEAVING_SECONDS):
        largest = largest_redundant_set(reversed(order), removal.in_time)
        circuits = _circuits(removal, order, largest.members)
    removed = Counter(o for o in owners if o in largest.members)
    groups = [(removed[o], sorted({o, *circuit})) for o, circuit in circuits.items()]
    if removed and (removed.total() < nullity or circuits.keys() != removed.keys()):
        groups = [(max(nullity, removed.total()), sorted(order))]
    undecided = tuple(largest.undecided)
    answer = Redundancies({}, largest.members, groups, circuits, undecided, claim=_claim(removal.verdict, a.about))
    count = counted(block, setting, a, numbered) if is_at_reference(block, a, setting) else None
    if count is not None:
        claim = _claim(weakest(removal.verdict, "numeric" if count.seen else "probable"), a.about)
        counts = replace(answer, independent=count.independent, equations=count.equations, seen=count.seen)
        return replace(counts, groups=groups or count.groups, claim=claim)
    independent = {o: 0 for o, circuit in circuits.items() if circuit and max(circuit) < o}
    open_ = {*largest.members, *largest.undecided}
    independent |= {o: 1 for o in order if owners.count(o) == 1 and o not in open_}
    uncounted = tuple(o for o in order if o not in independent and o not in undecided)
    return replace(answer, independent=independent, uncounted=uncounted)


def _claim(verdict: Verdict, about: About) -> Claim:
    return Claim(verdict, "implication", BITS, GAP, about)


def _circuits(removal: Removal, order: Sequence[int], redundant: Sequence[int]) -> dict[int, list[int]]:
    """Return for each redundant constraint a minimal set of the others that imply it, as far as time allows."""
    result = {}
    others = [o for o in order if o not in redundant]
    for owner in redundant:
        try:
            result[owner] = sorted(minimal_set(others, partial(removal.is_redundant, [owner])))
        except OutOfTimeError:
            break
    return result


def owners_of(block: Block) -> list[int]:
    """Return the constraint of each row."""
    return [r.constraint for r in block.rows]


@dataclass
class Removal:
    """Tests the removal of constraints of a block, whose answer is ``whole``; ``verdict``: the weakest so far."""

    block: Block
    setting: Setting
    whole: Answer
    verdict: Verdict = "probable"
    _answers: dict[tuple[frozenset[int], frozenset[int]], bool | None] = field(default_factory=dict)
    _dofs: dict[frozenset[int], int | None] = field(default_factory=dict)

    def is_redundant(self, owners: Collection[int], others: Collection[int] | None = None) -> bool | None:
        """Return whether the set is the same without the constraints ``owners``; None if undecided.

        ``others``: the remaining constraints, by default all others of the block.
        """
        removed = frozenset(owners)
        kept = frozenset(owners_of(self.block)) - removed if others is None else frozenset(others)
        if (removed, kept) not in self._answers:
            check()
            before, after = self._dof(removed | kept), self._dof(kept)
            same = None if before is None or after is None else before == after
            self._answers[removed, kept] = self._is_same_set(removed, kept) if same else same
        return self._answers[removed, kept]

    def in_time(self, owners: Sequence[int]) -> bool | None:
        """Return whether constraints are redundant; None if undecided or out of time."""
        return unless_late(partial(self.is_redundant, owners), None)

    def _dof(self, kept: frozenset[int]) -> int | None:
        """Return the freedom with the constraints ``kept`` only; None if undecided."""
        if kept not in self._dofs:
            rows = [r for r in self.block.rows if r.constraint in kept]
            all_rows = len(rows) == len(self.block.rows)
            self._dofs[kept] = self.whole.dof if all_rows else freedom(self.block.coordinates, rows, self.setting)
        return self._dofs[kept]

    def _is_same_set(self, removed: frozenset[int], kept: frozenset[int]) -> bool | None:
        """Return whether the kept constraints imply the removed ones, of equal freedom; this may weaken ``verdict``.

        They do if the set is an orbit of rigid motions of the system.
        """
        rows, others = (
            [i for i, r in enumerate(self.block.rows) if r.constraint in constraints] for constraints in (removed, kept)
        )
        if not is_at_reference(self.block, self.whole, self.setting):
            return all_of(Everywhere(self.block, self.setting).follows(i, others) for i in rows)
        near = NearReference(self.block, self.setting)
        if near.is_orbit(others, self._dof(kept)) or near.imply(others, rows, self.whole):
            return True
        self.verdict = "numeric"
        return near.seem_to_imply(others, rows) or None


class EquationCount(NamedTuple):
    """By constraint, the number of independent equations, and the numbers of the dependent ones; and groups.

    ``seen``: constraints with equations that are implied by numerical evidence only.
    """

    independent: dict[int, int]
    equations: dict[int, tuple[int, ...]]
    groups: list[tuple[int, list[int]]]
    seen: tuple[int, ...]


def counted(block: Block, setting: Setting, a: Answer, numbered: Sequence[int]) -> EquationCount | None:
    """Return the count for a block analysed at the reference; None if undecided, or not in agreement with the freedom.

    ``numbered``: the equation to which each row belongs.
    """
    if a.dof is None or len(a.matrix) != len(block.rows):
        return None
    counting = _Counting(block, setting, a)
    supports = counting.supports()
    if supports is None or len(supports) != max(0, len(block.rows) - (len(block.coordinates) - a.dof)):
        return None
    owners = owners_of(block)
    dependent = Counter(owners[i] for i in supports)
    circuits = [{owners[i], *(owners[j] for j in support)} for i, support in supports.items()]
    joined = [{o for k in numbers for o in circuits[k]} for numbers in components(circuits)]
    groups = [(sum(dependent[o] for o in c), sorted(c)) for c in joined]
    equations = {o: tuple(numbered[i] for i in supports if owners[i] == o) for o in owners}
    independent = {o: k - dependent[o] for o, k in Counter(owners).items()}
    return EquationCount(independent, equations, sorted(groups, key=lambda g: g[1]), tuple(counting.seen))


@dataclass
class _Counting:
    """Finds for each row the rows before it that imply it: ``following``; ``seen``: as in `EquationCount`.

    ``bent``: an equation that is dependent only at the reference was counted as independent.
    """

    block: Block
    setting: Setting
    a: Answer
    seen: list[int] = field(default_factory=list)
    bent: bool = False
    following: dict[int, list[int]] = field(default_factory=dict)

    @cached_property
    def _near(self) -> NearReference:
        return NearReference(self.block, self.setting)

    @cached_property
    def _dependent(self) -> Mapping[int, Sequence[int]]:
        """For rows that are combinations of rows before them at the reference, these rows."""
        return echelon(self.a.matrix, self.a.modulus, supports=True).supports

    def supports(self) -> dict[int, list[int]] | None:
        """Return, for every row implied by rows before it, such rows; None if undecided.

        The order of the rows of one constraint does not matter: of equivalent ones any may be taken as the first.
        """
        for owner, rows in groupby(sorted(self._dependent), key=owners_of(self.block).__getitem__):
            remaining = self._independent_rows(rows)
            if remaining is None or not self._by_one(owner, remaining):
                return None
        return self.following

    def _independent_rows(self, rows: Iterable[int]) -> list[int] | None:
        """Return those of some dependent rows that the independent rows before them do not imply; None if undecided."""
        result = []
        for i in rows:
            check()
            pivots = [k for k in range(i) if k not in self._dependent]
            enough = SufficientSets(self._near, owners_of(self.block), pivots).enough(i, self._dependent[i])
            if enough is not None:
                self.following[i] = enough
            elif self._near.follows(i, pivots) is None:
                return None
            else:
                result.append(i)
        return result

    def _by_one(self, owner: int, rows: Sequence[int]) -> bool:
        """Return whether one of some rows of a constraint, with the rows before, numerically implies the other ones.

        This is allowed for one constraint only (``bent``).
        """
        pivots = [k for k, o in enumerate(owners_of(self.block)) if o <= owner and k not in self._dependent]
        for first in () if self.bent else rows:
            others = [i for i in rows if i != first]
            if not others or self._near.seem_to_imply([*pivots, first], others):
                self.bent = True
                self.following |= {i: [*pivots, first] for i in others}
                self.seen += [owner] if others else []
                return True
        return not rows
