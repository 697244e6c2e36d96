"""A system with its answered blocks (`Study`), and the fields of a report that are read from it, one function each."""

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
from dofkit.relations.setting import ALL, Reductions, Setting
from dofkit.report import ConstraintEntry, Count, Redundancy
from dofkit.system import System

#: Of the time that is left after the blocks: for what depends on what; the rest is for labels.
DEPENDENCE = 0.5


class Dependence(NamedTuple):
    """A minimal set of constraints that cannot hold together, and what depends on what, each by numbers."""

    conflicting: Conflict
    dependent: list[Redundancies]


class Decided(NamedTuple):
    """The value of a field of the report, with its claim; None for what cannot be wrong, or is not asked."""

    value: Any
    claim: Claim | None = None


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

    @cached_property
    def free(self) -> Claim:
        """Of the freedoms: the answers of all blocks together."""
        return together(*(a.claim for a in self.outcome.answers))

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

HOLDS = Claim("proved", "zero at the reference", about="reference")


def decided(study: Study, value: Any, claim: Claim) -> Decided:
    """Return a field about the motions, undecided where it has no value; not asked where there are no motions."""
    if study.outcome.consistent is False:
        return Decided(value)
    return Decided(value, OPEN if value is None else claim)


def counted(claim: Claim) -> Claim:
    """A number that is counted from another: a proof of it is a proof by counting."""
    return Claim("proved", "count", claim.bits, claim.gap, claim.about) if claim.verdict == "proved" else claim


def consistent(study: Study) -> Decided:
    """That there is a motion: so the blocks say; that there is none: the surest of them that says so."""
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
    """The names of a minimal set of constraints that cannot hold together."""
    members, sure = study.dependence.conflicting
    names = [study.names[i] for i in members]
    if study.outcome.consistent is not False:
        return Decided(names)
    claim = consistent(study).claim or OPEN
    return Decided(names, together(claim, sure) if members else OPEN)


def instantaneous_dof(study: Study) -> Decided:
    """Infinitesimal motions allowed at the reference configuration; None without one.

    Its claim is of ranks there, which are exact where no row depends on others.
    """
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
    """Return the instantaneous freedom by the differentials of relations as written, where their branches cross."""
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
    """Whether the reference allows other velocities than finite motions have; None without a reference."""
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
    """The names of a maximal redundant set, in their order; None where it was not decided, or nothing moves."""
    dependent, outcome = study.dependence.dependent, study.outcome
    if not outcome.consistent or outcome.velocity_dof is None or any(r.undecided for r in dependent):
        return decided(study, None, OPEN)
    gone = sorted({i for r in dependent for i in r.redundant})
    return decided(study, [study.names[i] for i in gone], _of_dependence(study, bool(gone)))


def redundancies(study: Study) -> Decided:
    """The groups of constraints that depend on each other, where a constraint or an equation is redundant.

    In x^2 + y^2 = 0 and x^2 + z^2 = 0 none is, though x = 0 is stated twice.
    """
    names, sizes = study.names, [r.equations for r in study.reduced]
    dependent = [r for r in study.dependence.dependent if r.redundant or r.has_dependent_equations(sizes)]
    groups = [
        Redundancy(nullity=nullity, members=[names[i] for i in members])
        for nullity, members in redundancy.merged(dependent)
    ]
    is_decided = redundant(study).value is not None
    return decided(study, groups, _of_dependence(study, bool(groups)) if is_decided else OPEN)


def _of_dependence(study: Study, some: bool) -> Claim:
    """Of what depends on what: nothing does where the count says so.

    That nothing is redundant though equations depend on each other is no claim about the component alone on which they
    were counted: each constraint is needed at a state of its own.
    """
    if not some and study.redundant_equations == 0:
        return counted(study.free)
    claims = [r.claim for r in study.dependence.dependent if r.redundant or r.groups]
    claim = together(study.free, *claims)
    anywhere = not some and claims and study.free.about == "component"
    return replace(claim, about=least(*(c.about for c in claims))) if anywhere else claim


def joint_coordinates(study: Study) -> list[str] | None:
    """Angles and displacements of joints that describe a tree; None for what is none, or has another freedom."""
    dof = study.outcome.dof
    result = tree_coordinates(study.system) if dof is not None and study.system.joints else None
    return result if result is not None and len(result) == dof else None


def largest_integrable_part(study: Study) -> Decided:
    """What the forms say in geometric equations; None where that is not known."""
    outcome = study.outcome
    if not any(block.forms for block in outcome.blocks):
        return Decided(None)
    part = unless_late(partial(integrable_part, outcome, study.entries, study.company), None)
    one_branch = any(block.forms and a.one_branch for block, a in zip(outcome.blocks, outcome.answers, strict=True))
    about = least(study.free.about, "component" if one_branch else "everywhere")
    return Decided(part, None if part is None else replace(study.free, about=about))


def growth_vector(study: Study) -> Decided:
    """Dimensions of D, D + [D, D], ... for the whole: blocks do not bracket with each other; they share only time."""
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
    """Of the growth vector: its first and last numbers are those of the freedoms; others are ranks over GF(p).

    Those are not too large where what is not 0 there is not 0; nor too small where no more brackets there are. Between
    two dimensions that differ by 1 there is no other.
    """
    pairs = zip(study.outcome.blocks, study.outcome.answers, strict=True)
    blocks = [(a.growth, a.trusted) for block, a in pairs if block.forms]
    if growth[-1] <= growth[0] + 1 or (len(growth) == 2 and all(trusted for _, trusted in blocks)):
        return counted(study.free)
    whole = all(trusted and of_block and is_free(of_block) for of_block, trusted in blocks)
    if study.free.verdict == "proved" and whole:
        return replace(study.free, argument="free Lie algebra")
    return together(study.free, Claim("probable", "brackets at points", bits=BITS))


def _time_enters(entry: ConstraintEntry) -> bool | None:
    """Return whether a constraint holds t or a term without velocities that cannot be divided out; None: undecided."""
    labels = (entry.scleronomic, *([entry.catastatic] if entry.form in ("pfaffian", "nonlinear") else []))
    return True if False in labels else None if None in labels else False


def witness(study: Study) -> dict[str, str] | None:
    """A certified configuration: the reference where it is one, else what the blocks found; None where one has none.

    What nothing constrains is 0. Parameters have the values that the configuration was found with; where blocks that
    share one were found with several, there is no configuration of the system.
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
    left_out = sum(a.looked.left_out for a in outcome.answers)
    if left_out:
        whole = sum(len(b.rows) for b in outcome.blocks)
        yield (
            f"{left_out} of {many(whole, 'relation')} {verb(left_out)} in no dependent set (as in open chains), "
            "so their finite motion was not examined"
        )
    if any(a.looked.spared for a in outcome.answers):
        yield (
            "fewer coordinates for the finite motions (welded bodies and rigid clusters as one body, bodies that do "
            "not turn as particles, variables that a linear equation gives explicitly)"
        )
