"""Relations that share coordinates in blocks, and a block as the engines see it: its program, relations, columns."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from dofkit.base.deadline import check
from dofkit.exact.matrices.sparse import components
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.renaming import coordinates_in
from dofkit.expressions.tree import Expr
from dofkit.relations.linear_relations import explicit_relations, number_coefficients
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.pieces import Clause, Finite, JointEquation, Nonlinear, Pfaffian
from dofkit.relations.setting import Reductions, Setting

#: The constraint of a row that none wrote.
NOBODY = 0


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
        ordered = sorted(members, key=_is_no_equation)
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
        names = sorted((c for b in blocks for c in b.coordinates), key=place.__getitem__)
        blocks = [joined(names, blocks)]
    if "untouched" not in reductions and blocks:
        names = sorted((*blocks[0].coordinates, *untouched), key=place.__getitem__)
        blocks, untouched = [replace(blocks[0], coordinates=tuple(names)), *blocks[1:]], []
    return blocks, untouched


def _is_no_equation(row: Row) -> bool:
    return not isinstance(row.piece, Finite)


def joined(coordinates: Iterable[str], blocks: Sequence[Block]) -> Block:
    """Return several blocks as one, on some coordinates."""
    rows = sorted((r for b in blocks for r in b.rows), key=_is_no_equation)
    return Block(tuple(coordinates), tuple(rows), tuple(dict.fromkeys(c for b in blocks for c in b.conditions)))


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
    """Return whether t or dt occurs; equations of joints that are not written out are scleronomic."""
    rows = tuple(row for row in block.rows if not isinstance(row.piece, JointEquation))
    dt = any(isinstance(r.piece, Pfaffian) and not r.piece.dt.is_zero for r in rows)
    return dt or any(ex.TIME in e.symbols for e in expressions(Block(block.coordinates, rows)))


def is_measured(block: Block, setting: Setting) -> bool:
    """Return whether measured numbers enter a block: geometry, or positions of particles and bodies.

    Texts on coordinates that belong to no particle and no body, or to one without a position, hold no such numbers.
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
    """A block's ring, its geometric equations and its columns: coordinates, then time where it occurs.

    ``columns`` are generator indices (-1: the symbol occurs nowhere); ``unknowns`` are the symbols that a real search
    moves: coordinates and generic geometry. ``relations`` are what the nodes compute.
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
        """The number of columns that are coordinates."""
        return sum(s.args[0] == "coordinate" for s in self.symbols)

    @property
    def time(self) -> int | None:
        """The number of the column that is time."""
        return self.symbols.index(ex.TIME) if ex.TIME in self.symbols else None

    @property
    def scales(self) -> list[float]:
        """The size by which each column is measured: places by the scale of lengths."""
        places = {c.name for c in self.setting.roles if c.role in ("x", "y", "z")}
        return [self.setting.size if s.args[-1] in places else 1.0 for s in self.symbols]


def aliases(block: Block, finite: Sequence[Expr]) -> dict[Expr, Expr]:
    """Return the coordinates that geometric equations give explicitly (theta = w t), if they stand inside functions."""
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
    """The ring of a block with its geometric equations and ``extra`` ones; ``more`` is evaluated too."""
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
    return Chart(ring, nodes, symbols, columns, unknowns, tuple(finite), setting)
