"""What can go without changing the freedom: constraints left out one by one, the last in the order first."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.base.deadline import check, limited
from dofkit.classification.dependence.by_implication import LEAVING_SECONDS
from dofkit.classification.dependence.circuits import Redundancies
from dofkit.classification.freedom.block import answer
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, split
from dofkit.relations.normal.normal_form import Finite, Still
from dofkit.relations.setting import Setting


def by_leaving_out(block: Block, setting: Setting, a: Answer, nullity: int) -> Redundancies:
    """What can go, the last in the order first, without changing the freedom of the block."""
    owners = list(dict.fromkeys(owners_of(block)))
    differential = {r.constraint for r in block.rows if not isinstance(r.piece, Finite)}
    integrated = {r.constraint for r in block.rows if _constant(r) is not None}
    order = sorted(owners, key=lambda o: (o in differential) + (o in integrated))
    kept = list(order)
    with limited(LEAVING_SECONDS):
        for owner in reversed(order):
            if len(kept) < 2:
                break
            check()
            fewer = [r for r in block.rows if r.constraint in kept and r.constraint != owner]
            if _same_freedom(block, fewer, setting, a):
                kept.remove(owner)
    redundant = sorted(set(order) - set(kept))
    nullity = max(nullity, sum(owners_of(block).count(o) for o in redundant))
    members = sorted(order) if redundant else []
    groups = [(nullity, members)] if redundant else []
    independent = {o: 0 if o in redundant else owners_of(block).count(o) for o in order}
    if sum(independent.values()) != len(block.rows) - nullity:
        independent = {o: k for o, k in independent.items() if k < 2}
    return Redundancies(independent, redundant, groups, {o: sorted(kept) for o in redundant})


def owners_of(block: Block) -> list[int]:
    """The constraint that wrote each row."""
    return [r.constraint for r in block.rows]


def _same_freedom(block: Block, rows: Sequence[Row], setting: Setting, a: Answer) -> bool:
    gone = {_constant(r) for r in block.rows} - {_constant(r) for r in rows}
    blocks, untouched = split([c for c in block.coordinates if c not in gone], rows)
    answers = [answer(b, setting) for b in blocks]
    if any(x.dof is None or x.velocity_dof is None for x in answers):
        return False
    dof = len(untouched) + sum(x.dof or 0 for x in answers)
    velocity = len(untouched) + sum(x.velocity_dof or 0 for x in answers)
    needed = {g for g in a.hidden if gone.isdisjoint(str(s.args[1]) for s in g.symbols)}
    had_finite = {g for x in answers for g in x.hidden} >= needed
    return dof == a.dof and velocity == a.velocity_dof and had_finite


def _constant(row: Row) -> str | None:
    """The constant of integration C of a row dC = 0."""
    return next(iter(row.piece.coefficients)) if isinstance(row.piece, Still) else None
