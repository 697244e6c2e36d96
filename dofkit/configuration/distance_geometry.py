"""Proofs that no points have the prescribed distances, by the triangle inequality [Menger1928].

A distance is at most the length of any route between its ends. Routes are found in floating point, and a contradiction
is proved with intervals; equality, as in a triangle stretched to a line, is no contradiction.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from functools import partial
from itertools import combinations, pairwise
from typing import NamedTuple

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

#: Precision at which two lengths are compared, in bits.
BITS = 1024
#: Bounds on the steps of all searches for routes, and on the points of one body that are used.
MAX_VISITS, MAX_CARRIED = 100_000, 40
#: Routes are searched up to the length of a distance times 1 + SLACK.
SLACK = 1e-9
#: Digits of distances in messages.
DIGITS = 6


class Side(NamedTuple):
    """A distance, about ``length``, or an upper bound (``at_most``); ``owner``: its constraint, None within a body."""

    first: Place
    second: Place
    squared: Expr
    length: float
    owner: int | None
    at_most: bool


def lengths_unmet(block: Block, setting: Setting) -> Answer | None:
    """Return an inconsistent answer if a distance of a block is longer than a route between its ends; else None."""
    owners = sorted({row.constraint for row in block.rows})
    prescribed = [(i, d) for i in owners for d in setting.distances.get(i, ())]
    sides = sorted(_sides(prescribed), key=lambda side: -side.length) if len(prescribed) > 1 else []
    graph: nx.Graph[Place] = nx.Graph()
    for side in sides:  # of several between two points the shortest stays
        graph.add_edge(side.first, side.second, side=side)
    visits = 0
    for side in (side for side in sides if not side.at_most):
        check()
        cutoff = side.length * (1 + SLACK)
        length = partial(lambda hidden, u, v, edge: None if edge["side"] is hidden else edge["side"].length, side)
        routes = nx.single_source_dijkstra(graph, side.first, cutoff=cutoff, weight=length)[1]
        visits += len(routes)
        route = routes.get(side.second, ())
        others = [graph.edges[pair]["side"] for pair in pairwise(route)]
        if others and _is_longer(side, others, setting.positive):
            return _unmet(side, others, "-".join(place.label for place in route))
        if visits > MAX_VISITS:
            break
    return None


def _unmet(side: Side, others: Sequence[Side], route: str) -> Answer:
    """Return the inconsistent answer for a side that is longer than the ``others``, which form a route."""
    most = sum(other.length for other in others)
    why = (
        f"the points {side.first.label} and {side.second.label} cannot be {side.length:.{DIGITS}g} apart: "
        f"along {route} they are at most {most:.{DIGITS}g} apart."
    )
    conflict = tuple(sorted({s.owner for s in (side, *others) if s.owner is not None}))
    return Answer(False, reasons=[why], method="lengths compared", argument="lengths compared", conflict=conflict)


def _sides(distances: Sequence[tuple[int, Distance]]) -> Iterator[Side]:
    """Yield the distances, with random values of parameters, and those between points of one body."""
    draw = random.Random("dofkit lengths")
    symbols = sorted({s for _, d in distances for s in d.squared.symbols}, key=repr)
    values = {s: Fraction(draw.randrange(10**6, 10**7), 10**6) for s in symbols}
    written = ((d.first, d.second, d.squared, owner, d.at_most) for owner, d in distances)
    within = ((a, b, square_between(a.reference or (), b.reference or ()), None, False) for a, b in _carried(distances))
    for first, second, squared, owner, at_most in (*written, *within):
        about = interval_of(squared, values)
        if about is not None and about >= 0 and first != second:
            yield Side(first, second, squared, float(about.sqrt().mid()), owner, at_most)


def _is_longer(longest: Side, others: Sequence[Side], positive: frozenset[Expr]) -> bool:
    """Return whether a length is proved to be more than the sum of others, for all values of positive parameters."""
    gap = ex.add(ex.sqrt(longest.squared), *(ex.mul(ex.MINUS_ONE, ex.sqrt(o.squared)) for o in others))
    if gap.symbols:
        return never_holds(ex.mul(ex.MINUS_ONE, gap), False, positive)
    difference = interval_of(gap, None, BITS)
    return difference is not None and bool(difference > 0)


def _carried(distances: Iterable[tuple[int, Distance]]) -> Iterator[tuple[Place, Place]]:
    """Yield pairs of points of one body; their distance is that at the reference."""
    bodies: dict[str, dict[Place, None]] = {}
    for _, d in distances:
        for place in (d.first, d.second):
            if place.frame is not None and place.reference is not None:
                bodies.setdefault(place.frame, {})[place] = None
    for places in bodies.values():
        if len(places) <= MAX_CARRIED:
            yield from combinations(places, 2)
