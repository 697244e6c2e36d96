"""A system with the answers of its blocks (`Study`), and one function for each report field that is read from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, NamedTuple

from dofkit.base.deadline import part, unless_late
from dofkit.base.verdicts import OPEN, VERDICTS, Claim, least, together
from dofkit.base.wording import many, verb
from dofkit.classification.dependence import redundancy
from dofkit.classification.dependence.implied_constraints import Conflict, conflict
from dofkit.classification.freedom.branches import AnsweredBlocks, Outcome, solve
from dofkit.classification.freedom.preparation import branches_at_reference, prepared
from dofkit.classification.labels.companions import Companionship
from dofkit.classification.labels.entries import entries_of, integrable_part
from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions.tree import Expr
from dofkit.integrability.lie_algebra import is_free
from dofkit.integrability.pfaffian_system import first_order_freedom
from dofkit.mobility.counts import CountedFacts, count
from dofkit.mobility.joint_tree import tree_coordinates
from dofkit.relations.answer import BITS, Redundancies, undecided_dependence
from dofkit.relations.blocks import Block, Row, uses_time
from dofkit.relations.normal.pieces import Finite, Reduced
from dofkit.relations.setting import Setting
from dofkit.report import ConstraintEntry, Count, Redundancy
from dofkit.system import System

#: Share of the time after the blocks for `Study.dependence`.
DEPENDENCE = 0.5


class Dependence(NamedTuple):
    """A minimal contradictory set of constraints, and the dependence of constraints on each other, by numbers."""

    conflicting: Conflict
    dependent: list[Redundancies]


class Decided(NamedTuple):
    """The value of a field of the report, with its claim; without a claim the field does not apply."""

    value: Any
    claim: Claim | None = None


@dataclass(frozen=True)
class Study:
    """A system, the normal forms of its constraints, the assumptions about its symbols, and its blocks' answers."""

    system: System
    reduced: Sequence[Reduced]
    setting: Setting
    outcome: Outcome

    @property
    def names(self) -> list[str]:
        """The constraints' names, by number."""
        return [c.name for c in self.system.constraints]

    @cached_property
    def free(self) -> Claim:
        """The claim of the freedoms, from the answers of all blocks together."""
        return together(*(a.claim for a in self.outcome.answers))

    @property
    def equations(self) -> int:
        """The number of bilateral scalar equations."""
        return sum(r.equations for r in self.reduced)

    @property
    def redundant_equations(self) -> int | None:
        """Equations minus (coordinates - velocity freedom), at least 0; None if the velocity freedom is not known."""
        velocities = self.outcome.velocity_dof
        return None if velocities is None else max(0, self.equations - (len(self.system.coordinates) - velocities))

    @cached_property
    def dependence(self) -> Dependence:
        """Conflicting and dependent constraints; out of time (share `DEPENDENCE`): no conflict, all undecided."""
        nothing = undecided_dependence(i for i, r in enumerate(self.reduced) if r.normals)
        conflicting = Conflict([])
        with part(DEPENDENCE):
            if self.outcome.consistent is False:
                find_conflict = partial(conflict, self.reduced, self.setting, self.outcome)
                conflicting = unless_late(find_conflict, conflicting)
            dependent = unless_late(
                partial(redundancy.redundancies, self.reduced, self.setting, self.outcome), [nothing]
            )
        if self.redundant_equations == 0:
            dependent = redundancy.all_needed(dependent, self.reduced, self.outcome)
        return Dependence(conflicting, dependent)

    @cached_property
    def company(self) -> Companionship:
        """The search for what a form integrates to together with other constraints."""
        return Companionship(self.answered, self.names)

    @cached_property
    def answered(self) -> AnsweredBlocks:
        """Answers of blocks for labels only, without a reference; those of the outcome are used if they have none."""
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
        """Return the constraints' entries for given dependences."""
        return entries_of(self.reduced, self.setting, self.outcome, dependent, self.company)


def study(system: System, engines: Engines = BOTH, grows: bool = True, flag: bool = False) -> Study:
    """Return the study of a system by some engines.

    ``grows``, ``flag``: whether to compute the growth vector and the derived flag. Raises OutOfTimeError, and
    SceneError if an expression is not a valid relation.
    """
    reduced, setting = prepared(system)
    setting = replace(setting, engines=engines, grows=grows, flag=flag)
    return Study(system, reduced, setting, solve(reduced, setting))


# fields of the report

HOLDS = Claim("proved", "zero at the reference", about="reference")


def decided(study: Study, value: Any, claim: Claim) -> Decided:
    """Return a field about the motions, undecided if its value is None; without a claim if there is no motion."""
    if study.outcome.consistent is False:
        return Decided(value)
    return Decided(value, OPEN if value is None else claim)


def counted(claim: Claim) -> Claim:
    """Return the claim of a number that is computed from one with this claim; a proof becomes one by counting."""
    return Claim("proved", "count", claim.bits, claim.gap, claim.about) if claim.verdict == "proved" else claim


def consistent(study: Study) -> Decided:
    """Return whether there is a motion, with the claims of all blocks; if not, with the most certain of them."""
    outcome = study.outcome
    if outcome.consistent is None:
        return Decided(None, OPEN)
    if outcome.consistent:
        return Decided(True, together(*(HOLDS if a.exists else a.claim for a in outcome.answers)))
    if outcome.impossible:
        return Decided(False, Claim("proved", "inequality nowhere"))
    against = [a.claim for a in outcome.answers if a.consistent is False]
    return Decided(False, min(against, key=lambda c: VERDICTS.index(c.verdict)))


def conflicting(study: Study) -> Decided:
    """Return the names of a minimal set of constraints that contradict each other; none in a consistent system."""
    members, sure = study.dependence.conflicting
    names = [study.names[i] for i in members]
    if study.outcome.consistent is not False:
        return Decided(names)
    claim = consistent(study).claim or OPEN
    return Decided(names, together(claim, sure) if members else OPEN)


def instantaneous_dof(study: Study) -> Decided:
    """Return the velocity freedom at the reference configuration; None without one."""
    outcome = study.outcome
    if study.system.reference is None:
        return Decided(None)
    freedoms = [a.instantaneous for a in outcome.answers]
    claim, number = together(*(a.first_order for a in outcome.answers)), None
    if outcome.consistent is True and outcome.crossing:
        number, sure = _where_branches_cross(study, study.system.reference)
        claim = Claim("proved" if sure else "probable", "rank at the reference", BITS)
    elif outcome.consistent is True and None not in freedoms:
        number = len(outcome.untouched) + sum(p for p in freedoms if p is not None)
    return decided(study, number, replace(claim, about="reference"))


def _where_branches_cross(study: Study, reference: Mapping[Expr, Expr]) -> tuple[int | None, bool]:
    """Return (instantaneous freedom, whether it is proved) by the relations as written, where branches cross."""
    rows = []
    for i, r in enumerate(study.reduced):
        for normal, written in zip(r.normals, r.written, strict=True):
            branches = branches_at_reference(normal, study.setting).branches
            rows += [Row(i, p) for p in (branches[0] if len(branches) == 1 else (Finite(written.expr),))]
    if study.setting.tolerance is not None or not all(isinstance(row.piece, Finite) for row in rows):
        return None, False
    coordinates = tuple(c.name for c in study.system.coordinates)
    return first_order_freedom(Block(coordinates, tuple(rows)), study.setting, reference)


def singular(study: Study) -> Decided:
    """Return whether the instantaneous freedom is not the velocity freedom; None without a reference."""
    (here, claim), velocities = instantaneous_dof(study), study.outcome.velocity_dof
    value = None if here is None or velocities is None else here != velocities
    return Decided(value) if claim is None else decided(study, value, together(claim, study.free))


def lecture_count(study: Study) -> Count:
    """Return the textbook count f = N d - k, with the reason why it differs from the freedom."""
    reduced, outcome = study.reduced, study.outcome
    written = sum(all(isinstance(p, Finite) for p in normal.pieces) for r in reduced for normal in r.normals)
    hidden = sum(len(a.hidden) for a in outcome.answers)
    return count(study.system, CountedFacts(written, outcome.dof, outcome.consistent, hidden, study.entries))


def redundant(study: Study) -> Decided:
    """Return the names of a maximal redundant set, in the order of the scene; None if undecided or inconsistent."""
    dependent, outcome = study.dependence.dependent, study.outcome
    if not outcome.consistent or outcome.velocity_dof is None or any(r.undecided for r in dependent):
        return decided(study, None, OPEN)
    gone = sorted({i for r in dependent for i in r.redundant})
    return decided(study, [study.names[i] for i in gone], _of_dependence(study, bool(gone)))


def redundancies(study: Study) -> Decided:
    """Return the groups of constraints that depend on each other and have a redundant constraint or equation.

    x^2 + y^2 = 0 and x^2 + z^2 = 0 are no group: neither is redundant, although each implies x = 0.
    """
    names, sizes = study.names, [r.equations for r in study.reduced]
    dependent = [r for r in study.dependence.dependent if r.redundant or r.has_dependent_equations(sizes)]
    groups = [
        Redundancy(nullity=nullity, members=[names[i] for i in members])
        for nullity, members in redundancy.merged(dependent)
    ]
    is_decided = redundant(study).value is not None and (groups or not study.redundant_equations)
    return decided(study, groups, _of_dependence(study, bool(groups)) if is_decided else OPEN)


def _of_dependence(study: Study, some: bool) -> Claim:
    """Return the claim of dependences; ``some``: there are any. If no equation is surplus, it is a claim by counting.

    That every constraint is needed although equations depend on each other is not limited to the component on which
    the equations were counted.
    """
    if not some and study.redundant_equations == 0:
        return counted(study.free)
    claims = [r.claim for r in study.dependence.dependent if r.redundant or r.groups]
    claim = together(study.free, *claims)
    anywhere = not some and claims and study.free.about == "component"
    return replace(claim, about=least(*(c.about for c in claims))) if anywhere else claim


def joint_coordinates(study: Study) -> list[str] | None:
    """Return joint angles and displacements that are coordinates of a tree; None if the system is no free tree."""
    dof = study.outcome.dof
    result = tree_coordinates(study.system) if dof is not None and study.system.joints else None
    return result if result is not None and len(result) == dof else None


def largest_integrable_part(study: Study) -> Decided:
    """Return the geometric equations that the forms imply, with their number; None if this is not known."""
    outcome = study.outcome
    if not any(block.forms for block in outcome.blocks):
        return Decided(None)
    part = unless_late(partial(integrable_part, outcome, study.entries, study.company), None)
    one_branch = any(block.forms and a.one_branch for block, a in zip(outcome.blocks, outcome.answers, strict=True))
    about = least(study.free.about, "component" if one_branch else "everywhere")
    return Decided(part, None if part is None else replace(study.free, about=about))


def growth_vector(study: Study) -> Decided:
    """Return the dimensions of D, D + [D, D], ... for the system: the sums over blocks, which share only time."""
    outcome = study.outcome
    if not outcome.consistent or not any(b.forms for b in outcome.blocks):
        return Decided(None)
    growths: list[tuple[int, ...]] = []
    timed = timeless = 0
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        shared = uses_time(block)
        timed += shared
        enters = {_time_enters(study.entries[r.constraint]) for r in block.rows} if shared else {False}
        timeless += shared and enters == {False}
        open_ = None in enters and True not in enters
        if open_ or block.nonlinear or (a.growth is None and block.forms) or a.velocity_dof is None:
            return Decided(None)
        growths.append(a.growth if a.growth is not None else (a.velocity_dof + shared,))
    length = max(len(g) for g in growths)
    base = len(outcome.untouched) - (timed if timed == timeless else max(0, timed - 1))
    growth = [base + sum(g[min(k, len(g) - 1)] for g in growths) for k in range(length)]
    return Decided(growth, _claim_of_growth(study, growth))


def _claim_of_growth(study: Study, growth: Sequence[int]) -> Claim:
    """Return the claim of the growth vector: its first and last numbers are freedoms, the others ranks over GF(p).

    A rank is not too large if values that are not 0 over GF(p) are not 0, and not too small if the Lie algebra is
    free up to there. Between two dimensions that differ by 1 there is no other.
    """
    pairs = zip(study.outcome.blocks, study.outcome.answers, strict=True)
    blocks = [(a.growth, a.trusted) for block, a in pairs if block.forms]
    if growth[-1] <= growth[0] + 1 or (len(growth) == 2 and all(trusted for _, trusted in blocks)):
        return counted(study.free)
    free = all(trusted and of_block and is_free(of_block) for of_block, trusted in blocks)
    if study.free.verdict == "proved" and free:
        return replace(study.free, argument="free Lie algebra")
    return together(study.free, Claim("probable", "brackets at points", bits=BITS))


def _time_enters(entry: ConstraintEntry) -> bool | None:
    """Return whether t, or a term without velocities, really occurs in a constraint; None if undecided."""
    labels = (entry.scleronomic, *([entry.catastatic] if entry.form in ("pfaffian", "nonlinear") else []))
    return True if False in labels else None if None in labels else False


def witness(study: Study) -> dict[str, str] | None:
    """Return a certified configuration, {name: value as text}, from the blocks' witnesses; None if one is missing.

    Unconstrained coordinates are 0. Parameters have the values of the search; None if blocks have different values.
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
    """Return the methods that were used."""
    return "; ".join(dict.fromkeys(a.method for a in study.outcome.answers if a.method)) or "count"


def modelled(system: System, outcome: Outcome) -> str:
    """Return sentences on what is in the model and what was left out, and why."""
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
    sentences += _not_looked_at(outcome)
    if system.forces:
        sentences.append("forces are left out: they are not constraints")
    sentences += [f"left out: {answer}" for answer in system.left_out]
    return "; ".join(sentences) or "nothing constrains anything"


def _not_looked_at(outcome: Outcome) -> Iterator[str]:
    """Yield sentences on the relations and coordinates that were left out of the analysis of finite motions."""
    left_out = sum(a.looked.left_out for a in outcome.answers)
    if left_out:
        whole = sum(len(b.rows) for b in outcome.blocks)
        yield (
            f"{left_out} of {many(whole, 'relation')} {verb(left_out)} in no dependent set (as in open chains), "
            "which was not examined for finite motions"
        )
    if any(a.looked.spared for a in outcome.answers):
        yield (
            "finite motions were examined in fewer coordinates (welded bodies and rigid clusters as one body, bodies "
            "that do not turn as particles, variables that a linear equation gives explicitly)"
        )
