"""A drawn block with fewer coordinates: relations on fewer of them that cut out the same set near the drawing.

- A relation c q + (a sum of others and a number) = 0 makes the set a graph over the other coordinates: q goes
  [ImplicitFunctions]. So go the angles of bodies that do not turn (theta = 0), bodies welded to others (x_B = x_A,
  theta_B = theta_A), z = 0.
- Particles of the plane with links between them that are infinitesimally rigid at the drawing move as one body
  [AsimowRoth1978]: near the drawing the links hold where the first two keep their distance |d| and each other one is
  p = p_A + a (p_B - p_A) + b J (p_B - p_A), with the a and b of the drawing and J the quarter turn.

Coordinates and independent relations go together, so the dimension of the set near the drawing is the same.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from dofkit.exact.matrices.sparse import SparseRow, rank_of_rows
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.mobility.graph.linkage import linkage
from dofkit.relations.blocks import linear
from dofkit.relations.chart import Chart
from dofkit.relations.setting import ReductionName

#: Coordinates are not replaced by longer sums than this: what they stand in would fill up.
TERMS = 5
#: A prime modulo which a rank is a lower bound of the true one.
PRIME = 2**61 - 1
#: Particles of a cluster at the least.
FEWEST = 3

Point = tuple[Fraction, ...]


class ReducibleRelation(NamedTuple):
    """A relation, and the reduction that may use it."""

    relation: Expr
    kind: ReductionName


def smaller(chart: Chart, drawing: Mapping[Expr, Expr]) -> tuple[Chart, int]:
    """The chart with fewer coordinates, and how many of those that went are free; the chart itself where none can go.

    Free are those that no relation mentions any more: the set is a product with a line for each.
    """
    said = [ReducibleRelation(g, k) for g, k in zip(chart.relations, chart.kinds, strict=True)]
    if len(said) != len(chart.nodes) or chart.time is not None:
        return chart, 0
    if "clusters" in chart.reductions:
        said = _as_bodies(chart, said, drawing)
    gone, left = _without_explicit(chart, said)
    if not gone:
        return chart, 0
    relations = tuple(s.relation for s in left)
    ring = Ring(relations, chart.positive)
    nodes = tuple(ring.node(g) for g in relations)
    mentioned = frozenset[Expr]().union(*(g.symbols for g in relations))
    symbols = tuple(s for s in chart.symbols if s in mentioned)
    small = replace(
        chart,
        ring=ring,
        nodes=nodes,
        symbols=symbols,
        columns=tuple(-1 if (i := ring.var_index(s)) is None else i for s in symbols),
        unknowns=tuple(u for u in chart.unknowns if u in mentioned),
        relations=relations,
        kinds=tuple(s.kind for s in left),
    )
    return small, len(chart.symbols) - len(gone) - len(symbols)


# Explicit coordinates


def _without_explicit(chart: Chart, said: Sequence[ReducibleRelation]) -> tuple[set[Expr], list[ReducibleRelation]]:
    """The coordinates that relations give explicitly, and what is left of the relations without them."""
    own = frozenset(chart.symbols)
    left: dict[int, ReducibleRelation] = dict(enumerate(said))
    users: dict[Expr, set[int]] = {}
    for i, s in left.items():
        for symbol in s.relation.symbols & own:
            users.setdefault(symbol, set()).add(i)
    gone: set[Expr] = set()
    waiting = [i for i, s in left.items() if s.kind in chart.reductions][::-1]
    while waiting:
        i = waiting.pop()
        found = _explicit(left[i].relation, own, users) if i in left else None
        if found is None:
            continue
        q, value = found
        gone.add(q)
        del left[i]
        for k in users.pop(q) - {i}:
            if k not in left:
                continue
            changed = substitute(left[k].relation, {q: value})
            for symbol in changed.symbols & own:
                users.setdefault(symbol, set()).add(k)
            left[k] = left[k]._replace(relation=changed)
            if left[k].kind in chart.reductions:
                waiting.append(k)
            if changed.is_zero:
                del left[k]
    return gone, list(left.values())


def _explicit(e: Expr, own: frozenset[Expr], users: Mapping[Expr, set[int]]) -> tuple[Expr, Expr] | None:
    """(q, value) where the relation says q = value, q the coordinate that the fewest relations mention."""
    terms = linear(e)
    if terms is None or len(terms) > TERMS:
        return None
    candidates = [s for s, factor in terms.items() if s in own and factor]
    if not candidates or any(s.op == "sym" and s not in own for s in terms):
        return None
    q = min(candidates, key=lambda s: (len(users[s]), repr(s)))
    others = (ex.mul(ex.num(-a / terms[q]), s) for s, a in terms.items() if s != q)
    return q, ex.add(*others)


# Rigid clusters


def _as_bodies(
    chart: Chart, said: Sequence[ReducibleRelation], drawing: Mapping[Expr, Expr]
) -> list[ReducibleRelation]:
    """The relations with the links of every rigid cluster of the plane replaced by those of one body."""
    places = _places(chart)
    pairs: dict[int, tuple[str, str]] = {}
    for i, s in enumerate(said):
        ends = sorted({owner for owner, own in places.items() if not s.relation.symbols.isdisjoint(own)})
        if s.kind == "clusters" and len(ends) == 2:
            pairs[i] = ends[0], ends[1]
    if len(pairs) < FEWEST:
        return list(said)
    found = dict(enumerate(said))
    more: list[ReducibleRelation] = []
    for cluster in linkage(pairs.values(), 2).clusters:
        members = [str(name) for name in cluster]
        within = [i for i, ends in pairs.items() if i in found and set(ends) <= set(members)]
        at = {name: _point_drawn(places[name], drawing) for name in members}
        stands = {name: p for name, p in at.items() if p is not None}
        if len(members) < FEWEST or len(stands) < len(members) or not _rigid([pairs[i] for i in within], stands):
            continue
        for i in within:
            del found[i]
        more += _one_body(members, stands, places)
    return [*found.values(), *more]


def _places(chart: Chart) -> dict[str, tuple[Expr, ...]]:
    """The coordinates (x, y) of every particle of the plane that has both among the chart's."""
    found: dict[str, dict[str, Expr]] = {}
    symbols = {str(s.args[1]): s for s in chart.symbols}
    for c in chart.roles:
        if c.name in symbols and c.role in ("x", "y", "z"):
            found.setdefault(str(c.owner), {})[c.role] = symbols[c.name]
    return {owner: (own["x"], own["y"]) for owner, own in found.items() if own.keys() == {"x", "y"}}


def _point_drawn(place: Sequence[Expr], drawing: Mapping[Expr, Expr]) -> Point | None:
    """Where a particle stands, in rational numbers."""
    values = [v.args[0] for s in place if (v := drawing.get(s)) is not None and v.op == "num"]
    return tuple(values) if len(values) == len(place) else None


def _rigid(pairs: Sequence[tuple[str, str]], at: Mapping[str, Point]) -> bool:
    """Are links infinitesimally rigid where they stand? A rank modulo a prime is at most the true one."""
    number = {name: 2 * k for k, name in enumerate(at)}
    rows: list[SparseRow] = []
    for a, b in pairs:
        arm = [_residue(u - v) for u, v in zip(at[a], at[b], strict=True)]
        row = {number[a] + k: v for k, v in enumerate(arm)} | {number[b] + k: -v % PRIME for k, v in enumerate(arm)}
        rows.append({c: v for c, v in row.items() if v})
    return rank_of_rows(rows, PRIME) == 2 * len(at) - 3


def _residue(value: Fraction) -> int:
    return value.numerator * pow(value.denominator, -1, PRIME) % PRIME


def _one_body(
    members: Sequence[str], at: Mapping[str, Point], places: Mapping[str, Sequence[Expr]]
) -> list[ReducibleRelation]:
    """The first two particles keep their distance; the others follow them."""
    a, b = members[0], next(m for m in members if at[m] != at[members[0]])
    (dx, dy), squared = _from(at[a], at[b]), _squared(at[a], at[b])
    (xa, ya), (xb, yb) = places[a], places[b]
    along = ex.power(xb - xa, ex.TWO) + ex.power(yb - ya, ex.TWO) - ex.num(squared)
    said = [ReducibleRelation(along, "clusters")]
    for name in members:
        if name in (a, b):
            continue
        ux, uy = _from(at[a], at[name])
        s, t = (ux * dx + uy * dy) / squared, (uy * dx - ux * dy) / squared
        x, y = places[name]
        said.append(ReducibleRelation(_sum((x, -1), (xa, 1 - s), (ya, t), (xb, s), (yb, -t)), "clusters"))
        said.append(ReducibleRelation(_sum((y, -1), (ya, 1 - s), (xa, -t), (yb, s), (xb, t)), "clusters"))
    return said


def _sum(*terms: tuple[Expr, Fraction | int]) -> Expr:
    return ex.add(*(ex.mul(ex.num(factor), symbol) for symbol, factor in terms if factor))


def _from(a: Point, b: Point) -> Point:
    return tuple(v - u for u, v in zip(a, b, strict=True))


def _squared(a: Point, b: Point) -> Fraction:
    return sum((v * v for v in _from(a, b)), Fraction(0))
