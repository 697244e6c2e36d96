"""How sure every field of the report is: by which argument, with what chance of an error, and of which points.

A field that is worked out from others is as sure as the weakest of them; an errors' chance adds up.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from dofkit.base.verdicts import OPEN, VERDICTS, ArgumentKey, Claim, least, together
from dofkit.classification.generalized_coordinates import claim_of_choice, counted
from dofkit.classification.study import Study
from dofkit.integrability.growth_vector import is_free
from dofkit.relations.answer import BITS
from dofkit.report import ConstraintEntry, FieldVerdict

#: Rows that depend on each other at points over GF(p), and what the others imply at drawn states.
HOLDS = Claim("proved", "zero at the reference", about="reference")
ROWS = Claim("probable", "rows at a point", bits=BITS)
IMPLIED = Claim("probable", "implication", bits=BITS)
#: Arguments that tell what depends on what as well.
SETTLED: frozenset[ArgumentKey | None] = frozenset({"links in general position", "exact elimination"})
LEFT_OUT = Claim("probable", "leaving out", bits=BITS)


def claims(study: Study, told: Mapping[str, Any]) -> dict[str, Claim]:
    """The claim of every field that the report decides, or leaves open."""
    free = freedom(study)
    found = {"consistent": consistency(study)}
    if told["consistent"] is False:
        found["conflicting"] = _conflict(study, found["consistent"])
    else:
        found |= {"dof": _unless(told["dof"], free), "velocity_dof": _unless(told["velocity_dof"], free)}
        found["redundant_equations"] = _unless(told["redundant_equations"], counted(free))
        found["redundant"] = _unless(told["redundant"], _dependence(study, free, bool(told["redundant"])))
        found["redundancies"] = _unless(told["redundant"], _dependence(study, free, bool(told["redundancies"])))
        claim = claim_of_choice(study, free, told["generalized_coordinates"] or ())
        found["generalized_coordinates"] = _unless(told["generalized_coordinates"], claim)
    if study.system.reference is not None and told["consistent"] is not False:
        first = first_order(study)
        found["instantaneous_dof"] = _unless(told["instantaneous_dof"], first)
        found["singular"] = _unless(told["singular"], together(first, free))
    for name in ("holonomic", "scleronomic"):
        found[name] = of_entries(told["constraints"], name, told[name])
    if told["growth_vector"] is not None:
        found["growth_vector"] = _growth(study, free, told["growth_vector"])
    if told["integrable_part"] is not None:
        found["integrable_part"] = free
    return found


def _unless(value: Any, claim: Claim) -> Claim:
    """The claim; open where there is no value."""
    return OPEN if value is None else claim


def freedom(study: Study) -> Claim:
    """Of the freedoms: the answers of all blocks together."""
    return together(*(a.claim for a in study.outcome.answers))


def consistency(study: Study) -> Claim:
    """That there is a motion: so the blocks say; that there is none: the surest of them that says so."""
    outcome = study.outcome
    if outcome.consistent is None:
        return OPEN
    if outcome.consistent:
        return together(*(HOLDS if a.exists else a.claim for a in outcome.answers))
    if outcome.impossible:
        return Claim("proved", "inequality nowhere")
    against = [a.claim for a in outcome.answers if a.consistent is False]
    return min(against, key=lambda c: VERDICTS.index(c.verdict))


def _conflict(study: Study, against: Claim) -> Claim:
    """Of a minimal set that cannot hold together: without any one of them the others do, which may be proved."""
    members, minimal = study.dependence.conflicting
    if not members:
        return OPEN
    return against if minimal else together(against, LEFT_OUT)


def first_order(study: Study) -> Claim:
    """Of the velocities at the reference: ranks there, which are exact where no row depends on others."""
    parts = [a.first_order for a in study.outcome.answers]
    return replace(together(*parts), about="reference")


def of_entries(entries: Sequence[ConstraintEntry], name: str, value: bool | None) -> Claim:
    """Of a label of the whole: all entries' where it is true, the surest that is false where it is not."""
    if value is None:
        return OPEN
    if value:
        known = {id(e.verdicts): _claim(e.verdicts[name]) for e in {id(e.verdicts): e for e in entries}.values()}
        return together(*[known[id(e.verdicts)] for e in entries])
    against = [e.verdicts[name] for e in entries if getattr(e, name) is False]
    return _claim(min(against, key=lambda v: VERDICTS.index(v.verdict)))


def _claim(told: FieldVerdict) -> Claim:
    """A claim again from what an entry tells of it."""
    if told.verdict == "undecided":
        return OPEN
    bits = int(told.bound.removeprefix("2^-")) if told.verdict == "probable" and told.bound else None
    gap = float(told.bound) if told.verdict == "numeric" and told.bound else None
    return Claim(told.verdict, told.argument, bits, gap, told.about or "everywhere")


def _dependence(study: Study, free: Claim, some: bool) -> Claim:
    """Of what depends on what: nothing does where the count says so; links in general position by their graph."""
    if not some and study.redundant_equations == 0:
        return counted(free)
    copied = {study.names[i] for i in study.outcome.copies}
    if {study.names[i] for r in study.dependence.dependent for i in r.redundant} <= copied:
        return free
    settled = {a.argument for a in study.outcome.answers if a.velocity_dof is not None} <= SETTLED
    if settled:
        return free
    return replace(together(free, ROWS, IMPLIED), about=least(study.dependence.about, free.about))


def _growth(study: Study, free: Claim, growth: Sequence[int]) -> Claim:
    """Of the growth vector: its first and last numbers are those of the freedoms; others are ranks over GF(p).

    Those are not too large where what is not 0 there is not 0; nor too small where no more brackets there are.
    """
    blocks = [
        (a.growth, a.trusted) for b, a in zip(study.outcome.blocks, study.outcome.answers, strict=True) if b.forms
    ]
    if len(growth) == 1 or (len(growth) == 2 and all(trusted for _, trusted in blocks)):
        return counted(free)
    if free.verdict == "proved" and all(trusted and own and is_free(own) for own, trusted in blocks):
        return replace(free, argument="free Lie algebra")
    return together(free, Claim("probable", "brackets at points", bits=BITS))
