"""Blocks of rows that share coordinates, and the `Chart` of a block: its program, relations and columns."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from dofkit.base.deadline import check
from dofkit.exact.matrices.sparse import components
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.renaming import coordinates_in, kinds_in
from dofkit.expressions.tree import Expr
from dofkit.relations.linear_relations import explicit_relations, number_coefficients
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.pieces import Clause, Finite, JointEquation, Nonlinear, Pfaffian
from dofkit.relations.setting import Setting

#: The number of no constraint: that of a row which none wrote.
NOBODY = -1


class Row(NamedTuple):
    """A piece (a scalar equation or a condition) with the number of the constraint from which it comes."""

    constraint: int
    piece: Finite | Pfaffian | Nonlinear | DomainCondition


@dataclass(frozen=True)
class Block:
    """Coordinates connected by rows, and these rows (finite ones first, otherwise in the order of the scene).

    ``conditions``: the rows are equivalent to the original equations where these are satisfied.
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
    """Return the coordinates that occur in a piece, in coefficients and differentials too; of a joint, all its own."""
    if isinstance(piece, JointEquation):
        return piece.joint.mentioned
    if isinstance(piece, Pfaffian):
        return frozenset(piece.coefficients).union(*map(coordinates_in, (*piece.coefficients.values(), piece.dt)))
    return coordinates_in(piece.expr)


def split(coordinates: Sequence[str], rows: Sequence[Row]) -> tuple[list[Block], list[str]]:
    """Return (blocks, coordinates that occur in no row). A row without coordinates is a block.

    Two rows, or a row and a condition, are in one block if they share a coordinate anywhere, coefficients included.
    """
    touched = [coordinates_of(row.piece) for row in rows]
    place = {c: k for k, c in enumerate(coordinates)}
    blocks = []
    for numbers in components(_linked(rows, touched)):
        conditions = tuple(dict.fromkeys(p for i in numbers if isinstance(p := rows[i].piece, DomainCondition)))
        members = [rows[i] for i in numbers if not isinstance(rows[i].piece, DomainCondition)]
        ordered = sorted(members, key=_is_no_equation)
        names = sorted(_all({id(touched[i]): touched[i] for i in numbers}.values()), key=place.__getitem__)
        blocks.append(Block(tuple(names), tuple(ordered), conditions))
    used = _all({id(mentioned): mentioned for mentioned in touched}.values())
    return blocks, [c for c in coordinates if c not in used]


def _linked(rows: Sequence[Row], touched: Sequence[frozenset[str]]) -> Iterator[Iterable[Hashable]]:
    """Yield what joins each row to others: its coordinates, or its joint, with the first equation's coordinates."""
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


def _is_no_equation(row: Row) -> bool:
    return not isinstance(row.piece, Finite)


def joined(coordinates: Iterable[str], blocks: Sequence[Block]) -> Block:
    """Return one block with these ``coordinates``, and the rows and conditions of several blocks."""
    rows = sorted((r for b in blocks for r in b.rows), key=_is_no_equation)
    return Block(tuple(coordinates), tuple(rows), tuple(dict.fromkeys(c for b in blocks for c in b.conditions)))


def expressions(block: Block) -> list[Expr]:
    """Return every expression that the block evaluates."""
    return [e for row in block.rows for e in expressions_of(row.piece)]


def expressions_of(piece: Clause) -> tuple[Expr, ...]:
    """Return the coefficients of a Pfaffian form, that of dt last; of everything else its expression."""
    return (*piece.coefficients.values(), piece.dt) if isinstance(piece, Pfaffian) else (piece.expr,)


def uses_time(block: Block) -> bool:
    """Return whether t or dt occurs in a row."""
    return any(depends_on_time(row.piece) for row in block.rows)


def depends_on_time(piece: Clause) -> bool:
    """Return whether t or dt occurs; equations of joints that are not written out are scleronomic."""
    if isinstance(piece, JointEquation):
        return False
    dt = isinstance(piece, Pfaffian) and not piece.dt.is_zero
    return dt or any("time" in kinds_in(e) for e in expressions_of(piece))


def is_measured(block: Block, setting: Setting) -> bool:
    """Return whether numbers with a tolerance occur in a block: geometry, or positions of particles and bodies.

    Equations given as formulas have exact numbers, unless a coordinate is that of a placed particle or body.
    """
    if setting.tolerance is None:
        return False
    if any(row.constraint in setting.geometric for row in block.rows):
        return True
    bodies = {c.owner for c in setting.roles if c.role not in ("x", "y", "z")}
    placed = {c.name for c in setting.roles if c.owner and ex.coordinate(c.name) in setting.pose and
              (setting.reference is not None or c.owner not in bodies)}  # fmt: skip
    return not placed.isdisjoint(block.coordinates)


@dataclass(frozen=True)
class Chart:
    """The ``ring`` (program) of a block; ``nodes`` compute its geometric equations ``relations``.

    ``symbols`` are the coordinates, then time if it occurs, and ``columns`` their generator indices (-1 if a symbol
    does not occur); ``unknowns`` are the symbols that a real search varies: coordinates and unnamed parameters.
    """

    ring: Ring
    nodes: tuple[int, ...]
    symbols: tuple[Expr, ...]
    columns: tuple[int, ...]
    unknowns: tuple[Expr, ...]
    relations: tuple[Expr, ...]
    setting: Setting

    @property
    def coordinates(self) -> int:
        """The number of coordinates, which are the first columns."""
        return sum(s.args[0] == "coordinate" for s in self.symbols)

    @property
    def time(self) -> int | None:
        """The index of the column of time; None if there is none."""
        return self.symbols.index(ex.TIME) if ex.TIME in self.symbols else None

    @property
    def scales(self) -> list[float]:
        """The unit of each column: the scene's size for positions x, y, z, otherwise 1."""
        places = {c.name for c in self.setting.roles if c.role in ("x", "y", "z")}
        return [self.setting.size if s.args[-1] in places else 1.0 for s in self.symbols]


def aliases(block: Block, finite: Sequence[Expr]) -> dict[Expr, Expr]:
    """Return {coordinate: value} for coordinates inside functions that geometric equations solve for (theta = w t)."""
    if not finite:
        return {}
    inside = {s for e in (*expressions(block), *finite) for s in _inside_functions(e)}

    def coefficients(g: Expr) -> dict[Expr, Expr]:
        return {s: c for s, c in number_coefficients(g).items() if s in inside}

    return explicit_relations(finite, coefficients).by_others


def _inside_functions(e: Expr) -> frozenset[Expr]:
    result: frozenset[Expr] = frozenset()
    for node in ex.nodes(e):
        if node.op in ("fn", "pow"):
            result |= node.symbols
    return result


def make_chart(block: Block, setting: Setting, extra: Sequence[Expr] = (), more: Sequence[Expr] = ()) -> Chart:
    """Return the chart of a block and ``extra`` geometric equations; ``more`` are other expressions to evaluate."""
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)] + list(extra)
    everything = [*expressions(block), *extra, *more]
    alias = aliases(block, finite) if block.forms or block.nonlinear else {}  # only rows in velocities need them
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
    return Chart(ring, nodes, symbols, columns, unknowns, tuple(finite), setting)
