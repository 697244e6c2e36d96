"""Evidence that relations cannot be met: combinations that leave a number over, sums of squares."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from flint import fmpq, fmpq_mat

from dofkit.checker.trees import ONE, Tree, substituted
from dofkit.methods.certificates.room import Room, Told
from dofkit.methods.certificates.scenery import number_text, text_of
from dofkit.methods.certificates.steps import positive_sum, rate_of

Monomial = tuple[int, ...]
Polynomial = dict[Monomial, Fraction]
MOST_MONOMIALS = 400


def inconsistent(room: Room) -> Iterator[Told]:
    """No configuration, or no motion, meets the equations."""
    yield from refutations(room, [one.name for one in room.problem.relations])


def conflicting(room: Room) -> Iterator[Told]:
    """The constraints that cannot be met together, each of them needed."""
    evidence, members = room.scenery.evidence, room.report.conflicting
    kinds = ("finite", "velocity", "inequality")
    for found in refutations(room, [one for name in members for one in evidence.owned(name, kinds)]):
        minimal: Told = {}
        for name in members:
            others = [one for other in members if other != name for one in evidence.owned(other)]
            if others and (told := _met(room, name, others)):
                minimal[name] = told
        yield {"rule": "conflict", "refutation": found, "minimal": minimal}


def _met(room: Room, name: str, others: Sequence[str]) -> Told | None:
    """What shows that the others can be met without one."""
    relation = room.scenery.evidence.relation
    finite = [one for one in others if relation(one).kind == "finite"]
    point = room.search.somewhere(finite, room.problem.coordinates, 300)
    if point is None:
        return None
    point.name = f"without {name}"
    room.add_point(point)
    standing = room.standing_of(others, point=point)
    if standing is not None and standing.rows and not standing.dependent:
        return {"rule": "regular", "minor": room.minor(standing)}
    return {"rule": "point", "at": point.name}


def refutations(room: Room, names: Sequence[str]) -> Iterator[Told]:
    """Ways in which relations cannot be met."""
    evidence = room.scenery.evidence
    equations = [name for name in names if evidence.relation(name).kind != "inequality"]
    rates = [
        rate for name in equations if evidence.relation(name).kind == "finite" and (rate := rate_of(room.scenery, name))
    ]
    for chosen in (equations, [*equations, *rates]):
        if (found := combination(room, chosen)) is not None:
            yield found
    for name in names:
        yield from _by_squares(room, name)


def polynomials(room: Room, trees: Sequence[Tree]) -> tuple[list[Polynomial], list[Tree]] | None:
    """Trees as polynomials in the ring's generators with one denominator left out; None where it differs."""
    ring = room.scenery.evidence.ring
    put_in = [substituted(tree, {"tdot": ONE}) for tree in trees]
    for tree in put_in:
        ring.read(tree)
    normals = [ring.read(tree) for tree in put_in]
    if any(not normal.below.is_constant() for normal in normals):
        return None
    found = []
    for normal in normals:
        under = normal.below.leading_coefficient()
        terms = {key[::-1]: value / under for key, value in normal.above.to_dict().items()}
        found.append({key: Fraction(int(value.p), int(value.q)) for key, value in terms.items()})
    return found, list(trees)


def combination(room: Room, names: Sequence[str]) -> Told | None:
    """Numbers c with sum c_i relation_i = -1."""
    read = polynomials(room, [room.scenery.evidence.relation(name).left for name in names])
    if read is None:
        return None
    monomials = sorted({key for one in read[0] for key in one})
    if not monomials or len(monomials) > MOST_MONOMIALS:
        return None
    matrix = [[_rational(one.get(key, Fraction(0))) for one in read[0]] for key in monomials]
    constant = tuple(0 for _ in monomials[0])
    found = solution(matrix, [fmpq(-1 if key == constant else 0) for key in monomials])
    if found is None or constant not in monomials:
        return None
    told = {name: number_text(value) for name, value in zip(names, found, strict=True) if value}
    return {"rule": "nullstellensatz", "c": told, "number": "1"}


def solution(matrix: Sequence[Sequence[fmpq]], right: Sequence[fmpq]) -> list[Fraction] | None:
    """One solution of linear equations over the rationals; None where there is none."""
    width = len(matrix[0])
    entries = [x for row, b in zip(matrix, right, strict=True) for x in (*row, b)]
    reduced, rank = fmpq_mat(len(matrix), width + 1, entries).rref()
    found = [Fraction(0)] * width
    for i in range(rank):
        lead = next(j for j in range(width + 1) if reduced[i, j] != 0)
        if lead == width:
            return None
        value = reduced[i, width]
        found[lead] = Fraction(int(value.p), int(value.q))
    return found


def _rational(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)


def _by_squares(room: Room, name: str) -> Iterator[Told]:
    """Yield evidence that one relation is never satisfied: it is a positive number and squares, or their negative."""
    one = room.scenery.evidence.relation(name)
    for sign in (1, -1):
        positive = positive_sum(one.left, sign)
        if positive is None:
            continue
        squares = [[c, text_of(base)] for c, base in positive[1]]
        claim: Told = {"rule": "nullstellensatz", "number": positive[0], "sos": squares}
        if one.kind != "inequality":
            yield {**claim, "c": {name: number_text(-sign)}}
        elif sign == -1:
            yield {**claim, "inequality": {name: [["1", "1"]]}}
