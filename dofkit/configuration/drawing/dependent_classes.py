"""Relations that are dependent at a point, apart from all others: what is looked at to tell a motion from a shake.

Let B be a basis of the rows of the Jacobian at P, and M the manifold on which the relations of B vanish. The set that
all relations cut out is M if those outside B vanish on M too. One of them that is a combination of rows S of B is
looked at together with any set of relations that holds S: where these alone cut out the manifold M' of their part of B
[ImplicitFunctions], it vanishes on M', and M lies in M'. So relations in no dependent set (coloops) need not be looked
at: what hangs on a mechanism as a tree, or is determined one by one, never enters, and mechanisms that share nothing
are apart.

Two rows are in one class where a minimal dependent set holds both. Beside a class those relations are kept that
mention its coordinates only: without them a bar across a square could not tell that the square is held. Where that is
not enough, all that is said of its bodies is looked at (`widened`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from dofkit.base.libraries import nx
from dofkit.exact.matrices.sparse import Echelon
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.tree import Expr
from dofkit.relations.chart import Chart


@dataclass(frozen=True)
class DependentClass:
    """Rows that are looked at together, by their numbers, and how many of them are independent."""

    rows: tuple[int, ...]
    rank: int


def dependent_parts(chart: Chart, found: Echelon) -> list[DependentClass]:
    """The classes with dependent rows, each with what else is said of its coordinates; ``found`` with its supports."""
    graph: nx.Graph = nx.Graph()
    for row, support in found.supports.items():
        graph.add_node(row)
        graph.add_edges_from((row, other) for other in support)
    own = frozenset(s for s in chart.symbols)
    mentioned = [g.symbols & own for g in chart.relations]
    users: dict[Expr, list[int]] = {}
    for i, symbols in enumerate(mentioned):
        for s in symbols:
            users.setdefault(s, []).append(i)
    parts = []
    for component in nx.connected_components(graph):
        held = frozenset[Expr]().union(*(mentioned[i] for i in component))
        beside = {i for s in held for i in users[s] if mentioned[i] <= held and i not in found.supports}
        rows = tuple(sorted(component | beside))
        parts.append(DependentClass(rows, len(rows) - sum(r in found.supports for r in rows)))
    return sorted(parts, key=lambda part: part.rows)


def widened(chart: Chart, part: DependentClass, found: Echelon) -> DependentClass:
    """The class with all that is said of the bodies and particles that it mentions: a loop with all of its joints.

    The height alone of hinges whose axes are upright closes round a loop to first order only; beside the other
    equations of these hinges it follows from them. Dependent rows of other classes come along with their own.
    """
    owners = {c.name: c.owner for c in chart.roles if c.owner is not None}
    mentioned = [frozenset(owners.get(s.args[1], s) for s in g.symbols) for g in chart.relations]
    held = frozenset[object]().union(*(mentioned[i] for i in part.rows))
    within = {i for i, those in enumerate(mentioned) if those <= held}
    rows = {i for i in within if i not in found.supports or within.issuperset(found.supports[i])} | {*part.rows}
    return DependentClass(tuple(sorted(rows)), len(rows) - sum(i in found.supports for i in rows))


def chart_of(chart: Chart, rows: Sequence[int]) -> Chart:
    """Some of the relations on the columns that they mention."""
    relations = tuple(chart.relations[r] for r in rows)
    ring = Ring(relations, chart.positive)
    nodes = tuple(ring.node(g) for g in relations)
    mentioned = frozenset[Expr]().union(*(g.symbols for g in relations))
    symbols = tuple(s for s in chart.symbols if s in mentioned)
    columns = tuple(-1 if (i := ring.var_index(s)) is None else i for s in symbols)
    return replace(
        chart,
        ring=ring,
        nodes=nodes,
        symbols=symbols,
        columns=columns,
        unknowns=tuple(u for u in chart.unknowns if u in mentioned),
        relations=relations,
        kinds=tuple(chart.kinds[r] for r in rows),
    )
