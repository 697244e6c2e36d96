"""From a scene to its report: orders the passes; the only module that knows them all."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

from flint import ctx

from dofkit.base.arguments import require_one_of, seconds_of
from dofkit.base.deadline import DEFAULT_SECONDS, OUT_OF_TIME, OutOfTimeError, limited, part, unless_late
from dofkit.base.verdicts import weakest
from dofkit.classification.counts import with_counts
from dofkit.classification.dependence.circuits import left_open
from dofkit.classification.dependence.conflicts import conflict
from dofkit.classification.dependence.redundancy import all_needed, merged, redundancies
from dofkit.classification.freedom.branches import Outcome, solve
from dofkit.classification.freedom.preparation import prepared
from dofkit.classification.generalized_coordinates import generalized
from dofkit.classification.labels.companions import Companionship
from dofkit.classification.labels.entries import entries_of
from dofkit.classification.labels.integrable_part import integrable_part
from dofkit.classification.special import special_cases
from dofkit.classification.undecided import blank, sketch
from dofkit.exact.points.balls import PRECISION
from dofkit.expressions.tree import Expr
from dofkit.methods.in_worker import in_worker
from dofkit.methods.shared.reporting import report_alone
from dofkit.methods.table import BY_ENGINES, METHODS, MethodName
from dofkit.mobility.textbook_count import CountedFacts, count
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, uses_time
from dofkit.relations.integration_constants import about_constants
from dofkit.relations.normal.normal_form import Finite
from dofkit.relations.reduced import Reduced
from dofkit.relations.reductions import ALL, Reductions
from dofkit.relations.setting import Setting
from dofkit.report import BRANCH_WARNING, ConstraintEntry, ForceEntry, Redundancy, Report
from dofkit.scene.lowering import lower
from dofkit.scene.reading import SceneLike, scene_or_system
from dofkit.scene.scene import Scene
from dofkit.system import System

#: Shares of the time: for the blocks of a scene, and of what is left for what depends on what; the rest is for labels.
SOLVING, DEPENDENCE = 0.75, 0.5
_NO_SPECIAL_CASES = "There was no time to look for special cases."
_UNWATCHED = "No worker process could be started here: the time was watched, but nothing would have been killed."


def classify(scene: SceneLike | System, budget: float | None = None, method: MethodName = "auto") -> Report:
    """How the system of ``scene`` can move: its freedom, labels, integrals and redundancy, each with a verdict.

    ``scene``: a Scene, a path, a catalog name, a mapping or a System.
    ``budget``: seconds for the scene; what is not finished then is undecided. The work is then done in a process of
    its own, which is killed where it does not end by itself (1 s or a quarter of the budget later), or needs too much
    memory: then everything is undecided, and the reason says so. Without a budget it is done here, and no new part of
    it is begun after 60 s. ``method``: a name of `METHODS`; one alone leaves open what it cannot answer.
    Returns a Report: numbers of freedoms, names and texts, without units. Raises `SceneError` with every fault where
    the scene cannot be read as mathematics, and `ArgumentError` for what is no scene, no method or no number.

    >>> import dofkit
    >>> report = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]})
    >>> report.dof, report.constraints[0].integral, report.verdict
    (1, 'x*y = C', 'proved')
    """
    require_one_of(method, METHODS, "method")
    given = scene_or_system(scene)
    if budget is None:
        return _classified(given, DEFAULT_SECONDS, method)
    seconds = seconds_of(budget)
    report = in_worker(given, seconds, method)
    if report is not None:
        return report
    report = _classified(given, seconds, method)
    return report.model_copy(update={"warnings": [*report.warnings, _UNWATCHED]})


def stages(scene: Scene | System, seconds: float, method: MethodName = "auto") -> Iterator[Report]:
    """A report in which all is undecided, at once, and then what `classify` finds within so many seconds."""
    until = time.monotonic() + seconds
    system = _lowered(scene, seconds)
    if isinstance(system, Report):
        yield system
        return
    yield sketch(system, OUT_OF_TIME)
    yield _classified(system, until - time.monotonic(), method)


def _lowered(scene: Scene | System, seconds: float) -> System | Report:
    """The scene's mathematics; where there is no time even for that, a report that says so."""
    if isinstance(scene, System):
        return scene
    try:
        with limited(seconds):
            return lower(scene)
    except OutOfTimeError as error:
        return blank(scene, str(error))


def _classified(scene: Scene | System, seconds: float, method: MethodName) -> Report:
    until = time.monotonic() + seconds
    system = _lowered(scene, seconds)
    if isinstance(system, Report):
        return system
    try:
        if method not in BY_ENGINES:
            with limited(until - time.monotonic()):
                return report_alone(system, method)
        return examined(system, until - time.monotonic(), method).report
    except OutOfTimeError as error:
        return sketch(system, str(error))


def examined(
    system: System, seconds: float = DEFAULT_SECONDS, method: MethodName = "auto", reductions: Reductions = ALL
) -> Study:
    """All that is found of a system, and how; ``reductions``: those in use. Raises OutOfTimeError."""
    with limited(seconds), ctx.workprec(PRECISION):
        reduced, setting = prepared(system, reductions)
        setting = replace(setting, engines=METHODS[method].engines)
        with part(SOLVING):
            outcome = solve(system, reduced, setting)
        report = _report(system, reduced, setting, outcome)
        report = with_counts(system, reduced, setting, outcome, report)
        if method != "auto":
            return Study(system, setting, outcome, _by_one_engine(report, outcome, method))
        return Study(system, setting, outcome, _with_special_cases(system, reduced, setting, outcome, report))


def _with_special_cases(
    system: System, reduced: Sequence[Reduced], setting: Setting, outcome: Outcome, report: Report
) -> Report:
    look = partial(special_cases, system, reduced, setting, outcome, report, partial(_generic, setting.reductions))
    return report.model_copy(update=unless_late(look, {"warnings": [*report.warnings, _NO_SPECIAL_CASES]}))


def _generic(reductions: Reductions, system: System) -> Report:
    """The report without special cases."""
    reduced, setting = prepared(system, reductions)
    return _report(system, reduced, setting, solve(system, reduced, setting))


def derived_flag(scene: SceneLike | System, budget: float | None = None) -> list[int] | None:
    """The ranks of the codistribution I, of I', I'', ... down to its largest integrable part, at a generic point.

    I is spanned by the differentials of the finite relations and the Pfaffian forms of ``scene``; I' holds the forms
    of I whose differential vanishes modulo I. None where that is not certain in the time there is (no new part of the
    work is begun after it), or a relation is nonlinear in the velocities. Probable: exact arithmetic at random points.
    ``scene`` and ``budget`` (seconds) are as for `classify`, and so are the errors that are raised.

    >>> import dofkit
    >>> dofkit.derived_flag({"coordinates": ["x", "y", "z"], "constraints": ["dz = y dx"]})
    [1, 0]
    """
    seconds = DEFAULT_SECONDS if budget is None else seconds_of(budget)
    given = scene_or_system(scene)
    system = given if isinstance(given, System) else lower(given)
    try:
        with limited(seconds), ctx.workprec(PRECISION):
            reduced, setting = prepared(system)
            outcome = solve(system, reduced, replace(setting, flag=True))
    except OutOfTimeError:
        return None
    ranks = [a.derived for a in outcome.answers]
    if not outcome.consistent or any(b.nonlinear for b in outcome.blocks):
        return None
    known = [r for r in ranks if r is not None]
    if len(known) < len(ranks):
        return None
    return [sum(r[min(k, len(r) - 1)] for r in known) for k in range(max(map(len, known), default=0))]


class Study(NamedTuple):
    """A system as the engines see it, with what they found of it."""

    system: System
    setting: Setting
    outcome: Outcome
    report: Report


def studied(system: System, budget: float | None = None) -> Study:
    """What is known of a system, without its special cases. Raises OutOfTimeError where there was no time for it."""
    with limited(DEFAULT_SECONDS if budget is None else budget), ctx.workprec(PRECISION):
        reduced, setting = prepared(system)
        outcome = solve(system, reduced, setting)
        return Study(system, setting, outcome, _report(system, reduced, setting, outcome))


def _by_one_engine(report: Report, outcome: Outcome, method: MethodName) -> Report:
    """The report of one engine alone: no surer than the engine is, and what it cannot answer left open."""
    used = METHODS[method]
    entries = [e.model_copy(update={"verdict": weakest(e.verdict, used.best)}) for e in report.constraints]
    changes: dict[str, Any] = {
        "constraints": entries,
        "verdict": weakest(report.verdict, used.best),
        "method": f"{method} alone ({report.method}): {used.cannot}",
    }
    if (
        method == "field"
        and report.consistent
        and not all(_surely_real(b, a) for b, a in zip(outcome.blocks, outcome.answers, strict=True))
    ):
        changes["consistent"] = None
    return report.model_copy(update=changes)


def _surely_real(block: Block, a: Answer) -> bool:
    """Is there a real configuration for certain: no relation to satisfy, or one that was given?"""
    return a.instantaneous is not None or not (block.finite or block.nonlinear or a.hidden)


def _report(system: System, reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> Report:
    names = [c.name for c in system.constraints]
    impossible = outcome.consistent is False
    conflicting: list[int] = []
    nothing = left_open(i for i, r in enumerate(reduced) if r.normals)
    with part(DEPENDENCE):
        if impossible:
            conflicting = unless_late(partial(conflict, system, reduced, setting, outcome), conflicting)
        dependent = unless_late(partial(redundancies, reduced, setting, outcome), [nothing])
    company = Companionship(setting)
    equations = sum(r.equations for r in reduced)
    dof, velocity_dof = outcome.dof, outcome.velocity_dof
    redundant_equations = None if velocity_dof is None else max(0, equations - (len(system.coordinates) - velocity_dof))
    if redundant_equations == 0:
        dependent = [all_needed(r, reduced, outcome) for r in dependent]
    entries = entries_of(reduced, setting, outcome, dependent, names, company)
    instantaneous = _instantaneous(system, outcome)
    verdict = weakest(*(e.verdict for e in entries), *(a.verdict for a in outcome.answers))
    if outcome.consistent is None:
        verdict = "undecided"
    told = count(
        system,
        CountedFacts(
            sum(_finite_equations(r) for r in reduced),
            dof,
            outcome.consistent,
            _hidden(reduced, outcome),
            0,
            entries,
        ),
    )
    if redundant_equations == 0:
        dependent = [r for r in dependent if r.redundant]
    return Report(
        scene=system.name,
        consistent=outcome.consistent,
        dof=dof,
        velocity_dof=velocity_dof,
        instantaneous_dof=instantaneous,
        singular=None if instantaneous is None or velocity_dof is None else instantaneous != velocity_dof,
        holonomic=_all([e.holonomic for e in entries]),
        scleronomic=_all([e.scleronomic for e in entries]),
        count=told,
        redundant_equations=redundant_equations,
        redundant=[names[i] for i in sorted({i for r in dependent for i in r.redundant})],
        redundancies=[
            Redundancy(nullity=nullity, members=[names[i] for i in members]) for nullity, members in merged(dependent)
        ],
        conflicting=[names[i] for i in conflicting],
        generalized_coordinates=unless_late(partial(_generalized, system, setting, outcome), None),
        growth_vector=_growth(outcome, entries),
        integrable_part=unless_late(partial(integrable_part, outcome, entries, company), None),
        constraints=entries,
        forces=[ForceEntry(name=f.name, reason=f.reason) for f in system.forces],
        special_cases=[],
        verdict=verdict,
        method="; ".join(dict.fromkeys(a.method for a in outcome.answers if a.method)) or "count",
        modelled=_modelled(system, outcome),
        warnings=_warnings(system, reduced, outcome),
    )


def _all(labels: Sequence[bool | None]) -> bool | None:
    """True where all are, False where one is not, else None."""
    if any(label is False for label in labels):
        return False
    return None if any(label is None for label in labels) else True


def _finite_equations(r: Reduced) -> int:
    return sum(all(isinstance(p, Finite) for p in normal.pieces) for normal in r.normals)


def _hidden(reduced: Sequence[Reduced], outcome: Outcome) -> int:
    """Hidden relations between coordinates."""
    constants = [c for r in reduced for c in r.constants]
    return sum(not about_constants(g, constants) for a in outcome.answers for g in a.hidden)


def _instantaneous(system: System, outcome: Outcome) -> int | None:
    if system.reference is None or outcome.consistent is not True or outcome.kinked:
        return None
    if outcome.first_order is not None:
        return outcome.first_order
    parts = [a.instantaneous for a in outcome.answers]
    if any(p is None for p in parts):
        return None
    return len(outcome.untouched) + sum(p for p in parts if p is not None)


def _generalized(system: System, setting: Setting, outcome: Outcome) -> list[str] | None:
    """An independent choice of ``dof`` coordinates: those that are not pivots of what integrates."""
    if outcome.dof is None:
        return None
    chosen = set(outcome.untouched)
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        own = generalized(block, a, setting, system.rotations)
        if own is None:
            return None
        chosen |= set(own)
    return [c.name for c in system.coordinates if c.name in chosen]


def _growth(outcome: Outcome, entries: Sequence[ConstraintEntry]) -> list[int] | None:
    """Dimensions of D, D + [D, D], ... for the whole: blocks do not bracket with each other; they share only time."""
    if not outcome.consistent or not any(b.forms for b in outcome.blocks):
        return None
    growths: list[tuple[int, ...]] = []
    timed = timeless = 0
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        shared = uses_time(block)
        timed += shared
        owners = {r.constraint for r in block.rows}
        timeless += shared and all(entries[i].scleronomic and entries[i].catastatic is not False for i in owners)
        if block.nonlinear or (a.growth is None and block.forms) or a.velocity_dof is None:
            return None
        growths.append(a.growth if a.growth is not None else (a.velocity_dof + shared,))
    length = max(len(g) for g in growths)
    base = len(outcome.untouched) - (timed if timed == timeless else max(0, timed - 1))
    return [base + sum(g[min(k, len(g) - 1)] for g in growths) for k in range(length)]


def _modelled(system: System, outcome: Outcome) -> str:
    parts = []
    touched = len(system.coordinates) - len(outcome.untouched)
    if outcome.blocks:
        many = len(outcome.blocks)
        parts.append(f"{touched} coordinates in {many} independent part{'s' if many > 1 else ''}")
    if outcome.untouched:
        shown = ", ".join(outcome.untouched[:12]) + (", ..." if len(outcome.untouched) > 12 else "")
        parts.append(f"counted but not computed with, because nothing constrains them: {shown}")
    finite = sum(not b.forms and not b.nonlinear for b in outcome.blocks)
    if finite:
        parts.append("no integrability test where all relations are finite (d(dg) = 0)")
    parts += _looked_at(outcome)
    if system.forces:
        parts.append("forces are left out: they do not constrain")
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
        many = sum(len(b.rows) for b in outcome.blocks)
        yield f"{left_out} of {many} relations are in no dependent set (trees and the like): not followed"
    if rigid:
        yield f"{rigid} dependent set{'s' * (rigid > 1)} taken for one rigid body each"
    if followed and left_out:
        yield f"{followed} other dependent set{'s' * (followed > 1)} followed apart from all else"
    spared = sum(k.spared for k in looked)
    if spared:
        yield (
            f"{spared} coordinate{'s' * (spared > 1)} fewer where motions were followed (welded bodies and rigid "
            "clusters as one, bodies that do not turn as particles, what a linear relation gives explicitly)"
        )


def _warnings(system: System, reduced: Sequence[Reduced], outcome: Outcome) -> list[str]:
    found = list(system.warnings)
    for r in reduced:
        for normal in r.normals:
            found += [f"'{r.constraint.name}': {note}" for note in normal.notes]
            if len(normal.branches) > 1:
                found.append(BRANCH_WARNING.format(name=r.constraint.name))
        found += [f"'{r.constraint.name}': {note}" for note in r.constraint.notes]
    for a in outcome.answers:
        found += a.reasons
        found += [f"hidden finite relation: {shown(g)} = 0" for g in a.hidden]
    return list(dict.fromkeys(found))


def shown(e: Expr) -> str:
    """An expression as text."""
    from dofkit.expressions.text import to_text

    return to_text(e)
