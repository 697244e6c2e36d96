"""The largest integrable part of a scene's differential constraints, as finite relations."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.labels.companions import Companionship
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.expressions.text import to_text
from dofkit.relations.blocks import Block
from dofkit.relations.normal.pieces import Pfaffian, Still
from dofkit.report import ConstraintEntry, IntegrablePart


def integrable_part(
    outcome: Outcome, entries: Sequence[ConstraintEntry], company: Companionship
) -> IntegrablePart | None:
    """What the differential constraints say in finite relations; None where there are none or it is undecided.

    The rank of I^(inf), the bottom of the derived flag, over all coordinates; its basis beyond the finite relations
    that were written: hidden ones, and integrals of which each block's are independent.
    """
    blocks = [(b, a) for b, a in zip(outcome.blocks, outcome.answers, strict=True) if b.forms]
    if not blocks or outcome.dof is None:
        return None
    coordinates = len(outcome.untouched) + sum(len(b.coordinates) - _constants(b) for b in outcome.blocks)
    basis: list[str] | None = []
    for block, a in blocks:
        known = len(block.finite) + len(a.hidden)
        finite = rank_of_rows(a.matrix[:known], a.modulus) if a.matrix else known
        left = len(block.coordinates) - (a.dof or 0) - finite
        left -= _constants(block)
        found = _integrals(block, left, entries, company) if left > 0 else []
        if found is None or basis is None:
            basis = None
        else:
            basis += [f"{to_text(g)} = 0" for g in a.hidden] + found
    return IntegrablePart(rank=coordinates - outcome.dof, basis=basis)


def _constants(block: Block) -> int:
    """Return the number of constants of an earlier integration, which are coordinates of the block and do not move."""
    return sum(isinstance(r.piece, Still) for r in block.rows)


def _integrals(
    block: Block, number: int, entries: Sequence[ConstraintEntry], company: Companionship
) -> list[str] | None:
    """So many independent integrals of a block; None where fewer were found."""
    owners = {r.constraint for r in block.rows if isinstance(r.piece, Pfaffian)}
    alone = [entries[i].integral for i in owners]
    if number == len(alone) == 1 and alone[0] is not None:
        return [alone[0]]
    found = company.basis(block)
    return found if len(found) == number else None
