"""Candidate loci, as equations, on which the rank of a block's rows, or of the curvature on their kernel, is smaller.

Rows are the differentials of the geometric equations and the Pfaffian forms, each times its denominators. Rows with
a coefficient that never vanishes are eliminated first: the rank drops where that of the other rows does. The other rows
are then eliminated with pivots that may vanish, and the curvature d(omega)(u, v) of every form on every two vectors of
the kernel is a polynomial as well. The loci are the common zeros of the largest minors of these two matrices.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, combinations
from math import comb
from typing import NamedTuple

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.exact.ring.canonical import Canon, Poly, cleared, determinant, is_identically_zero, lowest_terms
from dofkit.exact.ring.program import TooLargeError, raising_no_value
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, exterior_derivative, replace_nodes, substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block
from dofkit.relations.linear_relations import explicit_relations, number_coefficients
from dofkit.relations.normal.pieces import Finite, Pfaffian
from dofkit.relations.normal.semidefinite import Signs, sum_of_even
from dofkit.relations.normal.zero_set import zero_set
from dofkit.relations.setting import Setting

#: Bounds on the number and size of minors, and on the terms of entries: for minors from 3 x 3 on, and for smaller ones.
MAX_MINORS, MAX_SIZE, MAX_TERMS, MAX_SHORT = 20, 4, 12, 60
#: Bound on the steps of the search for common zeros, and on the terms of a readable equation.
MAX_STEPS, MAX_READ = 120, 4
#: Bounds on the terms of the shortest and of the longest minor.
MAX_FACTORED, MAX_LONG = 48, 160
#: Bound on the terms of a polynomial whose terms' signs are compared.
MAX_EVEN = 12


@dataclass(frozen=True)
class Locus:
    """Expressions that vanish together, whatever the parameters."""

    equations: tuple[Expr, ...] = ()

    @cached_property
    def explicit(self) -> dict[Expr, Expr]:
        """{coordinate: value} for the coordinates for which the equations are solved."""
        return explicit_relations(self.equations, number_coefficients).by_others

    @cached_property
    def others(self) -> tuple[Expr, ...]:
        """The equations that are not solved for a coordinate."""
        return tuple(e for e in (substitute(e, self.explicit) for e in self.equations) if not is_identically_zero(e))

    def on(self, e: Expr) -> Expr:
        """Return an expression after substituting the solved coordinates, and 0 for functions that are equations."""
        return replace_nodes(substitute(e, self.explicit), {g: ex.ZERO for g in self.others if g.op == "fn"})

    @property
    def is_short(self) -> bool:
        """Whether all equations are readable, and at most two are not solved for a coordinate."""
        terms = (len(e.args) if e.op == "add" else 1 for e in (*self.explicit.values(), *self.others))
        return len(self.others) < 3 and max(terms, default=0) <= MAX_READ

    @property
    def is_of_coordinates(self) -> bool:
        """Whether every equation contains a coordinate, and no unknown function."""
        return all(
            "call" not in e.functions and any(s.args[0] == "coordinate" for s in e.symbols) for e in self.equations
        )


@dataclass(frozen=True)
class CommonZeros:
    """Real zeros in some ``variables``; other symbols are generic constants, and ``positive`` ones are > 0."""

    variables: frozenset[Expr]
    positive: frozenset[Expr]

    def branches(self, e: Expr) -> tuple[tuple[Expr, ...], ...]:
        """Return the branches of the real zeros of an expression, each as expressions that vanish together."""
        return zero_set(e, self.positive, self.variables)[0]

    def holds_on(self, locus: Locus, e: Expr) -> bool:
        """Return whether an expression is shown to vanish on a locus."""
        return any({*locus.equations} >= {*branch} for branch in self.branches(locus.on(e)))

    def within(self, locus: Locus, larger: Locus) -> bool:
        """Return whether one locus is shown to lie in another."""
        return all(self.holds_on(locus, e) for e in larger.equations)

    def loci(self, expressions: Sequence[Expr]) -> list[Locus]:
        """Return the readable loci on which all expressions vanish; raises TooLargeError after `MAX_STEPS` steps."""
        pending, loci = [(Locus(), [*expressions])], list[Locus]()
        for _ in range(MAX_STEPS):
            check()
            if not pending:
                kept = [
                    a for a in loci if a.is_of_coordinates and not any({*a.equations} > {*b.equations} for b in loci)
                ]
                return list(dict.fromkeys(kept))
            locus, remaining = pending.pop()
            if not remaining:
                loci.append(locus)
                continue
            first, *others = sorted(map(locus.on, remaining), key=ex.size)
            branches = self.branches(first)
            if any({*locus.equations} >= {*branch} for branch in branches):
                pending.append((locus, others))
                continue
            narrower = (Locus(tuple(dict.fromkeys((*locus.equations, *branch)))) for branch in reversed(branches))
            pending += [(narrow, others) for narrow in narrower if narrow.is_short]
        raise TooLargeError


class RowPolynomials:
    """The rows of a block, without nonlinear ones, as polynomials, eliminated with pivots that never vanish.

    Columns belong to ``symbols``. ``pivots``: (row, column), all other rows having 0 in that column; ``relations``: the
    geometric equations. Raises NoValueError.
    """

    def __init__(self, block: Block, hidden: Sequence[Expr], setting: Setting) -> None:
        self.relations = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + list(hidden)
        forms = [dict(r.piece.items()) for r in block.forms if isinstance(r.piece, Pfaffian)]
        mentioned = frozenset(chain.from_iterable(e.symbols for form in forms for e in (*form, *form.values())))
        timed = ex.TIME in mentioned.union(*(g.symbols for g in self.relations))
        self.symbols = tuple(ex.coordinate(c) for c in block.coordinates) + ((ex.TIME,) if timed else ())
        self.zeros = CommonZeros(frozenset(self.symbols), setting.positive)
        gradients = [[diff(g, s) for s in self.symbols] for g in self.relations]
        rows = [*gradients, *([form.get(s, ex.ZERO) for s in self.symbols] for form in forms)]
        curls = [exterior_derivative({s: form.get(s, ex.ZERO) for s in self.symbols}) for form in forms]
        ring = Ring([*chain(*rows), *chain(*(curl.values() for curl in curls))], setting.positive)
        nodes = {e: ring.node(e) for e in chain(*rows, *(curl.values() for curl in curls))}
        self.canon = Canon(ring)
        self.moving = {i for i, e in enumerate(ring.var_expr) if not self.zeros.variables.isdisjoint(e.symbols)}
        self.rows = [self._cleared(row, nodes) for row in rows]
        self._curls, self._nodes = curls, nodes
        self.pivots: list[tuple[int, int]] = []
        while (pivot := self._pivot()) is not None:
            self._eliminate(*pivot)
            self.pivots.append(pivot)

    @cached_property
    def signs(self) -> Signs:
        """The signs of the ring's generators."""
        return Signs(self.canon, self.zeros.positive)

    def _cleared(self, row: Sequence[Expr], nodes: Mapping[Expr, int]) -> list[Poly]:
        quotients = (self.canon.quotient(nodes[e]) for e in row)
        return cleared(self.canon, [lowest_terms(*q) for q in quotients])[0]

    def _pivot(self) -> tuple[int, int] | None:
        """Return (row, column) of a coefficient that never vanishes, preferably a number; None if there is none."""
        possible = self._possible_pivots()
        numbers = ((r, c) for r, c in possible if self.rows[r][c].is_constant())
        never = ((r, c) for r, c in possible if self._never_vanishes(self.rows[r][c]))
        return next(chain(numbers, never), None)

    def _possible_pivots(self) -> list[tuple[int, int]]:
        """Return (row, column) of the nonzero coefficients of coordinates in rows and columns without a pivot."""
        done, columns = {r for r, _ in self.pivots}, {c for _, c in self.pivots}
        coordinates = [c for c, s in enumerate(self.symbols) if s != ex.TIME and c not in columns]
        return [(r, c) for r, row in enumerate(self.rows) if r not in done for c in coordinates if row[c] != 0]

    def _never_vanishes(self, poly: Poly) -> bool:
        """Return whether a polynomial is a generic constant, or a sum of terms of one sign, one of them never 0."""
        if self.moving.isdisjoint(self.canon.generators_in(poly)):
            return True
        even = sum_of_even(poly, self.signs) if len(poly) <= MAX_EVEN else None
        return even is not None and any(not zeros for zeros in even)

    def can_vanish_together(self, polynomials: Sequence[Poly]) -> bool:
        """Return False if the sum of the squares shows that there is no common real zero; True: not known."""
        short = all(len(poly) <= MAX_EVEN for poly in polynomials)
        return not short or not self._never_vanishes(self.canon.reduce(sum(p * p for p in polynomials)))

    def _eliminate(self, r: int, c: int) -> None:
        """Make the column c zero in all rows but r; raises TooLargeError if their polynomials have too many terms."""
        check()
        pivot = self.rows[r]
        for k, row in enumerate(self.rows):
            if k != r and row[c] != 0:
                if max(map(len, row)) > MAX_SHORT:
                    raise TooLargeError
                pairs = zip(row, pivot, strict=True)
                self.rows[k] = [self.canon.reduce(pivot[c] * a - row[c] * b) for a, b in pairs]

    def _eliminate_rest(self) -> None:
        """Eliminate the other rows with pivots that may vanish; raises TooLargeError."""
        while (place := next(iter(self._possible_pivots()), None)) is not None:
            self._eliminate(*place)
            self.pivots.append(place)

    @property
    def free(self) -> list[int]:
        """The columns without a pivot."""
        return [c for c in range(len(self.symbols)) if c not in {column for _, column in self.pivots}]

    def other_rows(self) -> list[list[Poly]]:
        """Return the rows without a pivot, in the free columns of coordinates."""
        done = {r for r, _ in self.pivots}
        columns = [c for c in self.free if self.symbols[c] != ex.TIME]
        return [[row[c] for c in columns] for r, row in enumerate(self.rows) if r not in done]

    def curvature(self) -> list[list[Poly]]:
        """Return the non-zero rows d(omega)(u, v), omega a form, for all pairs of the vectors of `_kernel_vector`."""
        self._eliminate_rest()
        result = []
        vectors = [self._kernel_vector(column) for column in self.free]
        for curl in self._curls:
            values, coefficients = [], self._cleared([*curl.values()], self._nodes)
            for u, v in combinations(vectors, 2) if curl else ():
                check()
                total = self.canon.unit * 0
                for (i, j), coefficient in zip(curl, coefficients, strict=True):
                    if max(map(len, (*u, *v))) * len(coefficient) > MAX_SHORT:
                        raise TooLargeError
                    total = total + coefficient * (u[i] * v[j] - u[j] * v[i])
                values.append(self.canon.reduce(total))
            result.append(values)
        return [row for row in result if any(entry != 0 for entry in row)]

    def _kernel_vector(self, column: int) -> list[Poly]:
        """Return the kernel vector of a free column, times all pivots."""
        vector = [self.canon.unit * 0 for _ in self.symbols]
        vector[column] = self.canon.unit
        for r, c in self.pivots:
            vector[column] = vector[column] * self.rows[r][c]
        for r, c in self.pivots:
            vector[c] = self.canon.reduce(-self.rows[r][column] * (vector[column] / self.rows[r][c]))
        return vector


class Candidates(NamedTuple):
    """Loci on which the rank of the rows (``ranks``), or of the curvature (``bends``), may be smaller.

    ``regular``: no pivot vanishes anywhere, so that the curvature is right on all loci; ``zeros`` compares loci.
    """

    ranks: list[Locus]
    bends: list[Locus]
    regular: bool
    zeros: CommonZeros
    relations: Sequence[Expr]


def candidates(block: Block, hidden: Sequence[Expr], setting: Setting, rank: int, curvature: int) -> Candidates:
    """Return the candidates; none if the minors are too large. Raises NoValueError.

    ``rank``: of the rows in the columns of the coordinates; ``curvature``: the number of independent directions that
    [D, D] adds to D at a generic point, 0 if all forms are integrable.
    """
    rows = raising_no_value(RowPolynomials)(block, hidden, setting)
    size = rank - len(rows.pivots)
    ranks = _loci(rows, rows.other_rows, size) if size > 0 else []
    bends = _loci(rows, rows.curvature, curvature) if curvature else []
    return Candidates(ranks, bends, size == 0, rows.zeros, rows.relations)


def _loci(rows: RowPolynomials, matrix: Callable[[], list[list[Poly]]], size: int) -> list[Locus]:
    """Return the readable loci on which all minors of a size vanish; none if these are too large.

    On each a factor of the shortest minor vanishes, so that there is none if these factors are long.
    """
    try:
        minors = raising_no_value(lambda: list(_minors(rows.canon, matrix(), size)))()
        shortest = min(minors, key=len, default=None)
        if shortest is None or len(shortest) > MAX_FACTORED or max(map(len, minors)) > MAX_LONG:
            return []
        if not rows.can_vanish_together(minors):
            return []
        if all(len(factor) > MAX_READ for factor, _ in rows.canon.factors(shortest)):
            return []
        return rows.zeros.loci([rows.canon.to_expr(minor) for minor in minors])
    except NoValueError:
        return []


def _minors(canon: Canon, matrix: list[list[Poly]], size: int) -> Iterator[Poly]:
    """Yield the minors of a size that are not identically 0; raises TooLargeError."""
    columns = range(len(matrix[0]) if matrix else 0)
    longest = max((len(entry) for row in matrix for entry in row), default=0)
    if comb(len(matrix), size) * comb(len(columns), size) > MAX_MINORS or size > MAX_SIZE:
        raise TooLargeError
    if longest > (MAX_SHORT if size < 3 else MAX_TERMS):
        raise TooLargeError
    for some in combinations(matrix, size):
        for chosen in combinations(columns, size):
            check()
            minor = determinant(canon, [[row[c] for c in chosen] for row in some])
            if minor != 0:
                yield minor
