"""A scene classified in stages: first a report in which everything is undecided, then the finished one.

`report_from_worker` does the same in a process that can be killed, and `worker_stages` is what that process runs.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import asdict

from dofkit.base.deadline import OUT_OF_TIME, OutOfTimeError, gc_rarely, limit, limited
from dofkit.base.errors import Fault, SceneError
from dofkit.base.runs import shared
from dofkit.base.workers import Job, Json
from dofkit.classification.passes import PASSES, PLAIN, examined
from dofkit.classification.undecided import open_entry, open_report, sketch, undecided, why_nothing
from dofkit.methods.single_reports import report_of_engine, report_of_method
from dofkit.methods.table import METHODS, MethodName
from dofkit.report import Count, ForceEntry, Report
from dofkit.scene.lowering import lower
from dofkit.scene.names import names_by_position
from dofkit.scene.scene import Scene
from dofkit.system import BODY_ROLES, Constraint, System

#: The function that a worker runs.
WORKER_STAGES = "dofkit.methods.stages:worker_stages"


def stages(scene: Scene | System, seconds: float, method: MethodName = "auto") -> Iterator[Report]:
    """Yield a report in which everything is undecided, then the one that is finished within so many seconds.

    Raises SceneError where the scene cannot be read as mathematics.
    """
    until = time.monotonic() + seconds
    system = lowered(scene, seconds)
    if isinstance(system, Report):
        yield system
        return
    yield sketch(system, OUT_OF_TIME)
    yield _classified(system, until - time.monotonic(), method)


@gc_rarely()
def classified(scene: Scene | System, seconds: float, method: MethodName = "auto") -> Report:
    """Return the last of the `stages`."""
    until = time.monotonic() + seconds
    system = lowered(scene, seconds)
    return system if isinstance(system, Report) else _classified(system, until - time.monotonic(), method)


def lowered(scene: Scene | System, seconds: float) -> System | Report:
    """Return the scene's equations, or a report that says that there was no time even for reading them."""
    if isinstance(scene, System):
        return scene
    try:
        with limited(seconds):
            return lower(scene)
    except OutOfTimeError as error:
        return blank(scene, str(error))


def _classified(system: System, seconds: float, method: MethodName) -> Report:
    engines = METHODS[method].engines
    try:
        if not engines:
            with limited(seconds):
                return report_of_method(system, method)
        study = examined(system, seconds, engines, passes=PASSES if method == "auto" else PLAIN)
        return study.report if method == "auto" else report_of_engine(study.report, study.outcome, method)
    except OutOfTimeError as error:
        return sketch(system, str(error))


def blank(scene: Scene, why: str) -> Report:
    """Return a report on a scene whose equations could not be read in time: they are not counted."""
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


# in a worker process


def report_from_worker(scene: Scene | System, budget: float, method: MethodName) -> Report | None:
    """Return the report on a scene from a worker, or None where no process can be started here.

    Raises SceneError with the faults of the scene, RuntimeError where the classification itself fails.
    """
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


def worker_stages(payload: tuple[Scene | System, float, MethodName]) -> Iterator[Json]:
    """Yield the stages of a scene's report, in the worker, or the faults of the scene."""
    scene, budget, method = payload
    try:
        for report in stages(scene, budget, method):
            yield {"report": report.model_dump(mode="json")}
    except SceneError as error:
        yield {"faults": [asdict(fault) for fault in error.faults], "source": error.source}
