"""A block as the engines see it: its program, its finite relations, its columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from dofkit.base.deadline import check
from dofkit.exact.errors import NoValueError
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, Row, expressions, uses_time
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.setting import ALL, ReductionName, Reductions, Setting
from dofkit.system import Coordinate


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
    """Coordinates that a finite relation gives explicitly (theta = w t), where they stand inside functions."""
    if not finite:
        return {}
    inside = {s for e in (*expressions(block), *finite) for s in _inside_functions(e)}
    result: dict[Expr, Expr] = {}
    for g in finite:
        if not any(s in inside for s in g.symbols):
            continue
        terms = linear_terms(g)
        for s in sorted(g.symbols & inside, key=repr):
            if s.args[0] != "coordinate" or s not in terms or any(s in u.symbols for u in terms if u != s):
                continue
            value = substitute((ex.mul(ex.num(terms[s]), s) - g) / ex.num(terms[s]), result)
            if s not in value.symbols:
                result = {k: substitute(v, {s: value}) for k, v in result.items()} | {s: value}
                break
    return result


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
