"""What is redundant because the set stays the same: constraints left out one by one, the last in the order first.

Where leaving a constraint out gives freedom, it is needed. Where it gives none, the others must also imply what the
constraint says: the set may lose a component and keep its dimension.

How many equations are independent of all before them where relations are dependent at the reference only.

An equation is independent of others where it is no combination of them, with coefficients that are analytic near the
reference. Each is compared with those before it. A row that is no sum of rows before it at the reference belongs to an
independent equation. One that is such a sum is of a dependent equation where that vanishes on the manifold of the
independent ones before it [ImplicitFunctions]; the first that does not is independent, and no other is counted then. Of
several of one constraint all but one are dependent where they are satisfied, in numbers, at the points near the
reference where that one is: creases that meet in a point close up by one condition of the second order, which several
equations state. What was counted must agree with the freedom.
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
from dofkit.classification.dependence.implication import Everywhere, NearDrawing, is_drawn
from dofkit.classification.dependence.implied_constraints import LEAVING_SECONDS
from dofkit.classification.dependence.minimal_sets import SufficientSets, largest_redundant_set, minimal_set
from dofkit.classification.freedom.block import answer
from dofkit.classification.freedom.preparation import all_of
from dofkit.exact.matrices.sparse import components, echelon
from dofkit.relations.answer import BITS, GAP, Answer, Redundancies
from dofkit.relations.blocks import Block, Row, split
from dofkit.relations.setting import Setting


def by_removal(block: Block, setting: Setting, a: Answer, nullity: int, numbered: Sequence[int]) -> Redundancies:
    """Return what is redundant in a block of geometric equations whose rank does not tell, the last written first.

    ``nullity``: dependent rows by the freedom; ``numbered``: the equation each row belongs to.
    """
    owners = owners_of(block)
    order = list(dict.fromkeys(owners))
    removal = Removal(block, setting, a)
    with limited(LEAVING_SECONDS):
        largest = largest_redundant_set(reversed(order), removal.in_time)
        circuits = _circuits(removal, order, largest.members)
    nullity = max(nullity, sum(o in largest.members for o in owners))
    groups = [(nullity, sorted(order))] if largest.members else []
    undecided = tuple(largest.undecided)
    answer = Redundancies({}, largest.members, groups, circuits, undecided, claim=_claim(removal.verdict, a.about))
    count = counted(block, setting, a, numbered) if is_drawn(block, a, setting) else None
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
    """The constraint that wrote each row."""
    return [r.constraint for r in block.rows]


@dataclass
class Removal:
    """A block without some of its constraints; ``verdict``: that of the weakest argument so far."""

    block: Block
    setting: Setting
    whole: Answer
    verdict: Verdict = "probable"
    _answers: dict[tuple[frozenset[int], frozenset[int]], bool | None] = field(default_factory=dict)
    _dofs: dict[frozenset[int], int | None] = field(default_factory=dict)

    def is_redundant(self, owners: Collection[int], others: Collection[int] | None = None) -> bool | None:
        """Return whether the set near the reference is the same without some constraints; None: undecided.

        ``others``: the constraints that remain; without it all others of the block.
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
        """Return whether constraints are redundant; None where that is undecided or there is no time to tell."""
        return unless_late(partial(self.is_redundant, owners), None)

    def _dof(self, kept: frozenset[int]) -> int | None:
        """Return the freedom that some constraints leave."""
        if kept not in self._dofs:
            rows = [r for r in self.block.rows if r.constraint in kept]
            whole = len(rows) == len(self.block.rows)
            self._dofs[kept] = self.whole.dof if whole else freedom(self.block.coordinates, rows, self.setting)
        return self._dofs[kept]

    def _is_same_set(self, removed: frozenset[int], kept: frozenset[int]) -> bool | None:
        """Return whether what is removed is implied: always where only rigid motions of the system are left."""
        rows, others = (
            [i for i, r in enumerate(self.block.rows) if r.constraint in constraints] for constraints in (removed, kept)
        )
        if not is_drawn(self.block, self.whole, self.setting):
            return all_of(Everywhere(self.block, self.setting).follows(i, others) for i in rows)
        near = NearDrawing(self.block, self.setting)
        if near.is_orbit(others, self._dof(kept)) or near.imply(others, rows, self.whole):
            return True
        self.verdict = "numeric"
        return near.seem_to_imply(others, rows) or None


def freedom(coordinates: Sequence[str], rows: Sequence[Row], setting: Setting) -> int | None:
    """Return the freedom that some rows leave; None where it is undecided."""
    blocks, untouched = split(coordinates, rows)
    dofs = [answer(block, setting).dof for block in blocks]
    return None if None in dofs else len(untouched) + sum(dof for dof in dofs if dof is not None)


class EquationCount(NamedTuple):
    """Equations of each constraint that are independent of all before, those that are not, and groups.

    ``seen``: the constraints of whose equations some were seen in numbers to follow.
    """

    independent: dict[int, int]
    equations: dict[int, tuple[int, ...]]
    groups: list[tuple[int, list[int]]]
    seen: tuple[int, ...]


def counted(block: Block, setting: Setting, a: Answer, numbered: Sequence[int]) -> EquationCount | None:
    """The count for a block that was answered at the reference; ``numbered``: the equation that each row is of.

    None where it was not decided, or is not what the freedom says.
    """
    if a.dof is None or len(a.matrix) != len(block.rows):
        return None
    counting = _Counting(block, setting, a)
    supports = counting.supports()
    if supports is None or len(supports) != max(0, len(block.rows) - (len(block.coordinates) - a.dof)):
        return None
    owners = [r.constraint for r in block.rows]
    following = Counter(owners[i] for i in supports)
    circuits = [{owners[i], *(owners[j] for j in support)} for i, support in supports.items()]
    joined = [{o for k in numbers for o in circuits[k]} for numbers in components(circuits)]
    groups = [(sum(following[o] for o in c), sorted(c)) for c in joined]
    equations = {o: tuple(numbered[i] for i in supports if owners[i] == o) for o in owners}
    independent = {o: k - following[o] for o, k in Counter(owners).items()}
    return EquationCount(independent, equations, sorted(groups, key=lambda g: g[1]), tuple(counting.seen))


@dataclass
class _Counting:
    """What is implied by what, row by row; ``bent``: one is dependent at the reference only; ``seen``: as counted."""

    block: Block
    setting: Setting
    a: Answer
    seen: list[int] = field(default_factory=list)
    bent: bool = False
    following: dict[int, list[int]] = field(default_factory=dict)

    @cached_property
    def _near(self) -> NearDrawing:
        return NearDrawing(self.block, self.setting)

    @cached_property
    def _owners(self) -> list[int]:
        return [r.constraint for r in self.block.rows]

    @cached_property
    def _dependent(self) -> Mapping[int, Sequence[int]]:
        """Rows that are sums of rows before them at the reference, and of which."""
        return echelon(self.a.matrix, self.a.modulus, supports=True).supports

    def supports(self) -> dict[int, list[int]] | None:
        """For every row that those before it imply, rows that do; None where that is undecided.

        The rows of one constraint stand in no order: of those that say the same beside others any may be the first.
        """
        for owner, rows in groupby(sorted(self._dependent), key=self._owners.__getitem__):
            remaining = self._independent_rows(rows)
            if remaining is None or not self._by_one(owner, remaining):
                return None
        return self.following

    def _independent_rows(self, rows: Iterable[int]) -> list[int] | None:
        """Those of some dependent rows that follow from no independent ones; None where that is not known of one."""
        result = []
        for i in rows:
            check()
            pivots = [k for k in range(i) if k not in self._dependent]
            enough = SufficientSets(self._near, self._owners, pivots).enough(i, self._dependent[i])
            if enough is not None:
                self.following[i] = enough
            elif self._near.follows(i, pivots) is None:
                return None
            else:
                result.append(i)
        return result

    def _by_one(self, owner: int, rows: Sequence[int]) -> bool:
        """Return whether, in numbers, rows of a constraint hold where one of them and those before do.

        There may be such rows of one constraint only.
        """
        pivots = [k for k, o in enumerate(self._owners) if o <= owner and k not in self._dependent]
        for first in () if self.bent else rows:
            others = [i for i in rows if i != first]
            if not others or self._near.seem_to_imply([*pivots, first], others):
                self.bent = True
                self.following |= {i: [*pivots, first] for i in others}
                self.seen += [owner] if others else []
                return True
        return not rows
