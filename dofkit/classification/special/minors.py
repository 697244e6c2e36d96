"""A block's rows as polynomials: candidates for where their rank drops, or curvature on their kernel vanishes.

Rows are the differentials of the finite relations and the Pfaffian forms, each times its denominators. Rows with
a coefficient that never vanishes are eliminated first: the rank drops where that of the rest does. The kernel is
spanned by Cramer's vectors, so the curvature d(omega)(u, v) of every form on every two of them is a polynomial too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, combinations
from math import comb
from typing import NamedTuple

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.classification.special.common_zeros import MAX_READ, Leaf, Reals, common_zeros
from dofkit.exact.ring.canonical import Canon, Poly, Quotient, cleared, determinant, lowest_terms
from dofkit.exact.ring.program import TooLargeError, raising_no_value
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block
from dofkit.relations.normal.pieces import Finite, Pfaffian
from dofkit.relations.setting import Setting

#: Minors, and vectors of the kernel, of which there may be so many; their size.
MAX_MINORS, MAX_VECTORS, MAX_SIZE = 20, 8, 4
#: Entries of larger minors have at most so many terms, those of minors up to 2 x 2 so many.
MAX_TERMS, MAX_SHORT = 12, 60


@dataclass(frozen=True)
class MinorTable:
    """``relations`` are the finite relations; ``rows`` over ``symbols`` (coordinates, then time where it enters).

    The first rows are the relations' differentials. ``curls_of`` returns d(omega) of every form;
    ``below`` has every row's denominator, as written.
    """

    canon: Canon
    reals: Reals
    symbols: tuple[Expr, ...]
    relations: list[Poly]
    rows: list[list[Poly]]
    curls_of: Callable[[], list[dict[tuple[int, int], Poly]]]
    below: list[Poly]

    @cached_property
    def curls(self) -> list[dict[tuple[int, int], Poly]]:
        """The coefficients of d(omega) by pairs of columns, of every form. Raises NoValueError."""
        return [{pair: p for pair, p in curl.items() if p != 0} for curl in self.curls_of()]

    @property
    def n(self) -> int:
        """The number of coordinates."""
        return sum(s != ex.TIME for s in self.symbols)


@raising_no_value
def table_of(block: Block, hidden: Sequence[Expr], setting: Setting, nonzero: frozenset[Expr]) -> MinorTable:
    """Return the polynomials of a block without nonlinear rows. Raises TooLargeError."""
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + list(hidden)
    forms = [dict(r.piece.items()) for r in block.forms if isinstance(r.piece, Pfaffian)]
    timed = any(ex.TIME in form or any(ex.TIME in e.symbols for e in form.values()) for form in forms)
    timed = timed or any(ex.TIME in g.symbols for g in finite)
    symbols = tuple(ex.coordinate(c) for c in block.coordinates) + ((ex.TIME,) if timed else ())
    rows = [[diff(g, s) for s in symbols] for g in finite] + [[form.get(s, ex.ZERO) for s in symbols] for form in forms]
    curls = [_curl(form, symbols) for form in forms]
    everything = [*finite, *chain(*rows), *chain(*(curl.values() for curl in curls))]
    ring = Ring(everything, setting.positive)
    nodes = {e: ring.node(e) for e in everything}
    canon = Canon(ring)

    def cleared_row(row: Iterable[Expr]) -> tuple[list[Poly], Poly]:
        return cleared(canon, [in_lowest_terms(canon.quotient(nodes[e])) for e in row])

    clear = [cleared_row(row) for row in rows]
    return MinorTable(
        canon,
        Reals(canon, setting.positive, nonzero),
        symbols,
        [canon.quotient(nodes[g])[0] for g in finite],
        [tops for tops, _ in clear],
        lambda: [dict(zip(curl, cleared_row(curl.values())[0], strict=True)) for curl in curls],
        [whole for _, whole in clear],
    )


def in_lowest_terms(quotient: Quotient) -> Quotient:
    """Return a quotient without common factors, its denominator 1 where it is a number."""
    top, bottom = quotient if quotient[1].is_constant() else lowest_terms(*quotient)
    return (top / bottom.leading_coefficient(), bottom**0) if bottom.is_constant() else (top, bottom)


def _curl(form: Mapping[Expr, Expr], symbols: Sequence[Expr]) -> dict[tuple[int, int], Expr]:
    """Return d(omega): the coefficient of dq_i ^ dq_j for i < j, where it is not written as 0."""
    pairs = combinations(range(len(symbols)), 2)
    a = [form.get(s, ex.ZERO) for s in symbols]
    curl = {(i, j): diff(a[j], symbols[i]) - diff(a[i], symbols[j]) for i, j in pairs}
    return {pair: e for pair, e in curl.items() if not e.is_zero}


class EliminatedTable:
    """The rows after elimination with pivots that never vanish.

    ``solved``: (pivot column, row) with the pivot 1 and 0 in the other pivot columns, up to the factors in
    ``scales``; ``remaining_rows``: what is left of the other rows, over the ``free`` columns.
    """

    def __init__(self, table: MinorTable) -> None:
        self.table, self.canon = table, table.canon
        work = [row[:] for row in table.rows]
        self.solved: list[tuple[int, int]] = []
        while (pivot := self._pivot(work)) is not None:
            check()
            r, c = pivot
            entry = work[r][c]
            for other in range(len(work)):
                if other != r and work[other][c] != 0:
                    if max(map(len, work[other])) > MAX_SHORT:
                        raise TooLargeError
                    work[other] = self._combined(work[other], work[r], c, entry)
            self.solved.append(pivot)
        self.work = work
        done, columns = {r for r, _ in self.solved}, {c for _, c in self.solved}
        self.free = [c for c in range(len(table.symbols)) if c not in columns]
        self.remaining_rows = [r for r in range(len(work)) if r not in done]

    def _pivot(self, work: list[list[Poly]]) -> tuple[int, int] | None:
        """(row, coordinate column) of a coefficient that never vanishes; a number where there is one."""
        done, columns = {r for r, _ in self.solved}, {c for _, c in self.solved}
        places = [(r, c) for r in range(len(work)) if r not in done for c in range(self.table.n) if c not in columns]
        entries = [(r, c) for r, c in places if work[r][c] != 0]
        constant = next(((r, c) for r, c in entries if work[r][c].is_constant()), None)
        if constant is not None:
            return constant
        return next(((r, c) for r, c in entries if self.table.reals.never_zero(work[r][c])), None)

    def _combined(self, row: list[Poly], pivot: list[Poly], c: int, entry: Poly) -> list[Poly]:
        factor = row[c]
        if entry.is_constant():
            factor = factor / entry.leading_coefficient()
            return [self.canon.reduce(a - factor * b) if b != 0 else a for a, b in zip(row, pivot, strict=True)]
        return [self.canon.reduce(entry * a - factor * b) for a, b in zip(row, pivot, strict=True)]

    def minors(self, size: int) -> list[Poly]:
        """All minors of a size of what is left, in the coordinates' columns. Raises TooLargeError."""
        columns = [c for c in self.free if c < self.table.n]
        if comb(len(columns), size) * comb(len(self.remaining_rows), size) > MAX_MINORS:
            raise TooLargeError
        return [self._minor(r, c) for r in combinations(self.remaining_rows, size) for c in combinations(columns, size)]

    def _minor(self, rows: Sequence[int], columns: Sequence[int]) -> Poly:
        check()
        longest = max(len(self.work[r][c]) for r in rows for c in columns)
        if len(rows) > MAX_SIZE or longest > (MAX_SHORT if len(rows) < 3 else MAX_TERMS):
            raise TooLargeError
        return determinant(self.canon, [[self.work[r][c] for c in columns] for r in rows])

    def kernel(self, size: int) -> list[list[Poly]]:
        """Vectors that span the kernel wherever the rank is not smaller (Cramer). Raises TooLargeError."""
        if comb(len(self.free), size + 1) * comb(len(self.remaining_rows), size) > MAX_VECTORS:
            raise TooLargeError
        zero, result = self.canon.unit * 0, []
        for rows in combinations(self.remaining_rows, size):
            for columns in combinations(self.free, size + 1):
                vector = [zero] * len(self.table.symbols)
                for k, c in enumerate(columns):
                    others = [d for d in columns if d != c]
                    value = self._minor(rows, others) if size else self.canon.unit
                    vector[c] = value if k % 2 == 0 else -value
                result.append(self._lifted(vector))
        return result

    def _lifted(self, vector: list[Poly]) -> list[Poly]:
        """With the pivots' components, all times the pivots that are no numbers."""
        below: Poly = self.canon.unit
        for r, c in self.solved:
            if not self.work[r][c].is_constant():
                below = below * self.work[r][c]
        lifted = [below * v if v != 0 else v for v in vector]
        for r, c in self.solved:
            total = self.canon.unit * 0
            for f in self.free:
                if vector[f] != 0 and self.work[r][f] != 0:
                    total = total - self.work[r][f] * lifted[f]
            pivot = self.work[r][c]
            lifted[c] = self.canon.reduce(total / pivot.leading_coefficient() if pivot.is_constant() else total / pivot)
        return lifted


def curvatures(table: MinorTable, vectors: Sequence[Sequence[Poly]]) -> list[list[Poly]]:
    """Of every form d(omega)(u, v) for all pairs of vectors; no pairs where it is closed."""
    canon, result = table.canon, []
    for curl in table.curls:
        values = []
        for u, v in combinations(vectors, 2) if curl else ():
            check()
            total = canon.unit * 0
            for (i, j), coefficient in curl.items():
                if max(map(len, (*u, *v))) * len(coefficient) > MAX_SHORT:
                    raise TooLargeError
                area = u[i] * v[j] - u[j] * v[i]
                if area != 0:
                    total = total + coefficient * area
            values.append(canon.reduce(total))
        result.append(values)
    return result


# candidates


class Candidates(NamedTuple):
    """Conditions on coordinates under which all largest minors vanish, and all curvature or a minor of it."""

    ranks: list[Leaf]
    bends: list[Leaf]


def candidates(table: MinorTable, rank: int, curvature: int, curved: bool) -> Candidates:
    """Return the candidates; ``rank``: of the rows in the columns of the coordinates.

    ``curvature``: the number of independent directions that [D, D] adds to D at a generic point, 0 where not known.
    Where nothing is ``curved`` curvature has nothing to tell. What is too large has no candidates.
    """
    reduction = EliminatedTable(table)
    size = rank - len(reduction.solved)
    ranks = _attempt(lambda: _loci(table, reduction.minors(size) if size > 0 else ()))
    bends = _attempt(lambda: _bends(table, reduction, size, curvature)) if curved and size >= 0 else []
    return Candidates(ranks, bends)


def _attempt(search: Callable[[], Iterable[Leaf]]) -> list[Leaf]:
    try:
        return raising_no_value(lambda: list(search()))()
    except NoValueError:
        return []


def _bends(table: MinorTable, reduction: EliminatedTable, size: int, independent: int) -> Iterator[Leaf]:
    """Yield the loci on which all curvature vanishes, and those on which less of it is independent."""
    if not any(table.curls):
        return
    matrix = curvatures(table, reduction.kernel(size))
    yield from _loci(table, [c for row in matrix for c in row])
    bent = [row for row in matrix if any(c != 0 for c in row)]
    if independent > 1 and comb(len(bent), independent) * comb(len(bent[0]), independent) <= MAX_MINORS:
        columns = range(len(bent[0]))
        picked = [(r, c) for r in combinations(bent, independent) for c in combinations(columns, independent)]
        yield from _loci(table, [determinant(table.canon, [[row[i] for i in c] for row in r]) for r, c in picked])


def _loci(table: MinorTable, polynomials: Iterable[Poly]) -> Iterator[Leaf]:
    """Yield conditions on coordinates under which polynomials vanish and the finite relations can hold for a while."""
    present = [p for p in polynomials if p != 0]
    for leaf in common_zeros(table.reals, present, short=True) if present else ():
        conditions = leaf.conditions(table.canon)
        short = all(len(p) <= MAX_READ for p in (*leaf.others, *(v for _, v in leaf.solved)))
        alone = any(_is_instant(table, c) or table.reals.of_parameters(c) for c in conditions)
        if not short or alone or not _is_of_coordinates(table, conditions) or not _is_defined(table, leaf):
            continue
        if _can_hold(table, leaf):
            yield leaf


def _can_hold(table: MinorTable, leaf: Leaf) -> bool:
    """Return whether the finite relations may hold on a leaf for an interval of time and all parameters."""
    relations = [table.reals.on(leaf, g) for g in table.relations]
    if any(table.reals.never_zero(g) for g in relations):
        return False
    try:
        ways = [way.conditions(table.canon) for way in common_zeros(table.reals, relations)]
    except NoValueError:
        return True
    return any(not any(_is_instant(table, c) or table.reals.of_parameters(c) for c in way) for way in ways)


def _is_instant(table: MinorTable, condition: Poly) -> bool:
    """Return whether a condition is one on time alone."""
    symbols = _symbols(table, [condition])
    return ex.TIME in symbols and all(s.args[0] in ("time", "parameter") for s in symbols)


def _symbols(table: MinorTable, conditions: Iterable[Poly]) -> frozenset[Expr]:
    present = {i for poly in conditions for i in table.canon.generators_in(poly)}
    return frozenset[Expr]().union(*(table.canon.ring.var_expr[i].symbols for i in present))


def _is_defined(table: MinorTable, leaf: Leaf) -> bool:
    """Return whether the denominators of the rows do not vanish on a leaf."""
    below = [table.reals.on(leaf, p) for p in table.below]
    return all(p != 0 and not any(divmod(p, c)[1] == 0 for c in leaf.others) for p in below)


def _is_of_coordinates(table: MinorTable, conditions: Sequence[Poly]) -> bool:
    """Return whether coordinates occur, and no unknown functions."""
    kinds = {table.canon.ring.vars[i].kind for poly in conditions for i in table.canon.generators_in(poly)}
    return "call" not in kinds and any(s.args[0] == "coordinate" for s in _symbols(table, conditions))
