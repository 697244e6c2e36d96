"""A block at the reference with fewer coordinates: relations on fewer of them that cut out the same set near it.

A relation c q + (a sum of others and a number) = 0 makes the set a graph over the other coordinates: q goes
[ImplicitFunctions]. So go the angles of bodies that do not turn (theta = 0), bodies welded to others (x_B = x_A,
theta_B = theta_A), z = 0. Coordinates and independent relations go together, so the dimension of the set is the same.
"""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.configuration.variety import chart_of_relations
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Chart
from dofkit.relations.linear_relations import linear

#: Coordinates are not replaced by longer sums than this: what they stand in would fill up.
TERMS = 5


def smaller(chart: Chart) -> tuple[Chart, int]:
    """The chart with fewer coordinates, and how many of those that went are free; the chart itself where none can go.

    Free are those that no relation mentions any more: the set is a product with a line for each.
    """
    if len(chart.relations) != len(chart.nodes) or chart.time is not None:
        return chart, 0
    gone, kept = _without_explicit(chart)
    if not gone:
        return chart, 0
    small = chart_of_relations(chart, [*kept.values()], [chart.kinds[i] for i in kept])
    return small, len(chart.symbols) - len(gone) - len(small.symbols)


def _without_explicit(chart: Chart) -> tuple[set[Expr], dict[int, Expr]]:
    """Return the coordinates that relations give explicitly, and the other relations, by number, without them."""
    columns = frozenset(chart.symbols)
    kept: dict[int, Expr] = dict(enumerate(chart.relations))
    users: dict[Expr, set[int]] = {}
    for i, relation in kept.items():
        for symbol in relation.symbols & columns:
            users.setdefault(symbol, set()).add(i)
    gone: set[Expr] = set()
    waiting = [i for i in kept if chart.kinds[i] in chart.reductions][::-1]
    while waiting:
        i = waiting.pop()
        solution = _explicit(kept[i], columns, users) if i in kept else None
        if solution is None:
            continue
        q, value = solution
        gone.add(q)
        del kept[i]
        for k in users.pop(q) - {i}:
            if k not in kept:
                continue
            changed = substitute(kept[k], {q: value})
            for symbol in changed.symbols & columns:
                users.setdefault(symbol, set()).add(k)
            kept[k] = changed
            if chart.kinds[k] in chart.reductions:
                waiting.append(k)
            if changed.is_zero:
                del kept[k]
    return gone, kept


def _explicit(e: Expr, columns: frozenset[Expr], users: Mapping[Expr, set[int]]) -> tuple[Expr, Expr] | None:
    """(q, value) where the relation says q = value, q the coordinate that the fewest relations mention."""
    terms = linear(e)
    if terms is None or len(terms) > TERMS:
        return None
    candidates = [s for s, factor in terms.items() if s in columns and factor]
    if not candidates or any(s.op == "sym" and s not in columns for s in terms):
        return None
    q = min(candidates, key=lambda s: (len(users[s]), repr(s)))
    others = (ex.mul(ex.num(-a / terms[q]), s) for s, a in terms.items() if s != q)
    return q, ex.add(*others)
