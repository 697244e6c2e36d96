"""A block's program: its ring with the finite relations, and coordinates that are functions of others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from dofkit.base.deadline import check
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, Row, expressions, uses_time
from dofkit.relations.chart import Chart
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.reductions import ReductionName
from dofkit.relations.setting import Setting


def aliases(block: Block, finite: Sequence[Expr]) -> dict[Expr, Expr]:
    """Coordinates that a finite relation gives explicitly (theta = w t), where they stand inside functions."""
    if not finite:
        return {}
    inside = {s for e in (*expressions(block), *finite) for s in _inside_functions(e)}
    found: dict[Expr, Expr] = {}
    for g in finite:
        if not any(s in inside for s in g.symbols):
            continue
        terms = linear_terms(g)
        for s in sorted(g.symbols & inside, key=repr):
            if s.args[0] != "coordinate" or s not in terms or any(s in u.symbols for u in terms if u != s):
                continue
            value = substitute((ex.mul(ex.num(terms[s]), s) - g) / ex.num(terms[s]), found)
            if s not in value.symbols:
                found = {k: substitute(v, {s: value}) for k, v in found.items()} | {s: value}
                break
    return found


def _inside_functions(e: Expr) -> frozenset[Expr]:
    found: frozenset[Expr] = frozenset()
    for node in ex.nodes(e):
        if node.op == "fn" or (node.op == "pow" and node.args[1].op != "num"):
            found |= node.symbols
    return found


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
    owners = {ex.coordinate(c.name): c.owner for c in setting.roles if c.role in ("x", "y", "z")}
    other: ReductionName = "eliminations"
    return (*(_kind(row, setting, angles, owners) for row in block.finite), *(other,) * more)


def _kind(row: Row, setting: Setting, angles: set[Expr], owners: Mapping[Expr, str | None]) -> ReductionName:
    if row.constraint in setting.welds:
        return "welds"
    symbols = row.piece.expr.symbols if isinstance(row.piece, Finite) else frozenset[Expr]()
    if symbols <= angles:
        return "still"
    links = setting.links.get(row.constraint)
    if links and symbols <= owners.keys():
        ends = {owners[s] for s in symbols}
        if any(ends == {*pair} for pair in links) and len(symbols) == 2 * setting.dimension:
            return "clusters"
    return "eliminations"
