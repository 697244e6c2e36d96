"""Whether time occurs in a constraint, and what all its pieces carry: scleronomic, catastatic, exact."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from dofkit.base.verdicts import Verdict, weakest
from dofkit.classification.labels.reasons import Others
from dofkit.expressions import tree as ex
from dofkit.integrability.traits import TraitAnswer, Traits, all_of, vanishes_on
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.notes import INSTANT_NOTE
from dofkit.relations.normal.pieces import Clause, Finite, Normal, Pfaffian, Piece
from dofkit.relations.setting import Setting
from dofkit.report import Form


class EntryLabels(NamedTuple):
    """Holonomic in the system and alone, and how sure each is."""

    in_system: bool | None
    alone: bool | None
    verdicts: tuple[Verdict, Verdict]


class EntryTraits(NamedTuple):
    """What all pieces of a constraint carry, and how sure each label is.

    ``by``: the field on which ``scleronomic`` rests where t does not occur in the constraint as it is written, and a
    term without velocities does: whether it integrates.
    """

    scleronomic: bool | None
    catastatic: bool | None
    exact: bool | None
    verdicts: Mapping[str, Verdict]
    by: str | None = None


def timed_in_system(
    piece: Clause, block: Block | None, answer: Answer, others: Others, setting: Setting
) -> TraitAnswer:
    """Return whether t occurs in what a form integrates to with the others: not where its dt term is 0 on their set."""
    sure: Verdict = "proved" if others.identically else "probable"
    if others.timed is False or not isinstance(piece, Pfaffian) or block is None:
        return others.timed, sure
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)]
    for g in (*finite, *answer.hidden):
        still, found = vanishes_on(g, piece.dt, setting.positive)
        if still:
            return False, found
    return others.timed, sure


def declared_functions(normals: Sequence[Normal]) -> list[Piece]:
    """Return the branches of products that are a declared function being 0, which is generic: a factor to take out."""
    return [
        b[0]
        for n in normals
        for b in n.branches
        if len(n.branches) > 1 and len(b) == 1 and isinstance(b[0], Finite) and b[0].expr.op == "call"
    ]


def traits_together(
    traits: Sequence[Traits], form: Form, labels: EntryLabels, timed: TraitAnswer | None
) -> EntryTraits:
    """Return the traits of a constraint from those of its equations, with the time of what it integrates to."""
    timeless = all_of([t.timeless for t in traits])
    still = all_of([t.catastatic for t in traits if t.catastatic is not None])
    closed = all_of([t.exact for t in traits if t.exact is not None])
    scleronomic, by = _scleronomic(timeless, still, form, labels, timed)
    return EntryTraits(
        scleronomic[0],
        still[0] if form in ("pfaffian", "nonlinear") else None,
        closed[0] if form == "pfaffian" else None,
        {"scleronomic": scleronomic[1], "catastatic": still[1], "exact": closed[1]},
        by,
    )


def branches_of_time(normals: Sequence[Normal], consistent: bool) -> Iterator[Traits]:
    """Yield that it is undecided whether t occurs where branches hold at different times, or one does at an instant.

    The latter was left out, which changes nothing where motions satisfy the others.
    """
    for n in normals:
        conditions = ([p.expr for p in b if isinstance(p, DomainCondition)] for b in n.branches)
        intervals = {frozenset(e for e in of_branch if ex.TIME in e.symbols) for of_branch in conditions}
        if len(intervals) > 1 or (INSTANT_NOTE in n.notes and not consistent):
            yield Traits((None, "undecided"))


def _scleronomic(
    timeless: TraitAnswer, still: TraitAnswer, form: Form, labels: EntryLabels, timed: TraitAnswer | None
) -> tuple[TraitAnswer, str | None]:
    """Return whether t occurs neither in a constraint nor in what it integrates to, and the field on which that rests.

    A constraint without t that is homogeneous in the velocities integrates to a relation without t. One that is not,
    and integrates alone, has t in its integral, whose derivative by t is not 0.
    """
    if timeless[0] is False or still[0]:
        return timeless, None
    in_system, alone = labels.verdicts
    if still[0] is False and form in ("pfaffian", "nonlinear"):
        if labels.alone:
            return (False, weakest(still[1], alone)), "holonomic_alone"
        if labels.in_system is False:
            return (timeless[0], weakest(timeless[1], in_system)), "holonomic"
        if labels.in_system and timed is not None and timed[0] is not None:
            sure = weakest(timeless[1], still[1], in_system, timed[1])
            return (False if timed[0] else timeless[0], sure), "holonomic"
    return (None, "undecided"), None


def reason_of_time(traits: EntryTraits) -> str:
    """Return a sentence about a constraint that is not homogeneous in the velocities, if it is one."""
    if traits.by is None or traits.scleronomic is None:
        return ""
    if traits.scleronomic:
        return " It is not homogeneous in the velocities: acatastatic."
    return " Time occurs in the relation that it integrates to: rheonomic."
