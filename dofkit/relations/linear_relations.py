"""Linear relations with rational coefficients, solved exactly: what is found is proved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_mat

from dofkit.exact.points.frames import pivots
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

#: Entries of a matrix that is looked at; past that the relations are taken as they are.
MAX_ENTRIES = 4_000_000

Terms = dict[Expr, Fraction]


def linear(e: Expr) -> Terms | None:
    """``e`` as a sum of numbers times symbols (`ONE` for the constant); None where it is not one."""
    terms: Terms = {}
    for term in e.args if e.op == "add" else (e,):
        factor, remainder = ex.number_and_rest(term)
        if remainder.op != "sym" and remainder != ex.ONE:
            return None
        terms[remainder] = terms.get(remainder, Fraction(0)) + factor
    return terms


@dataclass(frozen=True)
class Presolved:
    """``reduced``: the linear relations in echelon form; ``superfluous`` numbers of those that earlier ones imply.

    ``contradiction``: no values of the unknowns satisfy them, for generic parameters.
    """

    reduced: tuple[Expr, ...]
    linear: frozenset[int]
    superfluous: frozenset[int]
    contradiction: bool


def presolve(relations: Sequence[Expr]) -> Presolved:
    """The linear relations among some, solved exactly over the rationals: what is found is proved.

    Coordinates and time are unknowns; parameters are generic constants, so x = a with x = b is a contradiction.
    Unknowns that occur in linear relations only are solved for first.
    """
    result = {i: t for i, e in enumerate(relations) if (t := linear(e)) is not None}
    elsewhere = frozenset().union(*(e.symbols for i, e in enumerate(relations) if i not in result))
    symbols = sorted({s for t in result.values() for s in t}, key=lambda s: (_place(s), s in elsewhere, repr(s)))
    if len(result) < 2 or len(result) * len(symbols) > MAX_ENTRIES:
        return Presolved((), frozenset(), frozenset(), False)
    rows = [[fmpq(*t.get(s, Fraction(0)).as_integer_ratio()) for s in symbols] for t in result.values()]
    reduced, rank = fmpq_mat(rows).rref()
    unknown = sum(_place(s) < 2 for s in symbols)
    leading = [next(c for c in range(len(symbols)) if reduced[r, c] != 0) for r in range(rank)]
    kept = pivots(fmpq_mat([list(column) for column in zip(*rows, strict=True)]))
    numbers = list(result)
    superfluous = frozenset(numbers) - {numbers[c] for c in kept}
    echelon = tuple(_expression(reduced, r, symbols) for r in range(rank))
    return Presolved(echelon, frozenset(numbers), superfluous, any(c >= unknown for c in leading))


def _place(symbol: Expr) -> int:
    """Coordinates, then time, then parameters and numbers."""
    if symbol.op != "sym":
        return 2
    return {"coordinate": 0, "time": 1}.get(symbol.args[0], 2)


def _expression(matrix: fmpq_mat, r: int, symbols: Sequence[Expr]) -> Expr:
    entries = ((s, matrix[r, c]) for c, s in enumerate(symbols) if matrix[r, c] != 0)
    return ex.add(*(ex.mul(ex.num(Fraction(int(v.p), int(v.q))), s) for s, v in entries))
