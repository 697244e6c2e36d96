"""The fields of a report, a function each: what is told of a `Study`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from dofkit.base.deadline import unless_late
from dofkit.base.wording import many, verb
from dofkit.classification.dependence.redundancy import merged
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.labels.companions import integrable_part
from dofkit.classification.study import Study
from dofkit.expressions.text import to_text
from dofkit.mobility.joint_tree import tree_coordinates
from dofkit.mobility.textbook_count import CountedFacts, count
from dofkit.relations.blocks import about_constants, uses_time
from dofkit.relations.normal.pieces import Finite
from dofkit.report import BRANCH_WARNING, ConstraintEntry, Count, ForceEntry, IntegrablePart, Redundancy
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
    found = None if dof is None else tree_coordinates(study.system)
    return found if found is not None and len(found) == dof else None


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
    found: dict[str, str] = {}
    for told in (outcome.witness, *(a.witness or {} for a in outcome.answers)):
        for s, text in told.items():
            if s.args[0] in ("coordinate", "parameter", "time") and found.setdefault(str(s.args[1]), text) != text:
                return None
    names = [c.name for c in study.system.coordinates]
    own = frozenset(names)
    others = {name: text for name, text in found.items() if name not in own}
    return {name: found.get(name, "0") for name in names} | others


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
        shown = ", ".join(outcome.untouched[:12]) + (", ..." if len(outcome.untouched) > 12 else "")
        parts.append(f"counted but left out of the computation, because nothing constrains them: {shown}")
    finite = sum(not b.forms and not b.nonlinear for b in outcome.blocks)
    if finite:
        parts.append("no integrability test where all equations are geometric (d(dg) = 0)")
    parts += _looked_at(outcome)
    if system.forces:
        parts.append("forces are left out: they are not constraints")
    parts += [f"left out: {told}" for told in system.left_out]
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
    told = list(study.system.warnings)
    told += [
        f"not read, so the true freedom may be smaller: {t}" for t in study.system.left_out if t.startswith(BINDING)
    ]
    for r in study.reduced:
        for normal in r.normals:
            told += [f"'{r.constraint.name}': {note}" for note in normal.notes]
            if len(normal.branches) > 1:
                told.append(BRANCH_WARNING.format(name=r.constraint.name))
        told += [f"'{r.constraint.name}': {note}" for note in r.constraint.notes]
    told += [f"'{study.names[i]}': whether it can be satisfied at all was not decided" for i in study.outcome.unsettled]
    for a in study.outcome.answers:
        told += a.reasons
        told += [f"hidden geometric equation: {to_text(g)} = 0" for g in a.hidden]
    if study.outcome.dof is None and study.outcome.consistent is not False:
        told += [
            f"There is no reference configuration: give {missing}. With a reference configuration more can be decided."
            for missing in _missing_reference(study.system)
        ]
    return list(dict.fromkeys(told))


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
    shown = ", ".join([*owners][:8]) + (", ..." if len(owners) > 8 else "")
    wanted = [f"`at` for {shown}"] if owners else []
    if system.bodies and system.generic:
        wanted.append("`at` (and `axis`) for the joints")
    if not wanted:
        wanted = ["`configuration`, a value for each coordinate"]
    yield " and ".join(wanted)
