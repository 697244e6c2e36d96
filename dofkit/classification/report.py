"""The fields of a report, a function each: what is told of a `Study`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from dofkit.base.deadline import unless_late
from dofkit.base.verdicts import OPEN, VERDICTS, ArgumentKey, Claim, least, together
from dofkit.base.wording import many, verb
from dofkit.classification.dependence.redundancy import merged
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.generalized_coordinates import claim_of_choice, counted
from dofkit.classification.labels.companions import integrable_part
from dofkit.classification.study import Study
from dofkit.expressions.text import to_text
from dofkit.integrability.growth_vector import is_free
from dofkit.mobility.counts import CountedFacts, count
from dofkit.mobility.joint_tree import tree_coordinates
from dofkit.relations.answer import BITS
from dofkit.relations.blocks import about_constants, uses_time
from dofkit.relations.normal.pieces import Finite
from dofkit.report import BRANCH_WARNING, ConstraintEntry, Count, FieldVerdict, ForceEntry, IntegrablePart, Redundancy
from dofkit.system import BINDING, System


def instantaneous_dof(study: Study) -> int | None:
    """Velocities allowed to first order at the reference configuration; None without one, or where branches cross."""
    outcome = study.outcome
    if study.system.reference is None or outcome.consistent is not True or outcome.crossing:
        return None
    parts = [a.instantaneous for a in outcome.answers]
    if any(p is None for p in parts):
        return None
    return len(outcome.untouched) + sum(p for p in parts if p is not None)


def singular(study: Study) -> bool | None:
    """Does the drawing allow other velocities than finite motions have? None without a drawing."""
    here, velocities = instantaneous_dof(study), study.outcome.velocity_dof
    return None if here is None or velocities is None else here != velocities


def lecture_count(study: Study) -> Count:
    """f = N d - k beside the truth."""
    reduced, outcome = study.reduced, study.outcome
    written = sum(all(isinstance(p, Finite) for p in normal.pieces) for r in reduced for normal in r.normals)
    constants = [c for r in reduced for c in r.constants]
    hidden = sum(not about_constants(g, constants) for a in outcome.answers for g in a.hidden)
    return count(study.system, CountedFacts(written, outcome.dof, outcome.consistent, hidden, 0, study.entries))


def redundant(study: Study) -> list[str] | None:
    """The names of what can be dropped together, in the scene's order; None where that was not decided."""
    names, outcome = study.names, study.outcome
    undecided = any(r.undecided for r in study.dependence.dependent)
    if outcome.consistent is None or (outcome.consistent and (undecided or outcome.velocity_dof is None)):
        return None
    return [names[i] for i in sorted({i for r in study.dependence.dependent for i in r.redundant})]


def redundancies(study: Study) -> list[Redundancy]:
    """Return the groups of constraints that depend on each other, where a constraint or an equation is redundant.

    In x^2 + y^2 = 0 and x^2 + z^2 = 0 none is, though x = 0 is stated twice.
    """
    names, sizes = study.names, [r.equations for r in study.reduced]
    dependent = [r for r in study.dependence.dependent if r.redundant or r.has_dependent_equations(sizes)]
    return [Redundancy(nullity=nullity, members=[names[i] for i in members]) for nullity, members in merged(dependent)]


def joint_coordinates(study: Study) -> list[str] | None:
    """Angles and displacements of joints that describe a tree; None for what is none, or has another freedom."""
    dof = study.outcome.dof
    result = None if dof is None else tree_coordinates(study.system)
    return result if result is not None and len(result) == dof else None


def largest_integrable_part(study: Study) -> IntegrablePart | None:
    """What the forms say in finite relations; None where that is not known."""
    return unless_late(partial(integrable_part, study.outcome, study.entries, study.company), None)


def growth_vector(outcome: Outcome, entries: Sequence[ConstraintEntry]) -> list[int] | None:
    """Dimensions of D, D + [D, D], ... for the whole: blocks do not bracket with each other; they share only time."""
    if not outcome.consistent or not any(b.forms for b in outcome.blocks):
        return None
    growths: list[tuple[int, ...]] = []
    timed = timeless = 0
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        shared = uses_time(block)
        timed += shared
        enters = {_time_enters(entries[r.constraint]) for r in block.rows} if shared else {False}
        timeless += shared and enters == {False}
        open_ = None in enters and True not in enters
        if open_ or block.nonlinear or (a.growth is None and block.forms) or a.velocity_dof is None:
            return None
        growths.append(a.growth if a.growth is not None else (a.velocity_dof + shared,))
    length = max(len(g) for g in growths)
    base = len(outcome.untouched) - (timed if timed == timeless else max(0, timed - 1))
    return [base + sum(g[min(k, len(g) - 1)] for g in growths) for k in range(length)]


def _time_enters(entry: ConstraintEntry) -> bool | None:
    """Return whether a constraint holds t or a term without velocities that cannot be divided out; None: undecided."""
    labels = (entry.scleronomic, *([entry.catastatic] if entry.form in ("pfaffian", "nonlinear") else []))
    return True if False in labels else None if None in labels else False


def forces(study: Study) -> list[ForceEntry]:
    """The forces: no constraints, with the reason."""
    return [ForceEntry(name=f.name, reason=f.reason) for f in study.system.forces]


def witness(study: Study) -> dict[str, str] | None:
    """A certified configuration: the reference where it is one, else what the blocks found; None where one has none.

    What nothing constrains is 0. Parameters have the values that the configuration was found with; where blocks that
    share one were found with several, there is no configuration of the whole.
    """
    outcome = study.outcome
    if outcome.consistent is not True or any(a.witness is None for a in outcome.answers):
        return None
    result: dict[str, str] = {}
    for answer in (outcome.witness, *(a.witness or {} for a in outcome.answers)):
        for s, text in answer.items():
            if s.args[0] in ("coordinate", "parameter", "time") and result.setdefault(str(s.args[1]), text) != text:
                return None
    names = [c.name for c in study.system.coordinates]
    own = frozenset(names)
    others = {name: text for name, text in result.items() if name not in own}
    return {name: result.get(name, "0") for name in names} | others


def method(study: Study) -> str:
    """What ran."""
    return "; ".join(dict.fromkeys(a.method for a in study.outcome.answers if a.method)) or "count"


def modelled(system: System, outcome: Outcome) -> str:
    """What the model kept and left out, and why."""
    parts = []
    touched = len(system.coordinates) - len(outcome.untouched)
    if outcome.blocks:
        parts.append(f"{many(touched, 'coordinate')} in {many(len(outcome.blocks), 'independent subsystem')}")
    if outcome.untouched:
        text = ", ".join(outcome.untouched[:12]) + (", ..." if len(outcome.untouched) > 12 else "")
        parts.append(f"counted but left out of the computation, because nothing constrains them: {text}")
    finite = sum(not b.forms and not b.nonlinear for b in outcome.blocks)
    if finite:
        parts.append("no integrability test where all equations are geometric (d(dg) = 0)")
    parts += _looked_at(outcome)
    if system.forces:
        parts.append("forces are left out: they are not constraints")
    parts += [f"left out: {answer}" for answer in system.left_out]
    return "; ".join(parts) or "nothing constrains anything"


def _looked_at(outcome: Outcome) -> Iterator[str]:
    """What of the relations had to be followed to tell motions from shakes."""
    looked = [a.looked for a in outcome.answers]
    left_out, rigid, followed = (
        sum(k.left_out for k in looked),
        sum(k.rigid for k in looked),
        sum(k.followed for k in looked),
    )
    if left_out:
        whole = sum(len(b.rows) for b in outcome.blocks)
        yield (
            f"{left_out} of {many(whole, 'relation')} {verb(left_out)} in no dependent set (as in open chains), "
            "so their finite motion was not examined"
        )
    if rigid:
        yield f"{many(rigid, 'dependent set')} treated as one rigid body each"
    if followed and left_out:
        yield f"{many(followed, 'other dependent set')} examined separately"
    if any(k.spared for k in looked):
        yield (
            "fewer coordinates for the finite motions (welded bodies and rigid clusters as one body, bodies that do "
            "not turn as particles, variables that a linear equation gives explicitly)"
        )


def warnings(study: Study) -> list[str]:
    """Lines of text: what was noticed while reading, why something is open, and what is hidden."""
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
    for a in study.outcome.answers:
        answer += a.reasons
        answer += [f"hidden geometric equation: {to_text(g)} = 0" for g in a.hidden]
    if study.outcome.dof is None and study.outcome.consistent is not False:
        answer += [
            f"There is no reference configuration: give {missing}. With a reference configuration more can be decided."
            for missing in _missing_reference(study.system)
        ]
    return list(dict.fromkeys(answer))


def about_branches(system: System, branches: Sequence[str]) -> Iterator[str]:
    """Yield for each branch that alone has the report's freedom how the answer for another branch is obtained."""
    for branch in branches:
        for missing in _missing_reference(system):
            yield (
                f"The configuration space has branches of different dimension. The degrees of freedom, the redundancy "
                f"and the coordinates are those of the largest branch, {branch}. To choose a branch, give {missing}."
            )


def _missing_reference(system: System) -> Iterator[str]:
    """Yield what the scene has to give for a reference configuration, where it has none."""
    known = {str(symbol.args[1]) for symbol in system.pose}
    if system.reference is not None or all(c.name in known for c in system.coordinates):
        return
    owners = dict.fromkeys(c.owner for c in system.coordinates if c.owner in system.particles and c.name not in known)
    text = ", ".join([*owners][:8]) + (", ..." if len(owners) > 8 else "")
    wanted = [f"`at` for {text}"] if owners else []
    if system.bodies and system.generic:
        wanted.append("`at` (and `axis`) for the joints")
    if not wanted:
        wanted = ["`configuration`, a value for each coordinate"]
    yield " and ".join(wanted)


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
    result = {"consistent": consistency(study)}
    if told["consistent"] is False:
        result["conflicting"] = _conflict(study, result["consistent"])
    else:
        result |= {"dof": _unless(told["dof"], free), "velocity_dof": _unless(told["velocity_dof"], free)}
        result["redundant_equations"] = _unless(told["redundant_equations"], counted(free))
        result["redundant"] = _unless(told["redundant"], _dependence(study, free, bool(told["redundant"])))
        result["redundancies"] = _unless(told["redundant"], _dependence(study, free, bool(told["redundancies"])))
        claim = claim_of_choice(study, free, told["generalized_coordinates"] or ())
        result["generalized_coordinates"] = _unless(told["generalized_coordinates"], claim)
    if study.system.reference is not None and told["consistent"] is not False:
        first = first_order(study)
        result["instantaneous_dof"] = _unless(told["instantaneous_dof"], first)
        result["singular"] = _unless(told["singular"], together(first, free))
    for name in ("holonomic", "scleronomic"):
        result[name] = of_entries(told["constraints"], name, told[name])
    if told["growth_vector"] is not None:
        result["growth_vector"] = _growth(study, free, told["growth_vector"])
    if told["integrable_part"] is not None:
        result["integrable_part"] = free
    return result


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
