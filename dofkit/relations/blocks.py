"""Model no more than a scene needs: relations that share no coordinate are answered apart."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NamedTuple

from flint import fmpq, fmpq_mat

from dofkit.base.libraries import components
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.renaming import coordinates_in
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.normal_form import linear_form
from dofkit.relations.normal.pieces import Clause, Finite, JointEquation, Nonlinear, Pfaffian
from dofkit.relations.setting import Reductions

#: Entries of a matrix that is looked at; past that the relations are taken as they are.
MAX_ENTRIES = 4_000_000

Terms = dict[Expr, Fraction]


def linear(e: Expr) -> Terms | None:
    """``e`` as a sum of numbers times symbols (`ONE` for the constant); None where it is not one."""
    terms: Terms = {}
    for term in e.args if e.op == "add" else (e,):
        factor, remainder = Fraction(1), term
        if term.op == "num":
            factor, remainder = term.args[0], ex.ONE
        elif term.op == "mul" and len(term.args) == 2 and term.args[0].op == "num":
            factor, remainder = term.args[0].args[0], term.args[1]
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
    if len(result) < 2:
        return Presolved((), frozenset(), frozenset(), False)
    elsewhere = frozenset().union(*(e.symbols for i, e in enumerate(relations) if i not in result))
    symbols = sorted({s for t in result.values() for s in t}, key=lambda s: (_place(s), s in elsewhere, repr(s)))
    if len(result) * len(symbols) > MAX_ENTRIES:
        return Presolved((), frozenset(), frozenset(), False)
    rows = [[_fmpq(t.get(s, Fraction(0))) for s in symbols] for t in result.values()]
    reduced, rank = fmpq_mat(rows).rref()
    unknown = sum(_place(s) < 2 for s in symbols)
    pivots = [next(c for c in range(len(symbols)) if reduced[r, c] != 0) for r in range(rank)]
    kept = _pivots(fmpq_mat([list(column) for column in zip(*rows, strict=True)]))
    numbers = list(result)
    superfluous = frozenset(numbers) - {numbers[c] for c in kept}
    echelon = tuple(_expression(reduced, r, symbols) for r in range(rank))
    return Presolved(echelon, frozenset(numbers), superfluous, any(c >= unknown for c in pivots))


def _place(symbol: Expr) -> int:
    """Coordinates, then time, then parameters and numbers."""
    if symbol.op != "sym":
        return 2
    return {"coordinate": 0, "time": 1}.get(symbol.args[0], 2)


def _expression(matrix: fmpq_mat, r: int, symbols: Sequence[Expr]) -> Expr:
    entries = ((s, matrix[r, c]) for c, s in enumerate(symbols) if matrix[r, c] != 0)
    return ex.add(*(ex.mul(ex.num(Fraction(int(v.p), int(v.q))), s) for s, v in entries))


def _fmpq(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)


def _pivots(matrix: fmpq_mat) -> list[int]:
    reduced, rank = matrix.rref()
    result, column = [], 0
    for r in range(rank):
        while reduced[r, column] == 0:
            column += 1
        result.append(column)
        column += 1
    return result


class Row(NamedTuple):
    """One scalar equation after reduction, or a condition: which constraint wrote it, and what it says."""

    constraint: int
    piece: Finite | Pfaffian | Nonlinear | DomainCondition


@dataclass(frozen=True)
class Block:
    """Coordinates that belong together, and the rows on them (finite ones first, then as written).

    ``conditions``: where the rows say what they say.
    """

    coordinates: tuple[str, ...]
    rows: tuple[Row, ...]
    conditions: tuple[DomainCondition, ...] = ()

    @property
    def finite(self) -> tuple[Row, ...]:
        return tuple(r for r in self.rows if isinstance(r.piece, Finite))

    @property
    def forms(self) -> tuple[Row, ...]:
        return tuple(r for r in self.rows if isinstance(r.piece, Pfaffian))

    @property
    def nonlinear(self) -> tuple[Row, ...]:
        return tuple(r for r in self.rows if isinstance(r.piece, Nonlinear))


def coordinates_of(piece: Clause) -> frozenset[str]:
    """Every coordinate a piece mentions, in coefficients, velocities and differentials too; of a joint all of them."""
    if isinstance(piece, JointEquation):
        return piece.joint.mentioned
    if isinstance(piece, Pfaffian):
        return frozenset(piece.coefficients).union(*map(coordinates_in, (*piece.coefficients.values(), piece.dt)))
    return coordinates_in(piece.expr)


def with_boundaries(rows: Sequence[Row]) -> list[Row]:
    """The rows with u = 0 in place of the conditions u >= 0 and -u >= 0, as the later one's."""
    kept: dict[int, Row] = {}
    sides: dict[frozenset[tuple[Expr, Fraction]], int] = {}
    for place, row in enumerate(rows):
        kept[place] = row
        if not isinstance(row.piece, DomainCondition) or row.piece.sense != ">=":
            continue
        form, terms = linear_form(row.piece.expr), linear_terms(row.piece.expr).items()
        pair = sides.pop(frozenset((term, -c) for term, c in terms), None)
        if pair is None or form is None:
            sides[frozenset(terms)] = place
            continue
        del kept[pair]
        kept[place] = Row(row.constraint, form if form.coefficients else Finite(row.piece.expr))
    return list(kept.values())


def split(coordinates: Sequence[str], rows: Sequence[Row]) -> tuple[list[Block], list[str]]:
    """(blocks, coordinates that nothing touches). Rows without coordinates are blocks of their own.

    Two rows share a block if they share a coordinate anywhere, coefficients included; conditions are rows here.
    """
    touched = [coordinates_of(row.piece) for row in rows]
    place = {c: k for k, c in enumerate(coordinates)}
    blocks = []
    for numbers in components(_linked(rows, touched)):
        conditions = tuple(dict.fromkeys(p for i in numbers if isinstance(p := rows[i].piece, DomainCondition)))
        members = [rows[i] for i in numbers if not isinstance(rows[i].piece, DomainCondition)]
        ordered = [r for r in members if isinstance(r.piece, Finite)]
        ordered += [r for r in members if not isinstance(r.piece, Finite)]
        names = sorted(_all({id(touched[i]): touched[i] for i in numbers}.values()), key=place.__getitem__)
        blocks.append(Block(tuple(names), tuple(ordered), conditions))
    used = _all({id(mentioned): mentioned for mentioned in touched}.values())
    return blocks, [c for c in coordinates if c not in used]


def _linked(rows: Sequence[Row], touched: Sequence[frozenset[str]]) -> Iterator[Iterable[Hashable]]:
    """What joins rows: the coordinates that they mention, and the joint, of which one equation names them for all."""
    known: set[int] = set()
    for row, mentioned in zip(rows, touched, strict=True):
        if not isinstance(row.piece, JointEquation):
            yield mentioned
            continue
        joint = id(row.piece.joint)
        yield (joint,) if joint in known else (joint, *mentioned)
        known.add(joint)


def _all(parts: Iterable[frozenset[str]]) -> frozenset[str]:
    return frozenset[str]().union(*parts)


def blocks_of(coordinates: Sequence[str], rows: Sequence[Row], reductions: Reductions) -> tuple[list[Block], list[str]]:
    """`split` as far as the reductions in use allow: else all rows are one block, and it holds every coordinate."""
    blocks, untouched = split(coordinates, rows)
    place = {c: k for k, c in enumerate(coordinates)}
    if "blocks" not in reductions and len(blocks) > 1:
        rows_of = [r for b in blocks for r in b.rows]
        finite = [r for r in rows_of if isinstance(r.piece, Finite)]
        others = [r for r in rows_of if not isinstance(r.piece, Finite)]
        conditions = tuple(dict.fromkeys(c for b in blocks for c in b.conditions))
        names = sorted((c for b in blocks for c in b.coordinates), key=place.__getitem__)
        blocks = [Block(tuple(names), (*finite, *others), conditions)]
    if "untouched" not in reductions and blocks:
        names = sorted((*blocks[0].coordinates, *untouched), key=place.__getitem__)
        blocks, untouched = [replace(blocks[0], coordinates=tuple(names)), *blocks[1:]], []
    return blocks, untouched


def expressions(block: Block) -> list[Expr]:
    """Everything the block evaluates."""
    result: list[Expr] = []
    for row in block.rows:
        if isinstance(row.piece, Pfaffian):
            result += [*row.piece.coefficients.values(), row.piece.dt]
        else:
            result.append(row.piece.expr)
    return result


def uses_time(block: Block) -> bool:
    """Does t or dt occur? It does not in the equations of joints that are not written out."""
    rows = tuple(row for row in block.rows if not isinstance(row.piece, JointEquation))
    dt = any(isinstance(r.piece, Pfaffian) and not r.piece.dt.is_zero for r in rows)
    return dt or any(ex.TIME in e.symbols for e in expressions(Block(block.coordinates, rows)))


def with_rows(rows: Sequence[Row], constants: Mapping[str, Row]) -> list[Row]:
    """The rows and, for every constant of integration C that they mention, dC = 0."""
    mentioned = frozenset().union(*(coordinates_of(r.piece) for r in rows)) if constants else frozenset[str]()
    return [*rows, *(row for c, row in constants.items() if c in mentioned)]


def names_in(rows: Sequence[Row], constants: Mapping[str, Row]) -> list[str]:
    """The constants of integration whose dC = 0 is among the rows."""
    kept = {id(row.piece) for row in rows} if constants else set()
    return [c for c, row in constants.items() if id(row.piece) in kept]


def about_constants(g: Expr, constants: Sequence[str]) -> bool:
    """Does a relation hold between constants of integration only?"""
    return all(s.args[0] == "parameter" or s.args[1] in constants for s in g.symbols)


def fixed_constants(hidden: Sequence[Expr], constants: Sequence[str]) -> dict[str, Expr]:
    """The constants that linear relations among them give in terms of parameters and the other constants."""
    result: dict[str, Expr] = {}
    for g in hidden if constants else ():
        if not about_constants(g, constants):
            continue
        remaining = substitute(g, {ex.coordinate(c): value for c, value in result.items()})
        terms = linear_terms(remaining)
        for c in reversed(constants):
            s = ex.coordinate(c)
            if s in terms and not any(s in u.symbols for u in terms if u != s):
                value = ex.ZERO - (remaining - ex.mul(ex.num(terms[s]), s)) / ex.num(terms[s])
                result = {k: substitute(v, {s: value}) for k, v in result.items()} | {c: value}
                break
    named = {ex.coordinate(c): ex.parameter(c) for c in constants}
    return {c: substitute(value, named) for c, value in result.items()}
