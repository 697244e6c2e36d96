"""Relations that share coordinates in blocks, and a block as the engines see it: its program, relations, columns."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from typing import NamedTuple

from flint import fmpq, fmpq_mat

from dofkit.base.deadline import check
from dofkit.base.libraries import components
from dofkit.exact.errors import NoValueError
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.renaming import coordinates_in
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.pieces import Clause, Finite, JointEquation, Nonlinear, Pfaffian
from dofkit.relations.setting import ALL, ReductionName, Reductions, Setting
from dofkit.system import Coordinate

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
    elsewhere = frozenset().union(*(e.symbols for i, e in enumerate(relations) if i not in result))
    symbols = sorted({s for t in result.values() for s in t}, key=lambda s: (_place(s), s in elsewhere, repr(s)))
    if len(result) < 2 or len(result) * len(symbols) > MAX_ENTRIES:
        return Presolved((), frozenset(), frozenset(), False)
    rows = [[fmpq(*t.get(s, Fraction(0)).as_integer_ratio()) for s in symbols] for t in result.values()]
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
    grouped: set[int] = set()
    for row, mentioned in zip(rows, touched, strict=True):
        if not isinstance(row.piece, JointEquation):
            yield mentioned
            continue
        joint = id(row.piece.joint)
        yield (joint,) if joint in grouped else (joint, *mentioned)
        grouped.add(joint)


def _all(sets: Iterable[frozenset[str]]) -> frozenset[str]:
    return frozenset[str]().union(*sets)


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
    """Return whether t or dt occurs, which it does not in equations of joints that are not written out."""
    rows = tuple(row for row in block.rows if not isinstance(row.piece, JointEquation))
    dt = any(isinstance(r.piece, Pfaffian) and not r.piece.dt.is_zero for r in rows)
    return dt or any(ex.TIME in e.symbols for e in expressions(Block(block.coordinates, rows)))


def given_by(relations: Iterable[Expr], wanted: Sequence[Expr] | None = None) -> dict[Expr, Expr]:
    """Return the coordinates that relations give explicitly, as functions of others, each free of those solved for.

    Such a coordinate stands in its relation once, with a number as coefficient; ``wanted``: those that are solved for,
    the first that can be, by default any.
    """
    result: dict[Expr, Expr] = {}
    for g in relations:
        terms = linear_terms(substitute(g, result))
        for s in terms if wanted is None else wanted:
            if s.op != "sym" or s.args[0] != "coordinate" or any(s in u.symbols for u in terms if u != s):
                continue
            if s in terms:
                value = ex.add(*(ex.mul(ex.num(-k / terms[s]), u) for u, k in terms.items() if u != s))
                result = {k: substitute(v, {s: value}) for k, v in result.items()} | {s: value}
                break
    return result


@dataclass(frozen=True)
class Chart:
    """A block's ring, its finite relations and its columns: coordinates, then time where it occurs.

    ``columns`` are generator indices (-1: the symbol occurs nowhere); ``unknowns`` are the symbols that a
    real search moves: coordinates and generic geometry. ``relations`` are what the nodes compute; ``engines`` those
    that may look at it; ``size`` is the scale of lengths; ``reductions``: those in
    use, and ``kinds`` which of them may use each relation. ``within``: they hang by joints on other bodies.
    """

    ring: Ring
    nodes: tuple[int, ...]
    symbols: tuple[Expr, ...]
    columns: tuple[int, ...]
    unknowns: tuple[Expr, ...]
    positive: frozenset[Expr]
    roles: tuple[Coordinate, ...] = ()
    relations: tuple[Expr, ...] = ()
    engines: Engines = BOTH
    size: float = 1.0
    reductions: Reductions = ALL
    kinds: tuple[ReductionName, ...] = ()
    within: bool = False

    @property
    def coordinates(self) -> int:
        """The number of columns that are coordinates."""
        return sum(s.args[0] == "coordinate" for s in self.symbols)

    @property
    def time(self) -> int | None:
        """The number of the column that is time."""
        return self.symbols.index(ex.TIME) if ex.TIME in self.symbols else None

    @property
    def scales(self) -> list[float]:
        """The size by which each column is measured: places by the scale of lengths."""
        places = {c.name for c in self.roles if c.role in ("x", "y", "z")}
        return [self.size if s.args[-1] in places else 1.0 for s in self.symbols]


Displacement = dict[int, list[tuple[int, int | None]]]


def displacement_fields(chart: Chart) -> list[Displacement]:
    """Translations and rotations: for a column, the sum of factor * (the value of another column, or 1).

    Only where every coordinate of the block is a place or the angle of a planar body.
    """
    place = {str(s.args[1]): i for i, s in enumerate(chart.symbols) if s != ex.TIME}
    here = [c for c in chart.roles if c.name in place]
    if len(here) != len(place) or any(c.role not in ("x", "y", "z", "angle") for c in here):
        return []
    by_owner: dict[str, dict[str, int]] = {}
    for c in here:
        by_owner.setdefault(str(c.owner), {})[c.role] = place[c.name]
    axes = sorted({r for roles_of in by_owner.values() for r in roles_of if r != "angle"})
    result: list[Displacement] = [{o[a]: [(1, None)] for o in by_owner.values() if a in o} for a in axes]
    for a, b in combinations(axes, 2):
        turn: Displacement = {}
        for o in by_owner.values():
            if a in o and b in o:
                turn[o[a]] = [(-1, o[b])]
                turn[o[b]] = [(1, o[a])]
            if "angle" in o:
                turn[o["angle"]] = [(1, None)]
        result.append(turn)
    return result


def free_point(chart: Chart, seed: int) -> FieldPoint | None:
    """A random point of the ambient space at which the program runs."""
    for attempt in range(60):
        point = field_point([chart.ring], 1000 * seed + attempt)
        try:
            values(chart.ring, point)
        except NoValueError:
            continue
        return point
    return None


def aliases(block: Block, finite: Sequence[Expr]) -> dict[Expr, Expr]:
    """Return the coordinates that finite relations give explicitly (theta = w t), if they stand inside functions."""
    if not finite:
        return {}
    inside = {s for e in (*expressions(block), *finite) for s in _inside_functions(e)}
    return given_by(finite, sorted(inside, key=repr))


def _inside_functions(e: Expr) -> frozenset[Expr]:
    result: frozenset[Expr] = frozenset()
    for node in ex.nodes(e):
        if node.op == "fn" or (node.op == "pow" and node.args[1].op != "num"):
            result |= node.symbols
    return result


def make_chart(block: Block, setting: Setting, extra: Sequence[Expr] = (), more: Sequence[Expr] = ()) -> Chart:
    """The ring of a block with its finite relations and ``extra`` ones; ``more`` is evaluated too."""
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + list(extra)
    everything = [*expressions(block), *extra, *more]
    alias = aliases(block, finite) if block.forms or block.nonlinear else {}
    ring = Ring(everything, setting.positive, alias)
    nodes = tuple(ring.node(g) for g in finite)
    for e in everything:
        check()
        ring.node(e)
    symbols = tuple(ex.coordinate(c) for c in block.coordinates)
    if uses_time(block) or any(ex.TIME in e.symbols for e in extra):
        symbols = (*symbols, ex.TIME)
    columns = tuple(-1 if (i := ring.var_index(s)) is None else i for s in symbols)
    unknowns = (*(s for s in symbols if s != ex.TIME), *setting.generic)
    return Chart(
        ring,
        nodes,
        symbols,
        columns,
        unknowns,
        setting.positive,
        setting.roles,
        tuple(finite),
        setting.engines,
        setting.size,
        setting.reductions,
        _kinds(block, setting, len(extra)),
        setting.within,
    )


def _kinds(block: Block, setting: Setting, more: int) -> tuple[ReductionName, ...]:
    """Which reduction may use each finite relation of the block, and so many more."""
    angles = {ex.coordinate(c.name) for c in setting.roles if c.role in ("angle", "phi", "theta", "psi")}
    other: ReductionName = "eliminations"
    return (*(_kind(row, setting, angles) for row in block.finite), *(other,) * more)


def _kind(row: Row, setting: Setting, angles: set[Expr]) -> ReductionName:
    if row.constraint in setting.welds:
        return "welds"
    symbols = row.piece.expr.symbols if isinstance(row.piece, Finite) else frozenset[Expr]()
    return "still" if symbols <= angles else "eliminations"
