"""A scene classified in a process that can be killed. Where there are none, as in a browser, this is not imported."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

from dofkit.base.deadline import limit
from dofkit.base.errors import Fault, SceneError
from dofkit.base.runs import shared
from dofkit.base.workers import Job, Json
from dofkit.classification.undecided import sketch, undecided
from dofkit.methods.stages import blank, stages
from dofkit.methods.table import MethodName
from dofkit.report import Report
from dofkit.scene.scene import Scene
from dofkit.system import System

#: The function that a worker runs.
WORKER_STAGES = "dofkit.methods.supervised:worker_stages"


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
