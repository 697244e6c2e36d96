"""Entry points: `classify` reports everything about a scene, `derived_flag` returns the ranks of its derived flag.

With a budget a scene is classified in a worker process, which can be killed: it first returns a report in which
everything is undecided, then the finished one.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, replace
from typing import Any, overload

from dofkit.base.deadline import DEFAULT_SECONDS, OUT_OF_TIME, OutOfTimeError, gc_rarely, limit, limited
from dofkit.base.errors import ArgumentError, Fault, SceneError
from dofkit.base.wording import require_one_of, seconds_of
from dofkit.classification.passes import PASSES, PLAIN, examined
from dofkit.classification.study import study
from dofkit.classification.undecided import open_entry, open_report, sketch, undecided, why_nothing
from dofkit.exact.points.balls import precise_for
from dofkit.methods.single_method import report_of_engine, report_of_method
from dofkit.methods.table import ENGINES, METHODS, MethodName
from dofkit.report import Count, ForceEntry, Report
from dofkit.scene.lowering import lower
from dofkit.scene.names import names_by_position
from dofkit.scene.reading import SceneLike, scene_or_system
from dofkit.scene.scene import Scene
from dofkit.system import BODY_ROLES, Constraint, System

#: The function that a worker runs.
WORKER_STAGES = "dofkit.methods.classify:worker_stages"
#: Several scenes for one call of `classify`.
Scenes = list[SceneLike | System] | tuple[SceneLike | System, ...]

_UNWATCHED = "No worker process could be started here: the time was watched, but nothing would have been killed."


@overload
def classify(
    scene: SceneLike | System, budget: float | None = None, method: MethodName = "auto", certificate: bool = False
) -> Report: ...


@overload
def classify(
    scene: Scenes, budget: float | None = None, method: MethodName = "auto", certificate: bool = False
) -> list[Report]: ...


def classify(
    scene: SceneLike | System | Scenes,
    budget: float | None = None,
    method: MethodName = "auto",
    certificate: bool = False,
) -> Report | list[Report]:
    """Return how a system can move: degrees of freedom, labels, integrals and redundancy, each with a verdict.

    Parameters
    ----------
    scene
        A Scene, a path, a catalog name, a mapping or a System; or a list or tuple of these.
    budget
        Seconds for each scene. The work is then done in a process of its own, which is killed if it does not end or
        needs too much memory; what is not finished is undecided. Without a budget no new step begins after 60 s.
    method
        ``"auto"``, or one method on its own, which leaves undecided what it cannot answer.
    certificate
        Whether to add the evidence for `verify`; an answer that the evidence contradicts becomes undecided.

    Returns
    -------
    Report or list of Report
        Numbers of freedoms are whole numbers without a unit; equations are texts. A list gives a list, in order.

    Raises
    ------
    SceneError
        If a scene cannot be read. All scenes of a list are read first, and all their faults are raised at once.
    ArgumentError
        If an argument is no scene, no method or no number of seconds.

    Examples
    --------
    >>> import dofkit
    >>> report = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]})
    >>> report.dof, report.constraints[0].integral, report.verdict
    (1, 'x*y = C', 'proved')
    >>> [report.dof for report in dofkit.classify(["four-bar-linkage", "disc-rolling-on-plane"])]
    [1, 4]
    """
    require_one_of(method, METHODS, "method")
    if isinstance(scene, list | tuple):
        return [_certified(loaded, budget, method, certificate) for loaded in _all_read(scene)]
    return _certified(scene_or_system(scene), budget, method, certificate)


def _all_read(scenes: Scenes) -> list[Scene | System]:
    """Return all scenes, read. Raises one SceneError with the faults of all scenes, located by position in the list."""
    read: list[Scene | System] = []
    faults: list[Fault] = []
    for position, scene in enumerate(scenes):
        try:
            read.append(scene_or_system(scene))
        except SceneError as error:
            source = f"{error.source}: " if error.source else ""
            faults += [
                replace(fault, message=source + fault.message, where=(position, *fault.where)) for fault in error.faults
            ]
    if faults:
        raise SceneError(tuple(faults))
    return read


def _certified(loaded: Scene | System, budget: float | None, method: MethodName, certificate: bool) -> Report:
    """Return the report, with a certificate if wanted. Raises ArgumentError for a certificate of a System."""
    if not certificate:
        return _within_budget(loaded, budget, method).with_scene(loaded)
    if isinstance(loaded, System):
        raise ArgumentError("a certificate needs a Scene: a System has no text that the checker could read")
    from dofkit.methods.certificates.lowering import with_certificate

    return with_certificate(loaded, _within_budget(loaded, budget, method).with_scene(loaded))


def _within_budget(loaded: Scene | System, budget: float | None, method: MethodName) -> Report:
    """Return the report; with a budget from a worker process, or if none can be started with a warning."""
    if budget is None:
        return classified(loaded, DEFAULT_SECONDS, method)
    seconds = seconds_of(budget)
    if sys.platform != "emscripten":  # a browser has no processes
        report = _report_from_worker(loaded, seconds, method)
        if report is not None:
            return report
    report = classified(loaded, seconds, method)
    return report.model_copy(update={"warnings": [*report.warnings, _UNWATCHED]})


def _report_from_worker(scene: Scene | System, budget: float, method: MethodName) -> Report | None:
    """Return the report on a scene from a worker process that can be killed, or None if none can be started.

    Raises SceneError with the faults of the scene, RuntimeError if the classification itself fails.
    """
    from dofkit.base.runs import shared
    from dofkit.base.workers import Job

    outcome = shared(__name__).run(Job(WORKER_STAGES, (scene, budget, method), limit(budget)))
    value = outcome.value or {}
    if "faults" in value:
        faults = tuple(Fault(**{**fault, "where": tuple(fault["where"])}) for fault in value["faults"])
        raise SceneError(faults, value["source"])
    if outcome.ended == "absent":
        return None
    if outcome.ended == "failed":
        error = RuntimeError(f"the classification failed with {outcome.reason}")
        error.add_note(outcome.trace)
        raise error
    if "report" in value:
        report = Report.model_validate(value["report"])
        return report if outcome.finished else undecided(report, outcome.reason)
    return sketch(scene, outcome.reason) if isinstance(scene, System) else blank(scene, outcome.reason)


def worker_stages(payload: tuple[Scene | System, float, MethodName]) -> Iterator[dict[str, Any]]:
    """In the worker: yield a report in which everything is undecided, then the finished one; or the scene's faults."""
    scene, budget, method = payload
    until = time.monotonic() + budget
    try:
        answer = lowered(scene, budget)
    except SceneError as error:
        yield {"faults": [asdict(fault) for fault in error.faults], "source": error.source}
        return
    if isinstance(answer, System):
        yield {"report": sketch(answer, OUT_OF_TIME).model_dump(mode="json")}
        answer = _report_of(answer, until - time.monotonic(), method)
    yield {"report": answer.model_dump(mode="json")}


@gc_rarely()
def classified(scene: Scene | System, seconds: float, method: MethodName = "auto") -> Report:
    """Return the report, undecided where ``seconds`` do not suffice. Raises SceneError if the scene cannot be read."""
    until = time.monotonic() + seconds
    system = lowered(scene, seconds)
    return system if isinstance(system, Report) else _report_of(system, until - time.monotonic(), method)


def lowered(scene: Scene | System, seconds: float) -> System | Report:
    """Return the system of a scene, or an undecided report if ``seconds`` do not suffice to read the scene."""
    if isinstance(scene, System):
        return scene
    try:
        with limited(seconds):
            return lower(scene)
    except OutOfTimeError as error:
        return blank(scene, str(error))


def _report_of(system: System, seconds: float, method: MethodName) -> Report:
    """Return the report of a method on a system; everything is undecided if ``seconds`` do not suffice."""
    engines = ENGINES.get(method)
    try:
        if engines is None:
            with limited(seconds):
                return report_of_method(system, method)
        study = examined(system, seconds, engines, passes=PASSES if method == "auto" else PLAIN)
        return study.report if method == "auto" else report_of_engine(study.report, study.outcome, method)
    except OutOfTimeError as error:
        return sketch(system, str(error))


def blank(scene: Scene, why: str) -> Report:
    """Return the undecided report, with the reason ``why``, on a scene whose equations were not read in time."""
    d, particles, bodies = scene.dimension, len(scene.particles), len(scene.bodies)
    coordinates = d * particles + len(BODY_ROLES[d]) * bodies + len(scene.coordinates)
    count = Count(
        particles=particles,
        bodies=bodies,
        dimension=d,
        coordinates=coordinates,
        constraints=0,
        independent=None,
        naive_dof=coordinates,
        formula=f"f = n - k = {coordinates} - k",
        errs="the equations were not counted",
    )
    names = names_by_position("c", [c.name for c in scene.constraints])
    constraints = [
        Constraint(name, c.kind(), c.facts, c.in_words, ()) for name, c in zip(names, scene.constraints, strict=True)
    ]
    forces = [
        ForceEntry(name=name, reason=f.reason)
        for name, f in zip(names_by_position("f", [f.name for f in scene.forces]), scene.forces, strict=True)
    ]
    return open_report(scene.name, count, [open_entry(c, why) for c in constraints], forces, [why_nothing(why)])


def strict_report(scene: Scene) -> Report:
    """Return the report whose proved answers were checked; in a browser, which has no checker, they are not."""
    if sys.platform == "emscripten":
        return classify(scene)
    from dofkit.methods.certificates.lowering import with_certificate

    return with_certificate(scene, classify(scene), strict=True)


def derived_flag(scene: SceneLike | System, budget: float | None = None) -> list[int] | None:
    """Return the ranks of I, I', I'', ... at a generic point, down to the largest integrable part.

    The codistribution I is spanned by the differentials of the holonomic equations and by the Pfaffian forms of the
    scene; I' consists of the forms w in I with dw = 0 modulo I. The ranks are computed by exact arithmetic at random
    points (``probable``).

    Parameters
    ----------
    scene, budget
        As for `classify`; no new step begins after ``budget`` seconds.

    Returns
    -------
    list of int, or None
        None if a constraint is nonlinear in the velocities, or the ranks were not decided in time.

    Raises
    ------
    SceneError, ArgumentError
        As for `classify`.

    References
    ----------
    G. Frobenius, Ueber das Pfaffsche Problem, 1877: the last I is integrable.

    Examples
    --------
    >>> import dofkit
    >>> dofkit.derived_flag({"coordinates": ["x", "y", "z"], "constraints": ["dz = y dx"]})
    [1, 0]
    """
    seconds = DEFAULT_SECONDS if budget is None else seconds_of(budget)
    loaded = scene_or_system(scene)
    system = loaded if isinstance(loaded, System) else lower(loaded)
    try:
        with limited(seconds), precise_for(system.longest):
            outcome = study(system, flag=True).outcome
    except OutOfTimeError:
        return None
    ranks = [a.derived for a in outcome.answers]
    if not outcome.consistent or any(b.nonlinear for b in outcome.blocks):
        return None
    decided = [r for r in ranks if r is not None]
    if len(decided) < len(ranks):
        return None
    return [sum(r[min(k, len(r) - 1)] for r in decided) for k in range(max(map(len, decided), default=0))]
