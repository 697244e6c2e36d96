"""A system with its answered blocks (`Study`), and the fields of a report that are read from it, one function each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import NamedTuple

from dofkit.base.deadline import part, unless_late
from dofkit.base.verdicts import OPEN, VERDICTS, About, Claim, least, together
from dofkit.base.wording import many, verb
from dofkit.classification.dependence import redundancy
from dofkit.classification.dependence.implied_constraints import Conflict, conflict
from dofkit.classification.freedom.branches import AnsweredBlocks, Outcome, solve
from dofkit.classification.freedom.preparation import prepared
from dofkit.classification.labels.companions import Companionship
from dofkit.classification.labels.entries import entries_of, integrable_part
from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions.text import to_text
from dofkit.mobility.counts import CountedFacts, count
from dofkit.mobility.joint_tree import tree_coordinates
from dofkit.relations.answer import Redundancies, undecided_dependence
from dofkit.relations.blocks import uses_time
from dofkit.relations.normal.pieces import Finite, Reduced
from dofkit.relations.setting import ALL, Reductions, Setting
from dofkit.report import BRANCH_WARNING, ConstraintEntry, Count, ForceEntry, IntegrablePart, Redundancy
from dofkit.system import BINDING, System

#: Of the time that is left after the blocks: for what depends on what; the rest is for labels.
DEPENDENCE = 0.5


class Dependence(NamedTuple):
    """A minimal set of constraints that cannot hold together, and what depends on what, each by numbers."""

    conflicting: Conflict
    dependent: list[Redundancies]

    @property
    def about(self) -> About:
        """Of which points it is told that what is redundant can go: the narrowest of all parts with something that can.

        That something is needed is told of every point near one, so of the whole.
        """
        return least(*(r.about for r in self.dependent if r.redundant))


@dataclass(frozen=True)
class Study:
    """A system, its relations over the reals, what may be assumed of its symbols, and its blocks' answers."""

    system: System
    reduced: Sequence[Reduced]
    setting: Setting
    outcome: Outcome

    @property
    def names(self) -> list[str]:
        """The constraints' names, by number."""
        return [c.name for c in self.system.constraints]

    @property
    def equations(self) -> int:
        """Bilateral scalar equations."""
        return sum(r.equations for r in self.reduced)

    @property
    def redundant_equations(self) -> int | None:
        """Equations less (coordinates - velocities), never below 0; None where the velocities are not known."""
        velocities = self.outcome.velocity_dof
        return None if velocities is None else max(0, self.equations - (len(self.system.coordinates) - velocities))

    @cached_property
    def dependence(self) -> Dependence:
        """What conflicts and what depends on what, in a share of the time."""
        nothing = undecided_dependence(i for i, r in enumerate(self.reduced) if r.normals)
        conflicting = Conflict([])
        with part(DEPENDENCE):
            if self.outcome.consistent is False:
                look = partial(conflict, self.reduced, self.setting, self.outcome)
                conflicting = unless_late(look, conflicting)
            dependent = unless_late(
                partial(redundancy.redundancies, self.reduced, self.setting, self.outcome), [nothing]
            )
        if self.redundant_equations == 0:
            dependent = redundancy.all_needed(dependent, self.reduced, self.outcome)
        return Dependence(conflicting, dependent)

    @cached_property
    def company(self) -> Companionship:
        """The blocks, to be asked what a form integrates to together with which others."""
        return Companionship(self.answered, self.names)

    @cached_property
    def answered(self) -> AnsweredBlocks:
        """The blocks answered for their labels alone, at no drawing; those that were found so are not asked again."""
        plain = replace(self.setting, pose={}, reference=None, grows=False, flag=False)
        answered = AnsweredBlocks(plain)
        if self.setting.reference is None and not self.setting.pose:
            answered.know(self.outcome)
        return answered

    @cached_property
    def entries(self) -> list[ConstraintEntry]:
        """The constraints' entries, in order."""
        return self.entries_beside(self.dependence.dependent)

    def entries_beside(self, dependent: Sequence[Redundancies]) -> list[ConstraintEntry]:
        """The constraints' entries, where this is known of what depends on what."""
        return entries_of(self.reduced, self.setting, self.outcome, dependent, self.company)

    def by_name(self, labels: Sequence[bool | None]) -> Mapping[str, bool | None]:
        """A label for each constraint, by its name."""
        return dict(zip(self.names, labels, strict=True))


def study(
    system: System, engines: Engines = BOTH, reductions: Reductions = ALL, grows: bool = True, flag: bool = False
) -> Study:
    """The blocks of a system answered by some engines, with some reductions in use.

    ``grows``: the growth vector; ``flag``: the derived flag. Raises OutOfTimeError, and SceneError where a relation
    cannot be read over the reals.
    """
    reduced, setting = prepared(system, reductions)
    setting = replace(setting, engines=engines, grows=grows, flag=flag)
    return Study(system, reduced, setting, solve(reduced, setting))


# fields of the report


def instantaneous_dof(study: Study) -> int | None:
    """Velocities allowed to first order at the reference configuration; None without one, or where branches cross."""
    outcome = study.outcome
    if study.system.reference is None or outcome.consistent is not True or outcome.crossing:
        return None
    freedoms = [a.instantaneous for a in outcome.answers]
    if any(p is None for p in freedoms):
        return None
    return len(outcome.untouched) + sum(p for p in freedoms if p is not None)


def singular(study: Study) -> bool | None:
    """Return whether the reference allows other velocities than finite motions have; None without a reference."""
    here, velocities = instantaneous_dof(study), study.outcome.velocity_dof
    return None if here is None or velocities is None else here != velocities


def lecture_count(study: Study) -> Count:
    """f = N d - k beside the truth."""
    reduced, outcome = study.reduced, study.outcome
    written = sum(all(isinstance(p, Finite) for p in normal.pieces) for r in reduced for normal in r.normals)
    hidden = sum(len(a.hidden) for a in outcome.answers)
    return count(study.system, CountedFacts(written, outcome.dof, outcome.consistent, hidden, study.entries))


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
    return [
        Redundancy(nullity=nullity, members=[names[i] for i in members])
        for nullity, members in redundancy.merged(dependent)
    ]


def joint_coordinates(study: Study) -> list[str] | None:
    """Angles and displacements of joints that describe a tree; None for what is none, or has another freedom."""
    dof = study.outcome.dof
    result = tree_coordinates(study.system) if dof is not None and study.system.joints else None
    return result if result is not None and len(result) == dof else None


def largest_integrable_part(study: Study) -> IntegrablePart | None:
    """What the forms say in finite relations; None where that is not known."""
    if not any(block.forms for block in study.outcome.blocks):
        return None
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
    coordinate_names = frozenset(names)
    others = {name: text for name, text in result.items() if name not in coordinate_names}
    return {name: result.get(name, "0") for name in names} | others


def method(study: Study) -> str:
    """What ran."""
    return "; ".join(dict.fromkeys(a.method for a in study.outcome.answers if a.method)) or "count"


def modelled(system: System, outcome: Outcome) -> str:
    """What the model kept and left out, and why."""
    sentences = []
    touched = len(system.coordinates) - len(outcome.untouched)
    if outcome.blocks:
        sentences.append(f"{many(touched, 'coordinate')} in {many(len(outcome.blocks), 'independent subsystem')}")
    if outcome.untouched:
        text = ", ".join(outcome.untouched[:12]) + (", ..." if len(outcome.untouched) > 12 else "")
        sentences.append(f"counted but left out of the computation, because nothing constrains them: {text}")
    finite = sum(not b.forms and not b.nonlinear for b in outcome.blocks)
    if finite:
        sentences.append("no integrability test where all equations are geometric (d(dg) = 0)")
    sentences += _looked_at(outcome)
    if system.forces:
        sentences.append("forces are left out: they are not constraints")
    sentences += [f"left out: {answer}" for answer in system.left_out]
    return "; ".join(sentences) or "nothing constrains anything"


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


# claims of the blocks

HOLDS = Claim("proved", "zero at the reference", about="reference")


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


def first_order(study: Study) -> Claim:
    """Of the velocities at the reference: ranks there, which are exact where no row depends on others."""
    claims = [a.first_order for a in study.outcome.answers]
    return replace(together(*claims), about="reference")
