"""Coordinates that finite relations give by others: put into a relation, they may leave nothing of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from dofkit.checker.trees import ZERO, CheckError, Tree, difference, linear_in, negative, put_in, times
from dofkit.methods.certificates.estimates import Estimates, NoEstimateError
from dofkit.methods.certificates.found_points import FoundPoint
from dofkit.methods.certificates.scenery import Scenery
from dofkit.methods.certificates.texts import text_of

#: A relation and the coordinate that it gives.
Order = list[list[str]]
#: What is farther from 0 than this, in floats, is taken to be none.
FAR = 1e-7
#: Relations that are longer are not solved in pairs.
LARGEST_OF_PAIR = 30


def puts(scenery: Scenery, names: Sequence[str]) -> Order:
    """Finite relations with the coordinates that they give, in the order in which these are put into others.

    The later one is put in, the fewer coordinates its relation holds that another one gives.
    """
    evidence, coordinates = scenery.evidence, scenery.problem.coordinates
    lefts = {name: evidence.relation(name).left for name in names if evidence.relation(name).kind == "finite"}
    held = {name: left.symbols.intersection(coordinates) for name, left in lefts.items()}
    order: Order = []
    taken: set[str] = set()
    for name in sorted(held, key=lambda one: len(held[one])):
        fit = [q for q in coordinates if q in held[name] - taken and evidence.is_nowhere_zero(_slope(lefts[name], q))]
        if fit:
            order.insert(0, [name, fit[0]])
            taken |= held[name]
    return order


def _slope(left: Tree, q: str) -> Tree:
    return put_in(ZERO, q, left)[0]


def with_puts(scenery: Scenery, tree: Tree, order: Order) -> Tree:
    """A tree with coordinates put in."""
    for name, q in order:
        tree = put_in(tree, q, scenery.evidence.relation(name).left)[1]
    return tree


def needed_puts(scenery: Scenery, trees: Iterable[Tree], order: Order) -> Order:
    """Those that change trees."""
    held, found = frozenset[str]().union(*(tree.symbols for tree in trees)), Order()
    for name, q in order:
        if q in held:
            found.append([name, q])
            held |= scenery.evidence.relation(name).left.symbols
    return found


def solved_pairs(scenery: Scenery, names: Sequence[str], point: FoundPoint) -> list[str]:
    """Steps by which coordinates are 0: of two relations that are linear in them, and hold nothing beside."""
    found = []
    short = [name for name in names if scenery.evidence.relation(name).left.size <= LARGEST_OF_PAIR]
    for pair in combinations(short, 2):
        for step in _pair_steps(scenery, pair, point):
            if _stands(scenery, step):
                found.append(str(step["id"]))
    return found


def _stands(scenery: Scenery, step: dict[str, object]) -> bool:
    """Whether a step is there, or can be added."""
    if scenery.has_step(str(step["id"])):
        return True
    try:
        scenery.add_step(step)
    except CheckError:
        return False
    return True


def _pair_steps(scenery: Scenery, pair: tuple[str, str], point: FoundPoint) -> Iterator[dict[str, object]]:
    lefts = [scenery.evidence.relation(name).left for name in pair]
    shared = lefts[0].symbols & lefts[1].symbols
    for one, other in combinations([q for q in scenery.problem.coordinates if q in shared], 2):
        parts = [linear_in(left, (one, other)) for left in lefts]
        if any(part is None or not scenery.evidence.ring.vanishes(part[1]) for part in parts):
            continue
        (a, b), (c, d) = ([part[0].get(q, ZERO) for q in (one, other)] for part in parts if part is not None)
        h = difference(times(a, d), times(b, c))
        if not _differs(scenery, h, point):
            continue
        for q, factors in ((one, (d, negative(b))), (other, (negative(c), a))):
            told = {"h": text_of(h), "c": {name: text_of(part) for name, part in zip(pair, factors, strict=True)}}
            yield {"id": f"{scenery.label}{q} by {' and '.join(pair)}", "by": "implied", "function": q, **told}


def _differs(scenery: Scenery, tree: Tree, point: FoundPoint) -> bool:
    try:
        return abs(Estimates(point.floats).value(scenery.chosen(tree))) > FAR
    except NoEstimateError:
        return False
