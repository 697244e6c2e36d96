"""Steps of a certificate: coordinates put in, and relations that follow from others; sums of squares."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial, reduce
from itertools import chain, combinations

from flint import fmpq, fmpq_mat

from dofkit.checker.ring import Quotient
from dofkit.checker.trees import ONE, ZERO, CheckError, Tree, linear_in, put_in, substituted
from dofkit.methods.certificates.points import FoundPoint
from dofkit.methods.certificates.scenery import Scenery, text_of

Step = dict[str, object]


def is_accepted(scenery: Scenery, step: Step) -> bool:
    """Return whether a step stands up; one that is there already does."""
    try:
        if str(step["id"]) not in scenery.steps:
            scenery.add_step(step)
    except CheckError:
        return False
    return True


# Coordinates that geometric equations give by others: put into a relation, they may leave nothing of it.

#: Relations, each with the coordinate that it gives; whether it gives it.
Order = list[list[str]]
Gives = Callable[[str, str], bool]
#: Relations that are longer are not solved in pairs.
LARGEST_OF_PAIR = 30


def solving_order(
    names: Iterable[str], scenery: Scenery, columns: Sequence[str], gives: Gives, skips: bool = False
) -> tuple[Order, list[str]]:
    """Return relations with a coordinate each that those before do not hold, and the relations left over.

    The last alone holds its coordinate, of the others again the last, and so on. ``skips``: where none does, the one
    that holds most is left over; else all are.
    """
    held = {name: moved_by(scenery, name) for name in names}
    order, skipped = Order(), list[str]()
    while held:
        alone = {q for q, often in Counter(chain(*held.values())).items() if often == 1}
        free = ([name, q] for q in columns if q in alone for name in held if q in held[name] and gives(name, q))
        if (pair := next(free, None)) is not None:
            order.insert(0, pair)
        elif not skips:
            return order, [*held]
        else:
            skipped.append(max(held, key=lambda name: len(held[name])))
        del held[pair[0] if pair else skipped[-1]]
    return order, skipped


def moved_by(scenery: Scenery, name: str) -> set[str]:
    """The variables of a geometric equation; those with velocities in another."""
    equation, variables = scenery.evidence.relation(name), scenery.evidence.variables
    dot = "" if equation.kind == "finite" else "dot"
    return {q for q in variables if q + dot in equation.tree.symbols}


def puts(scenery: Scenery, names: Sequence[str]) -> Order:
    """Return geometric equations with the coordinates that they give, in the order in which these are put into others.

    The later one is put in, the fewer coordinates its relation holds that another one gives.
    """
    finite = [name for name in names if scenery.evidence.relation(name).kind == "finite"]
    order, _ = solving_order(finite, scenery, scenery.problem.coordinates, partial(_gives, scenery), skips=True)
    return order[::-1]


def _gives(scenery: Scenery, name: str, q: str) -> bool:
    """Return whether an equation is linear in a coordinate with a factor that is nowhere 0."""
    evidence = scenery.evidence
    tree = evidence.relation(name).tree
    return evidence.once(("gives", name, q), lambda: evidence.is_nowhere_zero(put_in(ZERO, q, tree)[0]))


def with_puts(scenery: Scenery, tree: Tree, order: Order) -> Tree:
    """A tree with coordinates put in."""
    for name, q in order:
        tree = put_in(tree, q, scenery.evidence.relation(name).tree)[1]
    return tree


def needed_puts(scenery: Scenery, trees: Iterable[Tree], order: Order) -> Order:
    """Those that change trees."""
    held, needed = frozenset[str]().union(*(tree.symbols for tree in trees)), Order()
    for name, q in order:
        if q in held:
            needed.append([name, q])
            held |= scenery.evidence.relation(name).tree.symbols
    return needed


def solved_pairs(scenery: Scenery, names: Sequence[str], point: FoundPoint) -> list[str]:
    """Add the steps that prove coordinates to be 0 and that the checker accepts; return their ids.

    Two relations that are linear in the same coordinates, without other terms, are satisfied by 0 only where their
    determinant is not 0.
    """
    ids = []
    short = [name for name in names if scenery.evidence.relation(name).tree.size <= LARGEST_OF_PAIR]
    for pair in combinations(short, 2):
        for step in _pair_steps(scenery, pair, point):
            if is_accepted(scenery, step):
                ids.append(str(step["id"]))
    return ids


def _pair_steps(scenery: Scenery, pair: tuple[str, str], point: FoundPoint) -> Iterator[dict[str, object]]:
    lefts = [scenery.evidence.relation(name).tree for name in pair]
    shared = lefts[0].symbols & lefts[1].symbols
    for first, other in combinations([q for q in scenery.problem.coordinates if q in shared], 2):
        linear = [linear_in(tree, (first, other)) for tree in lefts]
        if any(part is None or not scenery.evidence.ring.vanishes(part[1]) for part in linear):
            continue
        (a, b), (c, d) = ([part[0].get(q, ZERO) for q in (first, other)] for part in linear if part is not None)
        h = a * d - b * c
        if not scenery.differs(h, point.estimates):
            continue
        for q, factors in ((first, (d, -b)), (other, (-c, a))):
            multipliers = {
                "h": text_of(h),
                "c": {name: text_of(part) for name, part in zip(pair, factors, strict=True)},
            }
            yield {"id": f"{scenery.label}{q} by {' and '.join(pair)}", "by": "implied", "function": q, **multipliers}


# Rows that follow from others: cofactors by linear algebra over the rationals.

#: The most terms of all relations that are combined, as they are written and multiplied out.
MOST_TERMS = 4_000


def accounted(scenery: Scenery, name: str, rows: Sequence[str], point: FoundPoint, what: str = "others") -> bool:
    """Whether a step was found by which others imply a relation near the point.

    The cofactors are numbers: as the relations are, or after coordinates that some of them give are put in.
    """
    dependent = scenery.evidence.relation(name)
    sources = [row for row in rows if scenery.evidence.relation(row).kind == dependent.kind]
    if dependent.kind == "velocity":
        sources += [rate for row in rows if row not in sources and (rate := rate_of(scenery, row))]
    step = f"{scenery.label}{name} from {what}"
    if step in scenery.steps:
        return True
    try:
        if (factors := constant_cofactors(scenery, dependent.tree, sources)) is not None:
            return is_accepted(scenery, {"id": step, "by": "implied", "of": name, "c": factors})
        finite = [row for row in sources if scenery.evidence.relation(row).kind == "finite"]
        order = puts(scenery, [*solved_pairs(scenery, finite, point), *finite])
        factors = constant_cofactors(scenery, dependent.tree, sources, order) if order else None
    except CheckError:
        return False
    if factors is None:
        return False
    used = [scenery.evidence.relation(row).tree for row in (name, *factors)]
    put = needed_puts(scenery, used, order)
    return is_accepted(scenery, {"id": step, "by": "implied", "of": name, "c": factors, "put": put})


def constant_cofactors(
    scenery: Scenery, target: Tree, names: Sequence[str], order: Order | None = None
) -> dict[str, str] | None:
    """Numbers c with target = sum c_i relation_i in the checker's ring, by linear algebra over Q; or None.

    ``order``: coordinates that relations give are put in first; those relations are 0 then.
    """
    ring, put = scenery.evidence.ring, order or []
    used = [name for name in names if all(name != row for row, _ in put)]
    trees = [*(scenery.evidence.relation(name).tree for name in used), target]
    if sum(tree.size for tree in trees) > MOST_TERMS:
        return None
    quotients = [ring.read(with_puts(scenery, substituted(tree, {"tdot": ONE}), put)) for tree in trees]
    if any(len(below) > 1 for _, below in quotients) or sum(len(above) for above, _ in quotients) > MOST_TERMS:
        return None
    denominator = Quotient(reduce(lambda a, b: a * b / a.gcd(b), (q.below for q in quotients), ring.unit), ring.unit)
    columns = [ring.times(quotient, denominator).above.to_dict() for quotient in quotients]
    monomials = sorted({key for column in columns for key in column})
    entries = [column.get(key, fmpq(0)) for key in monomials for column in columns]
    matrix, rank = fmpq_mat(len(monomials), len(columns), entries).rref()
    leads = [next(j for j in range(len(columns)) if matrix[i, j] != 0) for i in range(rank)]
    if len(used) in leads:
        return None
    return {used[lead]: str(matrix[i, len(used)]) for i, lead in enumerate(leads) if matrix[i, len(used)] != 0}


def rate_of(scenery: Scenery, name: str) -> str:
    """Return the id of a step for the rate of a configuration-level equation; "" where it does not stand up."""
    step = f"{scenery.label}rate of {name}"
    return step if is_accepted(scenery, {"id": step, "by": "rate", "of": name}) else ""
