"""Blocks all of whose relations are linear with rational coefficients: analysed, or confirmed, by exact elimination.

A q + r(t) = 0 and B dq + s(t) dt = 0, where r and s may contain parameters: a row that is a combination of others over
the rationals is implied by them if its right side is the same combination, and otherwise contradicts them. All forms
are closed, so that each is a consequence of a geometric equation, and n - rank coordinates are free everywhere.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from flint import fmpq

from dofkit.configuration.generic_dimension import BALL_COLUMNS
from dofkit.exact.matrices.rational import RationalRow, dependences
from dofkit.exact.matrices.sparse import SparseRow, echelon, last_columns, without_time
from dofkit.exact.points.field import prime_for
from dofkit.exact.zero import BOTH, certainly_nonzero, zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block
from dofkit.relations.normal.pieces import Finite, Pfaffian, Piece
from dofkit.relations.normal.semidefinite import fraction
from dofkit.relations.setting import Setting

METHOD = "exact elimination over the rationals"
CONTRADICTION = "the linear equations contradict each other"
OTHERWISE = "exact elimination over the rationals disagrees with points over GF(p)"
#: Functions that are analytic everywhere, so that they are 0 on an interval only if they are 0 always.
_ENTIRE = frozenset({"sin", "cos", "exp", "sinh", "cosh", "tanh", "atan"})


@dataclass(frozen=True)
class LinearElimination:
    """The ``rows`` of a block over its coordinates, after elimination.

    ``supports``: {dependent row: {row: factor} of which it is the sum}; ``contradictory``: the first dependent row with
    another right side.
    """

    rows: Sequence[RationalRow]
    supports: Mapping[int, RationalRow]
    contradictory: int | None = None

    @property
    def rank(self) -> int:
        """The number of independent rows."""
        return len(self.rows) - len(self.supports)


def elimination(block: Block, positive: frozenset[Expr]) -> LinearElimination | None:
    """Return the elimination of a block's rows, finite ones first; None if it is not linear or undecided."""
    finite = [isinstance(r.piece, Finite) for r in block.rows]
    order = [(not f, r.constraint) for f, r in zip(finite, block.rows, strict=True)]
    if block.nonlinear or block.conditions or order != sorted(order):
        return None
    place = {ex.coordinate(name): k for k, name in enumerate(block.coordinates)}
    split_rows = [p for r in block.rows if (p := _linear_row(r.piece, place)) is not None]
    if len(split_rows) < len(block.rows) or not all(_entire(function) for _, function in split_rows):
        return None
    rows, right_sides = [row for row, _ in split_rows], [function for _, function in split_rows]
    supports = dependences(rows)
    for i, factors in () if supports is None else supports.items():
        remainder = _right_side(right_sides, finite, {i: fmpq(-1), **factors})
        if not linear_terms(remainder) or zero_and_verdict(remainder, positive) == (True, "proved"):
            continue
        return LinearElimination(rows, supports or {}, i) if certainly_nonzero(remainder, positive) else None
    return None if supports is None else LinearElimination(rows, supports)


def _right_side(right_sides: Sequence[Expr], finite: Sequence[bool], factors: Mapping[int, fmpq]) -> Expr:
    """Return the right side of a sum of rows whose left side is 0; with forms, finite rows are differentiated."""
    rates = not all(finite[k] for k in factors)
    terms = ((v, diff(right_sides[k], ex.TIME) if rates and finite[k] else right_sides[k]) for k, v in factors.items())
    return ex.add(*(ex.mul(ex.num(fraction(v)), e) for v, e in terms if not e.is_zero))


def _linear_row(piece: Piece, place: Mapping[Expr, int]) -> tuple[RationalRow, Expr] | None:
    """Return (coefficients, right side); None if a coefficient is not rational or the right side has coordinates."""
    if isinstance(piece, Pfaffian):
        if any(a.op != "num" for a in piece.coefficients.values()) or _moving(piece.dt):
            return None
        return {place[ex.coordinate(n)]: _number(a.args[0]) for n, a in piece.coefficients.items()}, piece.dt
    if not isinstance(piece, Finite):
        return None
    row, function = RationalRow(), []
    for term in piece.expr.args if piece.expr.op == "add" else (piece.expr,):
        factor, symbol = ex.number_and_rest(term)
        k = place.get(symbol)
        if k is not None:
            row[k] = _number(factor)
        elif _moving(symbol):
            return None
        else:
            function.append(term)
    return row, ex.add(*function)


def _moving(e: Expr) -> bool:
    return any(s.args[0] not in ("time", "parameter") for s in e.symbols)


def _entire(e: Expr) -> bool:
    """Return whether ``e`` is real and analytic at all times: a polynomial in t or an entire function of it."""
    if e.op == "fn":
        return e.args[0] in _ENTIRE and _entire(e.args[1])
    if e.op != "pow":
        return e.op != "call" and all(map(_entire, ex.children(e)))
    base, exponent = e.args
    whole = exponent.op == "num" and exponent.args[0].denominator == 1
    if ex.TIME in e.symbols:
        return whole and exponent.args[0] > 0 and _entire(base)
    return (whole and _entire(base)) or (exponent.op == base.op == "num" and base.args[0] > 0)


def _number(value: Any) -> fmpq:
    return fmpq(value.numerator, value.denominator)


def eliminated(block: Block, setting: Setting) -> Answer | None:
    """Return the answer of a large block of linear geometric equations; None for others, which may be `confirmed`."""
    small = len(block.coordinates) <= BALL_COLUMNS or block.forms
    if small or setting.engines != BOTH or setting.tolerance is not None:
        return None
    reduced = elimination(block, setting.positive)
    if reduced is None:
        return None
    owners = [r.constraint for r in block.rows]
    if reduced.contradictory is not None:
        conflict = [owners[k] for k in (reduced.contradictory, *reduced.supports[reduced.contradictory])]
        minimal = tuple(sorted(conflict)) if max(Counter(owners).values()) == 1 else ()
        return Answer(False, argument="linear contradiction", reasons=[CONTRADICTION], conflict=minimal, method=METHOD)
    p, n = prime_for(), len(block.coordinates)
    matrix = _modulo(reduced.rows, p)
    if matrix is None:
        return None
    kept = [row for i, row in enumerate(matrix) if i not in reduced.supports]
    columns = last_columns(kept, n, p)
    if len(columns) != reduced.rank:
        return None
    supports = {i: tuple(sorted(f)) for i, f in reduced.supports.items()}
    return Answer(
        dof=n - reduced.rank,
        velocity_dof=n - reduced.rank,
        verdict="proved" if _same_dependence(reduced, matrix, p, single=False) else "probable",
        derived=(reduced.rank,),
        matrix=matrix,
        modulus=p,
        supports=lambda: supports,
        dependent=tuple(block.coordinates[c] for c in columns),
        method=METHOD,
        linear=True,
        argument="exact elimination",
    )


def _modulo(rows: Sequence[RationalRow], p: int) -> list[SparseRow] | None:
    """Return the rows over GF(p); None where p divides a numerator or a denominator."""
    if any(int(v.p) % p == 0 or int(v.q) % p == 0 for row in rows for v in row.values()):
        return None
    return [{c: int(v.p) * pow(int(v.q), -1, p) % p for c, v in row.items()} for row in rows]


# -- an answer from points --------------------------------------------------------------------------


def confirmed(block: Block, a: Answer, setting: Setting, single: bool) -> Answer:
    """Return a probable answer as proved if exact elimination agrees, as undecided if it disagrees.

    ``single``: every constraint of the block has one row only, in all blocks.
    """
    if a.consistent is None or setting.engines != BOTH or setting.tolerance is not None:
        return a
    reduced = elimination(block, setting.positive)
    if reduced is None:
        return a
    free = len(block.coordinates) - reduced.rank
    if a.consistent is not (reduced.contradictory is None) or (a.consistent and a.dof not in (None, free)):
        return Answer(None, verdict="undecided", reasons=[OTHERWISE], method=METHOD)
    if not a.consistent:
        return replace(a, verdict="proved", argument="linear contradiction", method=METHOD)
    if not _agrees(reduced, a, len(block.coordinates), single):
        return a
    labels = {i: replace(label, verdict="proved") for i, label in a.labels.items()}
    return replace(a, verdict="proved", labels=labels, method=METHOD, linear=True, argument="exact elimination")


def _agrees(reduced: LinearElimination, a: Answer, n: int, single: bool) -> bool:
    """Return whether an answer agrees with the elimination in freedom, labels, growth vector and dependences."""
    free = n - reduced.rank
    numbers = {a.dof, a.velocity_dof, *(() if a.instantaneous is None else (a.instantaneous,))}
    grown = a.growth is None or len(set(a.growth)) == 1
    derived = a.derived is None or set(a.derived) == {reduced.rank}
    holonomic = all(label.holonomic for label in a.labels.values())
    if numbers != {free} or not (grown and derived and holonomic) or a.hidden or a.degenerate:
        return False
    matrix = without_time(a.matrix, n)
    same = len(a.dependent) == reduced.rank and matrix == _modulo(reduced.rows, a.modulus)
    return same and _same_dependence(reduced, matrix, a.modulus, single)


def _same_dependence(reduced: LinearElimination, matrix: Sequence[SparseRow], p: int, single: bool) -> bool:
    """Return whether the rows depend on each other modulo p as they do over the rationals.

    The same rows must be sums of the same rows before them. If constraints have several rows (not ``single``), other
    sets of rows are used as well: then no minor of dependent rows may be a nonzero multiple of p, because all minors
    are smaller [Hadamard1893], or are 0 or +-1 as those of a graph [Kirchhoff1847].
    """
    modular = echelon(matrix, p, supports=True).supports
    if {i: tuple(sorted(f)) for i, f in reduced.supports.items()} != modular:
        return False
    core = sorted({k for i, f in reduced.supports.items() for k in (i, *f)})
    if single or not core:
        return True
    rows = [_primitive(reduced.rows[i]) for i in core]
    small = math.prod(max(1, sum(v * v for v in row)) for row in rows) < p * p
    return small or all(sorted(row) in ([-1], [1], [-1, 1]) for row in rows)


def _primitive(row: RationalRow) -> list[int]:
    """Return the entries, multiplied by a common factor, as integers without a common divisor."""
    scale = math.lcm(*(int(v.q) for v in row.values()))
    integers = [int(v * scale) for v in row.values()]
    common = math.gcd(*integers)
    return [v // common for v in integers]
