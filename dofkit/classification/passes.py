"""The passes that fill the fields of a report, in their order, and the laws that fields have to obey."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

from dofkit.base.deadline import DEFAULT_SECONDS, gc_rarely, limited, part, unless_late
from dofkit.base.verdicts import OPEN, VERDICTS, Claim, together, weakest
from dofkit.classification import study as fields
from dofkit.classification.counts import counts_beside
from dofkit.classification.feasibility.feasibility import inequalities_together
from dofkit.classification.freedom.preparation import all_of
from dofkit.classification.generalized_coordinates import generalized_coordinates
from dofkit.classification.special import special_cases
from dofkit.classification.study import Decided, Study, counted, decided, study
from dofkit.exact.points.balls import precise_for
from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions.text import to_text
from dofkit.mobility.counts import without_drives
from dofkit.relations.answer import DEFECTS
from dofkit.report import BRANCH_WARNING, ConstraintEntry, FieldVerdict, ForceEntry, Mobility, Report
from dofkit.system import BINDING, System

#: Fields of the constraints' entries that are withheld together with the redundancy of the report.
OF_ENTRIES = ("independent", "circuit", "redundant_equations")
UNDECIDED = FieldVerdict.of(OPEN)
CONTRADICTION = "These fields are withheld because they contradict each other ({law}): {fields}."

Values = Mapping[str, Any]


def _freedoms_agree(values: Values) -> bool:
    """Return whether 0 <= velocity freedom <= freedom <= coordinates, with equality in a holonomic system."""
    dof, velocities, at_reference = (values[k] for k in ("dof", "velocity_dof", "instantaneous_dof"))
    if dof is None or velocities is None:
        return True
    if not 0 <= velocities <= dof <= values["count"].coordinates or (values["holonomic"] and velocities < dof):
        return False
    return at_reference is None or bool(velocities <= at_reference)


def _dependences_agree(values: Values) -> bool:
    """Return whether the numbers of redundant equations by rank, by implication and in the groups agree.

    More may be implied if one equation removes several freedoms. At a singular configuration the groups may have fewer.
    """
    redundant, surplus = values["redundant"], values["redundant_equations"]
    if redundant is None or surplus is None or values["consistent"] is not True:
        return True
    entries: list[ConstraintEntry] = values["constraints"]
    nullity = sum(group.nullity for group in values["redundancies"])
    members = {name for group in values["redundancies"] for name in group.members}
    removed = sum(e.equations for e in entries if e.name in redundant)
    if not members.issuperset(redundant) or removed > nullity:
        return False
    bilateral = [e for e in entries if e.bilateral]
    if any(e.independent is None for e in bilateral):
        return True
    implied = sum(e.equations - (e.independent or 0) for e in bilateral)
    return implied >= surplus and nullity >= surplus and (bool(values["singular"]) or nullity >= implied)


def _circuits_agree(values: Values) -> bool:
    """Return whether circuits belong to redundant constraints and contain only constraints written before them."""
    before = set[str]()
    for e in values["constraints"]:
        if e.circuit is not None and (e.name not in (values["redundant"] or ()) or not before.issuperset(e.circuit)):
            return values["redundant"] is None
        before.add(e.name)
    return True


def _growth_agrees(values: Values) -> bool:
    """Return whether the growth vector begins with the velocity freedom and ends with the freedom (+ 1 with time)."""
    growth, dof, velocities = (values[k] for k in ("growth_vector", "dof", "velocity_dof"))
    if None in (growth, dof, velocities):
        return True
    time = growth[0] - velocities
    return growth == sorted(growth) and time == growth[-1] - dof and time in (0, 1)


def _choice_agrees(values: Values) -> bool:
    chosen, dof = values["generalized_coordinates"], values["dof"]
    return chosen is None or dof is None or len(chosen) == dof


class Agreement(NamedTuple):
    """A law in words, the ``fields`` that are withheld if it is broken, and the function that checks it."""

    law: str
    fields: tuple[str, ...]
    holds: Callable[[Values], bool]


_REDUNDANCY = ("redundant", "redundancies", "redundant_equations")
AGREEMENTS: tuple[Agreement, ...] = (
    Agreement(
        "the velocity freedom exceeds neither the degrees of freedom nor the instantaneous freedom",
        ("dof", "velocity_dof", "instantaneous_dof", "singular"),
        _freedoms_agree,
    ),
    Agreement(
        "as many equations are redundant by rank, by implication and in the groups", _REDUNDANCY, _dependences_agree
    ),
    Agreement("a circuit belongs to a redundant constraint and was written before it", _REDUNDANCY, _circuits_agree),
    Agreement(
        "the growth vector begins with the velocity freedom and ends with the degrees of freedom",
        ("growth_vector",),
        _growth_agrees,
    ),
    Agreement("there are as many generalized coordinates as freedoms", ("generalized_coordinates",), _choice_agrees),
)


def agreed(values: Values) -> dict[str, Any]:
    """Return the fields of a report, those that contradict each other set to None with a warning."""
    kept = dict(values)
    for row in AGREEMENTS:
        if not row.holds(values):
            DEFECTS.error("defect in the report of %r: %s is not so", values["scene"], row.law)
            kept = _without(kept, row)
    return kept


def _without(values: dict[str, Any], row: Agreement) -> dict[str, Any]:
    """Return the values with the fields of a violated ``row`` withheld, and a warning."""
    withheld: dict[str, Any] = {name: [] if name == "redundancies" else None for name in row.fields}
    verdicts = values["verdicts"] | {name: UNDECIDED for name in row.fields if name in values["verdicts"]}
    warnings = [*values["warnings"], CONTRADICTION.format(law=row.law, fields=", ".join(row.fields))]
    changed = {"warnings": warnings, "verdict": "undecided", "verdicts": verdicts}
    if row.fields == _REDUNDANCY:
        changed["constraints"] = [_with_open_dependence(e) for e in values["constraints"]]
    return {**values, **withheld, **changed}


def _with_open_dependence(e: ConstraintEntry) -> ConstraintEntry:
    verdicts = e.verdicts | {name: UNDECIDED for name in OF_ENTRIES if name in e.verdicts}
    return e.model_copy(update={**dict.fromkeys(OF_ENTRIES), "verdict": "undecided", "verdicts": verdicts})


def of_entries(name: str, study: Study) -> Decided:
    """Return a label of the system: true with the claims of all entries, or false with the most certain false one."""
    entries = study.entries
    value = all_of(getattr(e, name) for e in entries)
    if value is None:
        return Decided(None, OPEN)
    if value:
        claim_of = {id(e.verdicts): _claim(e.verdicts[name]) for e in {id(e.verdicts): e for e in entries}.values()}
        return Decided(True, together(*[claim_of[id(e.verdicts)] for e in entries]))
    against = [e.verdicts[name] for e in entries if getattr(e, name) is False]
    return Decided(False, _claim(min(against, key=lambda v: VERDICTS.index(v.verdict))))


def _claim(field: FieldVerdict) -> Claim:
    """Return the claim that a field of an entry was written from."""
    if field.verdict == "undecided":
        return OPEN
    bits = int(field.bound.removeprefix("2^-")) if field.verdict == "probable" and field.bound else None
    gap = float(field.bound) if field.verdict == "numeric" and field.bound else None
    return Claim(field.verdict, field.argument, bits, gap, field.about or "everywhere")


#: The function that decides each field that has a claim, in the order of the report.
DECIDED: Mapping[str, Callable[[Study], Decided]] = {
    "consistent": fields.consistent,
    "conflicting": fields.conflicting,
    "dof": lambda study: decided(study, study.outcome.dof, study.free),
    "velocity_dof": lambda study: decided(study, study.outcome.velocity_dof, study.free),
    "redundant_equations": lambda study: decided(study, study.redundant_equations, counted(study.free)),
    "redundant": fields.redundant,
    "redundancies": fields.redundancies,
    "generalized_coordinates": generalized_coordinates,
    "instantaneous_dof": fields.instantaneous_dof,
    "singular": fields.singular,
    "holonomic": partial(of_entries, "holonomic"),
    "scleronomic": partial(of_entries, "scleronomic"),
    "growth_vector": fields.growth_vector,
    "integrable_part": fields.largest_integrable_part,
}


#: Share of the time for the analysis of the blocks.
SOLVING = 0.75
NO_SPECIAL_CASES = "There was no time to look for special cases."

#: A pass: returns fields, given the study of a system and the fields filled before.
Fill = Callable[[Study, Values], Values]


def _generic_fields(study: Study, values: Values) -> Values:
    """Return all fields that are read from the study, with the claim of each."""
    del values
    answers = {name: decide(study) for name, decide in DECIDED.items()}
    return {
        "scene": study.system.name,
        "forces": [ForceEntry(name=f.name, reason=f.reason) for f in study.system.forces],
        "constraints": study.entries,
        "count": fields.lecture_count(study),
        "joint_coordinates": fields.joint_coordinates(study),
        "witness": fields.witness(study),
        "method": fields.method(study),
        "modelled": fields.modelled(study.system, study.outcome),
        "warnings": _warnings(study),
        **{name: field.value for name, field in answers.items()},
        **_verdicts({name: field.claim for name, field in answers.items() if field.claim is not None}, study.entries),
    }


def _warnings(study: Study) -> list[str]:
    """Return the warnings: what was noticed while reading, why something is undecided, and hidden equations."""
    answer = list(study.system.warnings)
    answer += [
        f"not read, so the true freedom may be smaller: {t}" for t in study.system.left_out if t.startswith(BINDING)
    ]
    for r in study.reduced:
        for normal in r.normals:
            answer += [f"'{r.constraint.name}': {note}" for note in normal.notes]
            if len(normal.branches) > 1:
                answer.append(BRANCH_WARNING.format(name=r.constraint.name))
        answer += [f"'{r.constraint.name}': {note}" for note in r.constraint.notes]
    answer += [
        f"'{study.names[i]}': whether it can be satisfied at all was not decided" for i in study.outcome.unsettled
    ]
    if study.dependence.conflicting.members and study.dependence.conflicting.claim == OPEN:
        answer.append("Whether every constraint that is named as conflicting is needed for this was not decided.")
    for a in study.outcome.answers:
        answer += a.reasons
        answer += [f"hidden geometric equation: {to_text(g)} = 0" for g in a.hidden]
    if study.outcome.dof is None and study.outcome.consistent is not False:
        answer += [
            f"There is no reference configuration: give {missing}. With a reference configuration more can be decided."
            for missing in _missing_reference(study.system)
        ]
    return list(dict.fromkeys(answer))


def _about_branches(system: System, branches: Sequence[str]) -> Iterator[str]:
    """Yield for each of the ``branches``, the only ones with the report's freedom, how to choose another branch."""
    for branch in branches:
        for missing in _missing_reference(system):
            yield (
                f"The configuration space has branches of different dimension. The degrees of freedom, the redundancy "
                f"and the coordinates are those of the largest branch, {branch}. To choose a branch, give {missing}."
            )


def _missing_reference(system: System) -> Iterator[str]:
    """Yield what has to be added to a scene without a reference configuration to give it one."""
    placed = {str(symbol.args[1]) for symbol in system.pose}
    if system.reference is not None or all(c.name in placed for c in system.coordinates):
        return
    owners = dict.fromkeys(c.owner for c in system.coordinates if c.owner in system.particles and c.name not in placed)
    text = ", ".join([*owners][:8]) + (", ..." if len(owners) > 8 else "")
    wanted = [f"`at` for {text}"] if owners else []
    if system.bodies and system.generic:
        wanted.append("`at` (and `axis`) for the joints")
    if not wanted:
        wanted = ["`configuration`, a value for each coordinate"]
    yield " and ".join(wanted)


def _verdicts(of_fields: Mapping[str, Claim], entries: Sequence[ConstraintEntry]) -> Values:
    """Return the fields ``verdicts`` (of every field) and ``verdict`` (the weakest of them and of all entries)."""
    shared = {id(e.verdicts): e.verdicts for e in entries}.values()
    of_entries = {v.verdict for verdicts in shared for v in verdicts.values()} | {e.verdict for e in entries}
    weak = weakest(*(c.verdict for c in of_fields.values()), *of_entries)
    return {"verdicts": {name: FieldVerdict.of(c) for name, c in of_fields.items()}, "verdict": weak}


def _feasibility(study: Study, values: Values) -> Values:
    """Return the fields about inequalities: whether they can be satisfied together; nothing if there are none."""
    return inequalities_together(study, values) if any(r.inequalities for r in study.reduced) else {}


def _counts(study: Study, values: Values) -> Values:
    """Return the textbook counts, and a warning of a near-dependence; nothing without joints."""
    if not any(c.members for c in study.system.connections):
        return {}
    counts, near = counts_beside(study, values["instantaneous_dof"])
    mobility, released = counts["mobility"], without_drives(study.system)
    if isinstance(mobility, Mobility) and released is not None and values["consistent"] is True:
        nothing: Values = {}
        undriven = unless_late(partial(_velocity_freedom, released), nothing)
        counts = {**counts, "mobility": mobility.model_copy(update=dict(undriven))}
    return {**counts, **({} if near is None else {"warnings": [*values["warnings"], near]})}


def _special(study: Study, values: Values) -> Values:
    """Return the special cases, and a warning if only one of several branches has the report's freedom.

    Nothing if all equations are geometric and there is a reference: the answer is then about this configuration only.
    """
    if study.system.reference is not None and not any(block.forms for block in study.outcome.blocks):
        return {}
    search = partial(special_cases, study, Report(**values), fields.study)
    late: Values = {"warnings": [*values["warnings"], NO_SPECIAL_CASES]}
    special = unless_late(search, late)
    branches = [case.where for case in special.get("special_cases", ()) if case.kind == "branch"]
    warnings = [*special.get("warnings", values["warnings"]), *_about_branches(study.system, branches)]
    return {**special, "warnings": warnings}


def _velocity_freedom(released: System) -> Values:
    """Return the velocity freedom of a system whose drives are released, with its verdict; nothing if undecided."""
    answered = study(released)
    number, verdict = answered.outcome.velocity_dof, answered.free.verdict
    return {} if number is None or verdict == "undecided" else {"undriven": number, "undriven_verdict": verdict}


#: All passes, in their order: each returns new fields, or replaces some of those before.
PASSES: tuple[Fill, ...] = (_generic_fields, _feasibility, _counts, _special)
#: Only the first pass, and all passes but the special cases.
GENERIC, PLAIN = PASSES[:1], PASSES[:-1]


def report_of(study: Study, passes: Sequence[Fill] = PASSES) -> Report:
    """Return the report filled by some passes, without fields that contradict each other."""
    values: dict[str, Any] = {}
    for fill in passes:
        values.update(fill(study, values))
    return Report(**agreed(values))


@dataclass(frozen=True)
class Examined(Study):
    """A system with its blocks' answers, and the report on it."""

    report: Report


def examined(
    system: System,
    seconds: float = DEFAULT_SECONDS,
    engines: Engines = BOTH,
    passes: Sequence[Fill] = PASSES,
) -> Examined:
    """Return the study and report of a system by some ``engines``; may raise OutOfTimeError."""
    with limited(seconds), precise_for(system.longest), gc_rarely():
        with part(SOLVING):
            result = study(system, engines)
        report = report_of(result, passes)
        return Examined(result.system, result.reduced, result.setting, result.outcome, report)
