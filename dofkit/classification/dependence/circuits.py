"""Which constraints depend on which: redundant ones, groups, circuits, by rank over GF(p).

A row is the differential of a scalar equation at a generic point. Finite rows come before differential ones, because
only a geometric equation fixes the constant. A set of constraints is dependent if their rows are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import accumulate, combinations

from dofkit.base.deadline import check, limited, unless_late
from dofkit.base.verdicts import Claim, together
from dofkit.classification.dependence.implication import Everywhere
from dofkit.classification.dependence.minimal_sets import (
    RedundantSet,
    SufficientSets,
    largest_redundant_set,
    minimal_set,
)
from dofkit.classification.dependence.near_reference import NearReference
from dofkit.exact.matrices.sparse import SparseRow, Supports, components, echelon, rank_of_rows, transposed, vanishing
from dofkit.relations.answer import BITS, Redundancies, undecided_dependence

#: Groups of up to so many constraints are searched exhaustively.
SEARCHED = 12
#: The claim of dependences of rows at points over GF(p).
ROWS = Claim("probable", "rows at a point", bits=BITS)
#: Bound on the members of a group for the greedy search, and on the seconds for larger sets.
REMOVED, SECONDS = 60, 5.0


@dataclass(frozen=True)
class OwnedRows:
    """The matrix of a block: row i belongs to the constraint ``owners[i]``, and is one of a geometric equation if
    ``finite[i]``, namely of its scalar equation ``equations[i]`` (-1 if not known).

    ``supports`` computes, for each dependent row, the rows before it on which it depends, if this is not by the matrix.
    ``implication`` tests implications; without it a dependent row counts as implied. ``claim``: of the dependences.
    ``by_removal`` answers if several freedoms are removed by one row.
    """

    matrix: Sequence[SparseRow]
    owners: Sequence[int]
    finite: Sequence[bool]
    p: int
    equations: Sequence[int] = ()
    supports: Supports | None = None
    implication: NearReference | Everywhere | None = None
    claim: Claim = ROWS
    by_removal: Callable[[], Redundancies] | None = None

    def of(self, owners: frozenset[int] | set[int], finite_only: bool = False) -> list[SparseRow]:
        """Return the rows of some constraints."""
        return [
            row
            for row, owner, finite in zip(self.matrix, self.owners, self.finite, strict=True)
            if owner in owners and (finite or not finite_only)
        ]


def analyse(matrices: Sequence[OwnedRows], needed: Collection[int] = ()) -> Redundancies:
    """Return the redundancies in blocks that share constraints; those in ``needed`` are not redundant."""
    order = _order(matrices)
    bases = [_Basis(part) for part in matrices]
    if any(b.several for b in bases):
        by_removal = matrices[0].by_removal if len(matrices) == 1 else None
        return undecided_dependence(order) if by_removal is None else by_removal()
    kept = Counter(b.owners[i] for b in bases for i in b.pivots)
    independent = {owner: kept[owner] for owner in order}
    if not any(b.supports for b in bases):
        return Redundancies(independent, equations=dict.fromkeys(order, ()))
    groups = _groups(bases)
    redundant, perhaps = list[int](), list[int]()
    for _, members in groups:
        largest = _largest_redundant(matrices, [o for o in order if o in members and o not in needed], bases)
        redundant += largest.members
        perhaps += largest.undecided
    undecided = set[int]().union(*(b.undecided for b in bases))
    decided = [owner for owner in redundant if owner not in undecided]
    circuits = {owner: _circuit(matrices, order, owner, bases) for owner in decided}
    uncounted = tuple(sorted(set[int]().union(*(b.uncounted for b in bases))))
    equations = {o: e for o, e in _equations(matrices, bases).items() if o not in uncounted}
    claim = together(*(part.claim for part, basis in zip(matrices, bases, strict=True) if basis.supports))
    return Redundancies(
        independent, sorted(redundant), groups, circuits, tuple(perhaps), equations, uncounted, claim=claim
    )


def _equations(matrices: Sequence[OwnedRows], bases: Sequence[_Basis]) -> dict[int, tuple[int, ...]]:
    """Return {constraint: its scalar equations all of whose rows depend on rows before them}."""
    is_dependent: dict[int, dict[int, bool]] = {}
    for part, basis in zip(matrices, bases, strict=True):
        for i, (owner, equation) in enumerate(zip(part.owners, part.equations, strict=False)):
            of_owner = is_dependent.setdefault(owner, {})
            of_owner[equation] = of_owner.get(equation, True) and i in basis.supports
    return {
        owner: tuple(sorted(e for e, dependent in result.items() if dependent))
        for owner, result in is_dependent.items()
        if -1 not in result
    }


class _Basis:
    """``pivots``: the first independent rows, finite ones first; ``supports``: for the others, those they depend on."""

    def __init__(self, rows: OwnedRows) -> None:
        self._rows = rows
        self.owners = rows.owners
        basis = self._by_elimination(rows) if rows.supports is None else self._from_supports(rows, rows.supports)
        self.pivots, self.supports = basis
        #: Constraints for which it is undecided what implies them, or how many of their equations earlier ones imply.
        self.undecided: set[int] = set()
        self.uncounted: set[int] = set()
        #: Whether fewer constraints, each of one row, than the rank may imply all of them.
        self.several = False
        self.implication = rows.implication
        if rows.implication is not None:
            self._enlarge(SufficientSets(rows.implication, rows.owners, self.pivots), rows.finite)
        self.pivot_owners = {self.owners[i] for i in self.pivots}
        self.circuits: dict[int, set[int]] = {}
        for i, support in self.supports.items():
            self.circuits.setdefault(self.owners[i], set()).update(self.owners[j] for j in support)

    def _enlarge(self, sets: SufficientSets, finite: Sequence[bool]) -> None:
        """Enlarge every support until it implies its row.

        If this needs rows of a later constraint, neither constraint is counted: the other row may be the implied one,
        unless this row is a differential of geometric equations.
        """
        rows_of = Counter(self.owners)
        for i, support in self.supports.items():
            result = sets.enough(i, support)
            if result is None:
                self.undecided.add(self.owners[i])
            else:
                single = result != support and all(rows_of[self.owners[k]] == 1 for k in (i, *support))
                self.several |= single and sets.implication.removes_several(i, support)
                alike = [k for k in result if finite[k] == finite[i] or result != support]
                later = {o for k in alike if (o := self.owners[k]) > self.owners[i]}
                self.uncounted |= {self.owners[i], *later} if later else set()
                self.several |= bool(later) and self._rows.by_removal is not None
                self.supports[i] = result

    def implies(self, kept: set[int], owner: int) -> bool:
        """Return whether the rows of the constraints ``kept`` imply the dependent rows of ``owner``."""
        implication = self.implication
        if implication is None:
            return True
        others = self._first_rows(kept)
        return all(implication.follows(i, others) for i in self.supports if self.owners[i] == owner)

    def _first_rows(self, kept: set[int]) -> list[int]:
        """Return the first independent rows of the constraints ``kept``; some may not be pivots of the block."""
        if self._rows.supports is not None:
            return [i for i in self.pivots if self.owners[i] in kept]
        numbers = [i for i in _by_kind(self._rows) if self.owners[i] in kept]
        return [numbers[k] for k in echelon([self._rows.matrix[i] for i in numbers], self._rows.p).independent]

    @staticmethod
    def _from_supports(rows: OwnedRows, tell: Supports) -> tuple[list[int], dict[int, list[int]]]:
        """Return (independent rows, supports of the others) by the function that computes the supports."""
        supports = {i: list(support) for i, support in tell().items()}
        return [i for i in range(len(rows.owners)) if i not in supports], supports

    @staticmethod
    def _by_elimination(rows: OwnedRows) -> tuple[list[int], dict[int, list[int]]]:
        """Return (independent rows, supports of the others) by elimination, finite rows first."""
        numbers = _by_kind(rows)
        result = echelon([rows.matrix[i] for i in numbers], rows.p, supports=True)
        pivots = [numbers[k] for k in result.independent]
        return pivots, {numbers[k]: [numbers[j] for j in support] for k, support in result.supports.items()}


def _by_kind(rows: OwnedRows) -> list[int]:
    """Return the numbers of the rows, finite ones first, in the order of their constraints."""
    return sorted(range(len(rows.matrix)), key=lambda i: (not rows.finite[i], rows.owners[i], i))


def _order(matrices: Sequence[OwnedRows]) -> list[int]:
    """Return the constraints in order, those whose rows are all finite before the others."""
    owners = sorted({o for part in matrices for o in part.owners})
    differential = {o for part in matrices for o, f in zip(part.owners, part.finite, strict=True) if not f}
    return [o for o in owners if o not in differential] + [o for o in owners if o in differential]


def _groups(bases: Sequence[_Basis]) -> list[tuple[int, list[int]]]:
    """Return (nullity, members) for the sets of constraints that are connected by circuits of rows."""
    circuits = [{b.owners[i], *(b.owners[j] for j in support)} for b in bases for i, support in b.supports.items()]
    extra = Counter(b.owners[i] for b in bases for i in b.supports)
    groups = []
    for numbers in components(circuits):
        members = {o for k in numbers for o in circuits[k]}
        groups.append((sum(extra[o] for o in members), sorted(members)))
    return sorted(groups, key=lambda group: group[1])


def _spans(matrices: Sequence[OwnedRows], kept: set[int], everything: set[int]) -> bool:
    """Return whether the rows of ``kept`` span those of ``everything``, and the finite ones the finite ones."""
    return all(
        rank_of_rows(part.of(kept, only), part.p) == rank_of_rows(part.of(everything, only), part.p)
        for part in matrices
        for only in (False, True)
    )


def _largest_redundant(matrices: Sequence[OwnedRows], members: list[int], bases: Sequence[_Basis]) -> RedundantSet:
    """Return a largest redundant set among ``members``, of several the last in the order.

    For single rows, in large groups, and for dependency patterns modulo 2 (from balls), it is the set of constraints
    all of whose rows depend on rows before them. If there may be a larger set, all ``members`` are undecided.
    """
    rows_of = Counter(o for p in matrices for o in p.owners)
    single = all(rows_of[o] == 1 for o in members)
    if single or len(members) > REMOVED or any(p.p == 2 for p in matrices):
        kept_of = set().union(*(b.pivot_owners for b in bases))
        redundant = [o for o in members if o not in kept_of]
        complete = single or len(redundant) == _most_redundant(bases, {*members})
        return RedundantSet(redundant, [] if complete else members)
    dual = _DualMatroid(matrices, members)
    if len(members) <= SEARCHED:
        return largest_redundant_set(reversed(members), dual.are_redundant)
    small_first = sorted(members, key=lambda o: (rows_of[o], -members.index(o)))
    redundant = max((dual.greedy(order) for order in (reversed(members), small_first)), key=len)
    alone = [o for o in small_first if dual.are_redundant([o])]
    with limited(SECONDS):
        while len(redundant) < _most_redundant(bases, members):
            larger = filter(dual.are_redundant, combinations(alone, len(redundant) + 1))
            result = unless_late(partial(next, larger, None), ())
            if not result:
                return RedundantSet(redundant, [] if result is None else members)
            redundant = list(result)
    return RedundantSet(redundant, [])


def _most_redundant(bases: Sequence[_Basis], members: Collection[int]) -> int:
    """Return a bound on the members that can be redundant together: they have no more rows than depend on others."""
    fewest = len(members)
    for b in bases:
        rows_of = Counter(o for o in b.owners if o in members)
        within = sum(k <= len(b.supports) for k in accumulate(sorted(rows_of.values())))
        fewest = min(fewest, len(members) - len(rows_of) + within)
    return fewest


class _DualMatroid:
    """The dual matroid of the rows of some constraints, represented by the matrix of their linear dependences.

    Rows can be removed without loss of rank if they are independent in it [Whitney1935]; it has as many rows as there
    are dependences, however many rows there are.
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

    def are_redundant(self, owners: Sequence[int]) -> bool:
        """Return whether the rows of the others span those of ``owners``, and the finite ones the finite ones."""
        check()
        for of, most, p in self._tables:
            rows = [row for owner in owners for row in of.get(owner, ())]
            if len(rows) > most or rank_of_rows(rows, p) < len(rows):
                return False
        return True

    def greedy(self, order: Iterable[int]) -> list[int]:
        """Return the redundant set to which constraints are added, in ``order``, with which it stays redundant."""
        redundant = list[int]()
        for owner in order:
            if self.are_redundant([*redundant, owner]):
                redundant.append(owner)
        return redundant


def _circuit(matrices: Sequence[OwnedRows], order: list[int], owner: int, bases: Sequence[_Basis]) -> list[int]:
    """Return a minimal set of other constraints that imply a redundant one, of those before it if possible."""
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
