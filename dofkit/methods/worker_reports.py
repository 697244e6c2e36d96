"""The classification of a scene in a worker process: past its budget it is killed, and nothing is decided.

Both halves of the conversation: what the parent asks and makes of it, and what the worker does.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from dofkit.base.deadline import limit
from dofkit.base.errors import Fault, SceneError
from dofkit.base.runs import shared
from dofkit.base.workers import Job, Json
from dofkit.classification.undecided import sketch, undecided
from dofkit.methods.names import MethodName
from dofkit.methods.stages import stages
from dofkit.methods.unread import blank
from dofkit.report import Report
from dofkit.scene.scene import Scene
from dofkit.system import System

#: The function that a worker is asked for, `classified` below.
CLASSIFIED = "dofkit.methods.worker_reports:classified"


def report_from_worker(scene: Scene | System, budget: float, method: MethodName) -> Report | None:
    """The report on a scene, from a worker; None where no process can be started here.

    Raises SceneError with the faults of the scene, RuntimeError where the classification itself fails.
    """
    outcome = shared(__name__).run(Job(CLASSIFIED, (scene, budget, method), limit(budget)))
    found = outcome.value or {}
    if "faults" in found:
        raise SceneError(tuple(_fault(f) for f in found["faults"]), found["source"])
    if outcome.ended == "absent":
        return None
    if outcome.ended == "failed":
        error = RuntimeError(f"the classification failed with {outcome.reason}")
        error.add_note(outcome.trace)
        raise error
    if "report" in found:
        report = Report.model_validate(found["report"])
        return report if outcome.finished else undecided(report, outcome.reason)
    return sketch(scene, outcome.reason) if isinstance(scene, System) else blank(scene, outcome.reason)


def classified(payload: tuple[Scene | System, float, MethodName]) -> Iterator[Json]:
    """In the worker: of a scene, a budget in seconds and a method, its report after a sketch of it; or its faults."""
    scene, budget, method = payload
    try:
        for report in stages(scene, budget, method):
            yield {"report": report.model_dump(mode="json")}
    except SceneError as error:
        yield {"faults": [asdict(fault) for fault in error.faults], "source": error.source}


def _fault(told: dict[str, Any]) -> Fault:
    return Fault(**{**told, "where": tuple(told["where"])})
