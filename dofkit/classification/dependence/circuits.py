"""Which constraints depend on which: redundant ones, groups, circuits, by rank over GF(p).

A row is a scalar equation's differential at a generic point; finite rows come before differential ones,
because only a geometric equation fixes the constant. Dependent sets of constraints are those whose rows are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from dofkit.base.deadline import check
from dofkit.base.verdicts import Claim, together
from dofkit.classification.dependence.implication import Everywhere, NearDrawing
from dofkit.classification.dependence.minimal_sets import SufficientSets, largest_redundant_set, minimal_set
from dofkit.exact.matrices.sparse import SparseRow, Supports, components, echelon, rank_of_rows, transposed, vanishing
from dofkit.relations.answer import BITS, Redundancies

#: Sets of constraints are searched exhaustively up to this many members of a group.
SEARCHED = 12
#: Rows that depend on each other at points over GF(p).
ROWS = Claim("probable", "rows at a point", bits=BITS)
#: Up to this many are removed one after the other; then so many are given back, one at a time.
REMOVED, EXCHANGES = 60, 200


@dataclass(frozen=True)
class OwnedRows:
    """The matrix of a block, without zeros: ``owners[i]`` wrote row i, ``finite[i]`` tells a finite row.

    ``equations[i]`` is the number of the scalar equation that row i is of; -1 where it is not known.
    ``supports``: what each row depends on, of those before it, where something else than the matrix tells it.
    ``implication`` tells what rows say of each other; without it what is dependent is taken to follow; ``claim``: of
    what depends on what.
    """

    matrix: Sequence[SparseRow]
    owners: Sequence[int]
    finite: Sequence[bool]
    p: int
    equations: Sequence[int] = ()
    supports: Supports | None = None
    implication: NearDrawing | Everywhere | None = None
    claim: Claim = ROWS

    def of(self, owners: frozenset[int] | set[int], finite_only: bool = False) -> list[SparseRow]:
        """The rows that some constraints wrote."""
        return [
            row
            for row, owner, finite in zip(self.matrix, self.owners, self.finite, strict=True)
            if owner in owners and (finite or not finite_only)
        ]


def analyse(matrices: Sequence[OwnedRows], needed: Collection[int] = ()) -> Redundancies:
    """Redundant constraints, groups and circuits of blocks that share constraints; the ``needed`` are not redundant."""
    order = _order(matrices)
    bases = [_Basis(part) for part in matrices]
    kept = Counter(b.owners[i] for b in bases for i in b.pivots)
    independent = {owner: kept[owner] for owner in order}
    if not any(b.supports for b in bases):
        return Redundancies(independent, equations=dict.fromkeys(order, ()))
    groups = _groups(bases)
    redundant: list[int] = []
    for _, members in groups:
        redundant += _droppable(matrices, [o for o in order if o in members and o not in needed], bases)
    open_ = set[int]().union(*(b.open for b in bases))
    decided = [owner for owner in redundant if owner not in open_]
    circuits = {owner: _circuit(matrices, order, owner, bases) for owner in decided}
    uncounted = tuple(sorted(set[int]().union(*(b.uncounted for b in bases))))
    equations = {o: e for o, e in _equations(matrices, bases).items() if o not in uncounted}
    claim = together(*(part.claim for part, basis in zip(matrices, bases, strict=True) if basis.supports))
    return Redundancies(
        independent, sorted(redundant), groups, circuits, equations=equations, uncounted=uncounted, claim=claim
    )


def _equations(matrices: Sequence[OwnedRows], bases: Sequence[_Basis]) -> dict[int, tuple[int, ...]]:
    """The scalar equations all of whose rows follow from those before them, a constraint each."""
    follows_of: dict[int, dict[int, bool]] = {}
    for part, basis in zip(matrices, bases, strict=True):
        for i, (owner, equation) in enumerate(zip(part.owners, part.equations, strict=False)):
            of_owner = follows_of.setdefault(owner, {})
            of_owner[equation] = of_owner.get(equation, True) and i in basis.supports
    return {
        owner: tuple(sorted(e for e, follows in result.items() if follows))
        for owner, result in follows_of.items()
        if -1 not in result
    }


class _Basis:
    """The first independent rows, finite ones before differential ones, and the others in terms of them."""

    def __init__(self, rows: OwnedRows) -> None:
        self._rows = rows
        self.owners = rows.owners
        basis = self._by_elimination(rows) if rows.supports is None else self._from_supports(rows, rows.supports)
        self.pivots, self.supports = basis
        #: Constraints of which it is not known what they follow from, or how many equations from those before.
        self.open: set[int] = set()
        self.uncounted: set[int] = set()
        self.implication = rows.implication
        if rows.implication is not None:
            self._enlarge(SufficientSets(rows.implication, rows.owners, self.pivots), rows.finite)
        self.pivot_owners = {self.owners[i] for i in self.pivots}
        self.circuits: dict[int, set[int]] = {}
        for i, support in self.supports.items():
            self.circuits.setdefault(self.owners[i], set()).update(self.owners[j] for j in support)

    def _enlarge(self, sets: SufficientSets, finite: Sequence[bool]) -> None:
        """Every support made large enough to imply its row.

        Where it takes what was written later, the row does not follow from those before it, but maybe a later one does.
        """
        for i, support in self.supports.items():
            result = sets.enough(i, support)
            if result is None:
                self.open.add(self.owners[i])
            else:
                self.supports[i] = result
                later = {o for k in result if (o := self.owners[k]) > self.owners[i] and finite[k] == finite[i]}
                self.uncounted |= {self.owners[i], *later} if later else set()

    def implies(self, kept: set[int], owner: int) -> bool:
        """Return whether the rows of some constraints imply those of another one that depend on others."""
        answer = self.implication
        if answer is None:
            return True
        others = self._first_rows(kept)
        return all(answer.follows(i, others) for i in self.supports if self.owners[i] == owner)

    def _first_rows(self, kept: set[int]) -> list[int]:
        """The first independent rows of some constraints: also those that are no pivots with those of others."""
        if self._rows.supports is not None:
            return [i for i in self.pivots if self.owners[i] in kept]
        numbers = [i for i in _by_kind(self._rows) if self.owners[i] in kept]
        return [numbers[k] for k in echelon([self._rows.matrix[i] for i in numbers], self._rows.p).independent]

    @staticmethod
    def _from_supports(rows: OwnedRows, tell: Supports) -> tuple[list[int], dict[int, list[int]]]:
        supports = {i: list(support) for i, support in tell().items()}
        return [i for i in range(len(rows.owners)) if i not in supports], supports

    @staticmethod
    def _by_elimination(rows: OwnedRows) -> tuple[list[int], dict[int, list[int]]]:
        numbers = _by_kind(rows)
        result = echelon([rows.matrix[i] for i in numbers], rows.p, supports=True)
        pivots = [numbers[k] for k in result.independent]
        return pivots, {numbers[k]: [numbers[j] for j in support] for k, support in result.supports.items()}


def _by_kind(rows: OwnedRows) -> list[int]:
    """The rows by their numbers, finite ones before differential ones, and as written."""
    return sorted(range(len(rows.matrix)), key=lambda i: (not rows.finite[i], rows.owners[i], i))


def _order(matrices: Sequence[OwnedRows]) -> list[int]:
    """Constraints whose rows are all finite first, each part as written."""
    owners = sorted({o for part in matrices for o in part.owners})
    differential = {o for part in matrices for o, f in zip(part.owners, part.finite, strict=True) if not f}
    return [o for o in owners if o not in differential] + [o for o in owners if o in differential]


def _groups(bases: Sequence[_Basis]) -> list[tuple[int, list[int]]]:
    """Constraints joined by circuits of rows."""
    circuits = [{b.owners[i], *(b.owners[j] for j in support)} for b in bases for i, support in b.supports.items()]
    extra = Counter(b.owners[i] for b in bases for i in b.supports)
    groups = []
    for numbers in components(circuits):
        members = {o for k in numbers for o in circuits[k]}
        groups.append((sum(extra[o] for o in members), sorted(members)))
    return sorted(groups, key=lambda group: group[1])


def _spans(matrices: Sequence[OwnedRows], kept: set[int], everything: set[int]) -> bool:
    """Return whether the kept constraints imply the others, finite ones by finite ones: a rate fixes no constant."""
    return all(
        rank_of_rows(part.of(kept, only), part.p) == rank_of_rows(part.of(everything, only), part.p)
        for part in matrices
        for only in (False, True)
    )


def _droppable(matrices: Sequence[OwnedRows], members: list[int], bases: Sequence[_Basis]) -> list[int]:
    """As many constraints of a group as can go together; of several choices the last in the order.

    Modulo 2 stands only which rows depend on which (balls tell no more): then those that add nothing to those before.
    """
    unweighted = any(p.p == 2 for p in matrices) and len(members) > SEARCHED
    rows_of = Counter(o for p in matrices for o in p.owners)
    if unweighted or len(members) > REMOVED or all(rows_of[o] == 1 for o in members):
        kept_of = set().union(*(b.pivot_owners for b in bases))
        return [o for o in members if o not in kept_of]
    within = _Dispensable(matrices, members)
    if len(members) > SEARCHED:
        return _exchanged(within, members, rows_of)
    return largest_redundant_set(reversed(members), within.can_go).members


def _exchanged(within: _Dispensable, members: Sequence[int], rows_of: Mapping[int, int]) -> list[int]:
    """Return what can go of many constraints: the last or the smallest first, then one is given back where two can go.

    Constraints of several equations are no matroid: no constraint can be added to the answer, but another answer may
    be larger.
    """
    small_first = sorted(members, key=lambda o: (rows_of[o], -members.index(o)))
    dropped = max((within.greedy(order, []) for order in (list(reversed(members)), small_first)), key=len)
    back = iter(dropped)
    for _ in range(EXCHANGES):
        check()
        if (owner := next(back, None)) is None:
            break
        larger = within.greedy([o for o in small_first if o != owner], [o for o in dropped if o != owner])
        if len(larger) > len(dropped):
            dropped, back = larger, iter(larger)
    return dropped


class _Dispensable:
    """Which of some constraints can go together.

    Rows can go without loss of rank where they are independent in the dual matroid, whose matrix is that of the sums
    of rows that are 0 [Whitney1935]: as many rows at most as there are such sums, however many rows there are.
    """

    def __init__(self, matrices: Sequence[OwnedRows], members: Sequence[int]) -> None:
        self._tables: list[tuple[dict[int, list[SparseRow]], int, int]] = []
        everything = set(members)
        for part in matrices:
            rows = [i for i, owner in enumerate(part.owners) if owner in everything]
            finite = [i for i in rows if part.finite[i]]
            for numbers in (rows,) if len(finite) == len(rows) else (rows, finite):
                sums = vanishing([part.matrix[i] for i in numbers], part.p)
                of: dict[int, list[SparseRow]] = {}
                for i, column in zip(numbers, transposed(sums, len(numbers)), strict=True):
                    of.setdefault(part.owners[i], []).append(column)
                self._tables.append((of, len(sums), part.p))

    def can_go(self, owners: Sequence[int]) -> bool:
        """Return whether the others imply these, finite ones by finite ones only: a rate does not fix a constant."""
        for of, most, p in self._tables:
            rows = [row for owner in owners for row in of.get(owner, ())]
            if len(rows) > most or rank_of_rows(rows, p) < len(rows):
                return False
        return True

    def greedy(self, order: Iterable[int], gone: Sequence[int]) -> list[int]:
        """Return what can go besides ``gone``, one after the other."""
        dropped = list(gone)
        for owner in order:
            if owner not in dropped and self.can_go([*dropped, owner]):
                dropped.append(owner)
        return dropped


def _circuit(matrices: Sequence[OwnedRows], order: list[int], owner: int, bases: Sequence[_Basis]) -> list[int]:
    """A minimal set of other constraints on which a redundant one depends, of those before it where that can be."""
    if not any(owner in b.pivot_owners for b in bases):
        supports = set().union(*(b.circuits.get(owner, set()) for b in bases)) - {owner}
        if len(supports) < 2 or len(supports) > SEARCHED:
            return sorted(supports)
        kept = [o for o in order if o in supports]
    else:
        kept = [o for o in order if o != owner]

    def implies(fewer: Collection[int]) -> bool:
        return _spans(matrices, {*fewer}, {*fewer, owner}) and all(b.implies({*fewer}, owner) for b in bases)

    return sorted(minimal_set(kept, implies))
