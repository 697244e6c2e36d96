"""Rows that follow from others: cofactors by linear algebra over the rationals."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from flint import fmpq, fmpq_mat

from dofkit.checker.derivatives import symbols_in
from dofkit.checker.errors import CheckError
from dofkit.methods.certificates.points import FoundPoint
from dofkit.methods.certificates.scenery import Scenery
from dofkit.methods.certificates.texts import number_text

#: Monomials and unknowns of an ansatz at most.
LARGEST_ANSATZ = 600


def accounted(scenery: Scenery, name: str, rows: Sequence[str], point: FoundPoint) -> bool:
    """Whether a step was found by which a relation follows from others near the point."""
    own = scenery.evidence.relation(name)
    kinds = [row for row in rows if scenery.evidence.relation(row).kind == own.kind]
    step = f"{scenery.label}{name} from others"
    if step in scenery.evidence.known:
        return True
    try:
        factors = constant_cofactors(scenery, name, kinds)
        if factors is not None:
            found = {row: number_text(value) for row, value in factors.items()}
            scenery.add_step({"id": step, "by": "implied", "of": name, "c": found})
            return True
    except CheckError:
        return False
    return False


def constant_cofactors(scenery: Scenery, name: str, rows: Sequence[str]) -> dict[str, Fraction] | None:
    """Numbers c with relation = sum c_i row_i; None where there are none."""
    ring = scenery.evidence.ring
    targets = [scenery.evidence.relation(one).left for one in (name, *rows)]
    held = symbols_in(targets[0])
    used = [0, *(i for i, tree in enumerate(targets) if i and not held.isdisjoint(symbols_in(tree)))]
    normals = [ring.normal(targets[i]) for i in used]
    normals = [ring._fresh(normal) for normal in normals]
    common = ring.one
    for normal in normals:
        common = common * (normal.below / common.gcd(normal.below))
    parts = [dict((normal.above * (common / normal.below)).to_dict()) for normal in normals]
    monomials = sorted({key for part in parts for key in part})
    if len(monomials) > LARGEST_ANSATZ or len(used) > LARGEST_ANSATZ:
        return None
    found = solution(
        [[part.get(key, fmpq(0)) for part in parts[1:]] for key in monomials],
        [parts[0].get(key, fmpq(0)) for key in monomials],
    )
    if found is None:
        return None
    return {rows[i - 1]: value for i, value in zip(used[1:], found, strict=True) if value}


def solution(matrix: Sequence[Sequence[fmpq]], right: Sequence[fmpq]) -> list[Fraction] | None:
    """One solution of linear equations over the rationals; None where there is none."""
    if not matrix:
        return []
    width = len(matrix[0])
    reduced, rank = fmpq_mat(
        len(matrix), width + 1, [x for row, b in zip(matrix, right, strict=True) for x in (*row, b)]
    ).rref()
    found = [Fraction(0)] * width
    for i in range(rank):
        lead = next(j for j in range(width + 1) if reduced[i, j] != 0)
        if lead == width:
            return None
        value = reduced[i, width]
        found[lead] = Fraction(int(value.p), int(value.q))
    return found
