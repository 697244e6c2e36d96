"""Linear relations among the finite ones: which are superfluous, and whether they contradict each other."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from flint import fmpq, fmpq_mat

from dofkit import expr as ex
from dofkit.expr import Expr

#: Entries of a matrix that is looked at; past that the relations are taken as they are.
MAX_ENTRIES = 4_000_000

Terms = dict[Expr, Fraction]


def linear(e: Expr) -> Terms | None:
    """``e`` as a sum of numbers times symbols (`ONE` for the constant); None where it is not one."""
    terms: Terms = {}
    for term in e.args if e.op == "add" else (e,):
        factor, rest = Fraction(1), term
        if term.op == "num":
            factor, rest = term.args[0], ex.ONE
        elif term.op == "mul" and len(term.args) == 2 and term.args[0].op == "num":
            factor, rest = term.args[0].args[0], term.args[1]
        if rest.op != "sym" and rest != ex.ONE:
            return None
        terms[rest] = terms.get(rest, Fraction(0)) + factor
    return terms


def presolve(relations: Sequence[Expr]) -> tuple[set[int], bool]:
    """(numbers of linear relations that earlier ones imply, do the linear ones contradict each other?).

    Coordinates and time are unknowns; parameters are generic constants, so x = a with x = b is a contradiction.
    Exact elimination over the rationals: a proof.
    """
    found = {i: t for i, e in enumerate(relations) if (t := linear(e)) is not None}
    if len(found) < 2:
        return set(), False
    symbols = sorted({s for t in found.values() for s in t}, key=repr)
    unknown = [s for s in symbols if s.op == "sym" and s.args[0] in ("coordinate", "time")]
    ordered = unknown + [s for s in symbols if s not in set(unknown)]
    if len(found) * len(ordered) > MAX_ENTRIES:
        return set(), False
    table = [[_fmpq(t.get(s, Fraction(0))) for t in found.values()] for s in ordered]
    pivots = _pivots(fmpq_mat(table))
    numbers = list(found)
    kept = {numbers[c] for c in pivots}
    free = len(_pivots(fmpq_mat(table[: len(unknown)]))) if unknown else 0
    return set(numbers) - kept, free < len(pivots)


def _fmpq(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)


def _pivots(matrix: fmpq_mat) -> list[int]:
    reduced, rank = matrix.rref()
    found, column = [], 0
    for r in range(rank):
        while reduced[r, column] == 0:
            column += 1
        found.append(column)
        column += 1
    return found
