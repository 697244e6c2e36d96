"""Where a block's answer may change: common zeros of minors and of curvature, and zeros of denominators."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import combinations
from math import comb

from dofkit.classification.special.common_zeros import MAX_READ, Leaf, common_zeros
from dofkit.classification.special.minors import MAX_MINORS, EliminatedTable, MinorTable, curvatures
from dofkit.exact.errors import NoValueError, raising_no_value
from dofkit.exact.ring.canonical import Poly, determinant
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr


@dataclass
class Candidates:
    """``ranks`` and ``bends``: conditions on coordinates under which all largest minors, all curvature, vanish.

    ``values``: conditions on parameters alone.
    """

    ranks: list[Leaf] = field(default_factory=list)
    bends: list[Leaf] = field(default_factory=list)
    values: list[Leaf] = field(default_factory=list)

    @property
    def empty(self) -> bool:
        return not (self.ranks or self.bends or self.values)


def candidates(table: MinorTable, rank: int, curvature: int, curved: bool) -> Candidates:
    """All that are found; ``rank`` of the rows in the coordinates' columns.

    ``curvature``: the number of independent directions that [D, D] adds to D at a generic point, 0 where not known.
    Where nothing is ``curved`` and there are no parameters, curvature has nothing to tell.
    """
    search = CandidateSearch(table)
    reduction = EliminatedTable(table)
    size = rank - len(reduction.solved)
    search.attempt(lambda: search.minors(reduction, size))
    tells = curved or table.reals.parameters
    if tells:
        search.attempt(lambda: search.curvature(reduction, size, curvature))
    for polys in table.clocks:
        search.attempt(partial(search.values_of, polys))
    search.merge()
    return search.found


def _simple(leaf: Leaf) -> bool:
    """Conditions that a person can read."""
    return all(len(p) <= MAX_READ for p in (*leaf.others, *(v for _, v in leaf.solved)))


class CandidateSearch:
    """The search for candidates in one table; what is too large finds nothing."""

    def __init__(self, table: MinorTable) -> None:
        self.table, self.reals = table, table.reals
        self.found = Candidates()

    def attempt(self, work: Callable[[], None]) -> None:
        """Do it; what is too large finds nothing."""
        try:
            raising_no_value(work)()
        except NoValueError:
            return

    def minors(self, reduction: EliminatedTable, size: int) -> None:
        if size < 1:
            return
        minors = [m for m in reduction.minors(size) if m != 0]
        self.values_of(minors)
        self.found.ranks += self.places(minors)

    def curvature(self, reduction: EliminatedTable, size: int, independent: int) -> None:
        """Where all of it vanishes, for which parameters that of one form does, and where less of it is independent."""
        if size < 0 or not any(self.table.curls):
            return
        matrix = curvatures(self.table, reduction.kernel(size))
        every = [c for row in matrix for c in row if c != 0]
        self.found.bends += self.places(every)
        for row in matrix if len(matrix) > 1 else ():
            self.values_of(row)
        self.values_of(every)
        bent = [row for row in matrix if any(c != 0 for c in row)]
        if independent > 1 and comb(len(bent), independent) * comb(len(bent[0]), independent) <= MAX_MINORS:
            self.found.bends += self.places(self._minors_of(bent, independent))

    def _minors_of(self, matrix: list[list[Poly]], size: int) -> list[Poly]:
        columns = range(len(matrix[0]))
        picked = [(r, c) for r in combinations(matrix, size) for c in combinations(columns, size)]
        return [determinant(self.table.canon, [[row[i] for i in c] for row in r]) for r, c in picked]

    # -- conditions -------------------------------------------------------------------------------

    def values_of(self, polys: Iterable[Poly]) -> None:
        """Conditions on the parameters under which polynomials vanish everywhere."""
        left = [p for p in polys if p != 0]
        if not left or not self.reals.parameters:
            return
        if any(len(p) == 1 and self.reals.never_zero_factor(p) for p in left):
            return
        coefficients: list[Poly] = []
        for poly in left:
            coefficients += self.reals.coefficients(poly)
            if any(self.reals.never_zero(c) for c in coefficients):
                return
        self._add_values(common_zeros(self.reals, coefficients))

    def _add_values(self, leaves: Iterable[Leaf]) -> None:
        self.found.values += [leaf for leaf in leaves if leaf != Leaf() and leaf not in self.found.values]

    def places(self, polys: Iterable[Poly]) -> list[Leaf]:
        """Conditions on coordinates under which polynomials vanish and the finite relations can hold.

        Where they can hold for some values of the parameters only, those are kept instead.
        """
        left = [p for p in polys if p != 0]
        kept = []
        for leaf in common_zeros(self.reals, left, short=True) if left else ():
            conditions = leaf.conditions(self.table.canon)
            needed = [] if any(map(self._instant, conditions)) else self._needed(leaf)
            own = [c for c in conditions if self.reals.of_parameters(c)]
            if own or (needed and [] not in needed):
                for more in needed:
                    self._add_values(common_zeros(self.reals, [*own, *more]))
            elif needed and _simple(leaf) and self._of_coordinates(conditions) and self._defined(leaf):
                kept.append(leaf)
        return kept

    def _needed(self, leaf: Leaf) -> list[list[Poly]]:
        """What the finite relations need of the parameters on a leaf, in every way that they can hold for a while."""
        relations = [self.reals.on(leaf, g) for g in self.table.relations]
        if any(self.reals.never_zero(g) for g in relations):
            return []
        try:
            ways = common_zeros(self.reals, relations)
        except NoValueError:
            return [[]]
        conditions = [way.conditions(self.table.canon) for way in ways]
        return [
            [c for c in way if self.reals.of_parameters(c)] for way in conditions if not any(map(self._instant, way))
        ]

    def _instant(self, poly: Poly) -> bool:
        """A condition on time alone."""
        symbols = self._symbols([poly])
        return ex.TIME in symbols and all(s.args[0] in ("time", "parameter") for s in symbols)

    def _symbols(self, conditions: Iterable[Poly]) -> frozenset[Expr]:
        canon = self.table.canon
        present = {i for poly in conditions for i in canon.generators_in(poly)}
        return frozenset[Expr]().union(*(canon.ring.var_expr[i].symbols for i in present))

    def _defined(self, leaf: Leaf) -> bool:
        """Do the rows' denominators not vanish on a leaf?"""
        below = [self.reals.on(leaf, p) for p in self.table.below]
        return all(p != 0 and not any(divmod(p, c)[1] == 0 for c in leaf.others) for p in below)

    def merge(self) -> None:
        """sin u = 1 and sin u = -1 are one condition: cos u = 0."""
        canon = self.table.canon
        for var in canon.ring.vars:
            ends = [Leaf(((var.index, canon.one * sign),)) for sign in (1, -1)]
            if var.kind in ("cos", "sin") and all(end in self.found.values for end in ends):
                kept = [leaf for leaf in self.found.values if leaf not in ends]
                self.found.values = [*kept, Leaf(((var.partner, canon.one * 0),))]

    def _of_coordinates(self, conditions: Sequence[Poly]) -> bool:
        """Do coordinates occur, and no unknown functions?"""
        canon = self.table.canon
        present = {i for poly in conditions for i in canon.generators_in(poly)}
        known = all(canon.ring.vars[i].kind != "call" for i in present)
        return known and any(s.args[0] == "coordinate" for s in self._symbols(conditions))
