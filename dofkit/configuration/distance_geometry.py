"""Lengths that no points can have, proved by geometry before anything is searched.

A distance is at most the length of any route between its ends (the triangle inequality [Menger1928]). Floating point
proposes, intervals decide; where they do not tell two sides apart, as in a triangle drawn out to a line, nothing is
contradicted.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from itertools import combinations, pairwise

from flint import arb

from dofkit.base.deadline import check
from dofkit.base.libraries import nx
from dofkit.expressions import tree as ex
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.tree import Expr
from dofkit.expressions.vectors import square_between
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.setting import Setting
from dofkit.system import Distance, Place

#: Precisions at which two lengths are compared, in bits.
BITS = (64, 256, 1024)
#: Steps of all searches for short routes, and points of one body that are used.
MAX_VISITS, MAX_CARRIED = 100_000, 40
#: Ways that are longer than a distance by more than this fraction are no reason to doubt it.
SLACK = 1e-9
#: Distances are shown to so many digits.
DIGITS = 6

Node = tuple[str | None, str]


@dataclass(frozen=True)
class Side:
    """A known distance, about ``length``, or a bound from above; ``owner`` None where a body holds both points."""

    squared: Expr
    length: float
    owner: int | None
    at_most: bool = False


@dataclass(frozen=True)
class Unmet:
    """Constraints whose lengths cannot be met together, and why."""

    constraints: tuple[int, ...]
    reason: str


def lengths_unmet(block: Block, setting: Setting) -> Answer | None:
    """Return the answer to a block whose links cannot close; None where that is not seen."""
    owners = sorted({row.constraint for row in block.rows})
    prescribed = [(i, d) for i in owners for d in setting.distances.get(i, ())]
    unmet_lengths = unmet(prescribed, setting.positive) if len(prescribed) > 1 else None
    if unmet_lengths is None:
        return None
    return Answer(
        False,
        reasons=[unmet_lengths.reason],
        method="lengths compared",
        argument="lengths compared",
        conflict=unmet_lengths.constraints,
    )


def unmet(distances: Sequence[tuple[int, Distance]], positive: frozenset[Expr]) -> Unmet | None:
    """A minimal set of distances, each with its constraint, that no points have; None where none is seen."""
    return _Web(distances, positive).polygon()


class _Web:
    """A graph of points; each edge is a side, of which two points may have several."""

    def __init__(self, distances: Sequence[tuple[int, Distance]], positive: frozenset[Expr]) -> None:
        self.positive = positive
        draw = random.Random("dofkit lengths")
        symbols = sorted({s for _, d in distances for s in d.squared.symbols}, key=repr)
        self.values = {s: Fraction(draw.randrange(10**6, 10**7), 10**6) for s in symbols}
        self.graph: nx.MultiGraph[Node] = nx.MultiGraph()
        for owner, d in distances:
            self._add(_node(d.first), _node(d.second), d.squared, owner, d.at_most)
        for first, second in _carried(distances):
            self._add(_node(first), _node(second), square_between(first.reference or (), second.reference or ()), None)

    def _add(self, a: Node, b: Node, squared: Expr, owner: int | None, at_most: bool = False) -> None:
        about = interval_of(squared, self.values, BITS[0])
        if about is None or not about >= 0:
            about = arb(0) if squared.is_zero else None
        if about is not None and a != b:
            self.graph.add_edge(a, b, side=Side(squared, float(about.sqrt().mid()), owner, at_most))

    def _exact(self) -> list[tuple[Node, Node, Side]]:
        """Return the sides that are no bounds, with their ends."""
        return [(a, b, side) for a, b, side in self.graph.edges(data="side") if not side.at_most]

    def _longer(self, longest: Side, others: Sequence[Side]) -> bool:
        """Return whether a length is certainly more than others together, whatever the positive parameters are."""
        gap = ex.add(_length(longest), *(ex.mul(ex.MINUS_ONE, _length(o)) for o in others))
        if gap.symbols:
            return never_holds(ex.mul(ex.MINUS_ONE, gap), False, self.positive)
        for bits in BITS:
            difference = interval_of(gap, None, bits)
            if difference is not None and not difference.contains(0):
                return bool(difference > 0)
        return False

    def polygon(self) -> Unmet | None:
        """A distance longer than a route between its ends (each side of a polygon is at most the others together)."""
        visits = 0
        for a, b, side in sorted(self._exact(), key=lambda edge: -edge[2].length):
            check()
            cutoff, weight = side.length * (1 + SLACK), partial(_length_but, side)
            far, routes = nx.single_source_dijkstra(self.graph, a, cutoff=cutoff, weight=weight)
            visits += len(far)
            if b in routes:
                shortest = (_shortest(side, self.graph[u][v]) for u, v in pairwise(routes[b]))
                others = [other for other in shortest if other is not None]
                if self._longer(side, others):
                    route, most = "-".join(node[1] for node in routes[b]), sum(o.length for o in others)
                    claim = f"the points {a[1]} and {b[1]} cannot be {_side_text(side)} apart"
                    return Unmet(
                        _owners((side, *others)), f"{claim}: along {route} they are at most {most:.{DIGITS}g} apart."
                    )
            if visits > MAX_VISITS:
                return None
        return None


def _node(place: Place) -> Node:
    return place.frame, place.label


def _carried(distances: Iterable[tuple[int, Distance]]) -> Iterable[tuple[Place, Place]]:
    """Pairs of points of one body: they keep the distance they are drawn at."""
    bodies: dict[str, dict[Node, Place]] = {}
    for _, d in distances:
        for place in (d.first, d.second):
            if place.frame is not None and place.reference is not None:
                bodies.setdefault(place.frame, {})[_node(place)] = place
    for places in bodies.values():
        if len(places) <= MAX_CARRIED:
            yield from combinations(places.values(), 2)


def _length(side: Side) -> Expr:
    return ex.sqrt(side.squared)


def _shortest(hidden: Side, edges: Mapping[int, Mapping[str, Side]]) -> Side | None:
    """Return the shortest side between two points but one."""
    others = (edge["side"] for edge in edges.values() if edge["side"] is not hidden)
    return min(others, key=lambda side: side.length, default=None)


def _length_but(hidden: Side, _u: Node, _v: Node, edges: Mapping[int, Mapping[str, Side]]) -> float | None:
    side = _shortest(hidden, edges)
    return None if side is None else side.length


def _owners(sides: Iterable[Side]) -> tuple[int, ...]:
    return tuple(sorted({side.owner for side in sides if side.owner is not None}))


def _side_text(side: Side) -> str:
    return f"{side.length:.{DIGITS}g}"
