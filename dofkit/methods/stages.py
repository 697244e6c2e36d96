"""A scene classified in stages: at once a report in which all is undecided, then what was found."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

from dofkit.base.deadline import OUT_OF_TIME, OutOfTimeError, gc_rarely, limited
from dofkit.base.verdicts import weakest
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.passes import PASSES, PLAIN, examined
from dofkit.classification.undecided import sketch
from dofkit.methods.names import MethodName
from dofkit.methods.shared.reporting import report_alone
from dofkit.methods.shared.row import Method
from dofkit.methods.table import METHODS
from dofkit.methods.unread import blank
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block
from dofkit.report import Report
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene
from dofkit.system import System


def stages(scene: Scene | System, seconds: float, method: MethodName = "auto") -> Iterator[Report]:
    """A report in which all is undecided, at once, and then what is found within so many seconds.

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
    """The last of the `stages`."""
    until = time.monotonic() + seconds
    system = lowered(scene, seconds)
    return system if isinstance(system, Report) else _classified(system, until - time.monotonic(), method)


def lowered(scene: Scene | System, seconds: float) -> System | Report:
    """The scene's mathematics; where there is no time even for that, a report that says so."""
    if isinstance(scene, System):
        return scene
    try:
        with limited(seconds):
            return lower(scene)
    except OutOfTimeError as error:
        return blank(scene, str(error))


def _classified(system: System, seconds: float, method: MethodName) -> Report:
    row = METHODS[method]
    try:
        if not row.engines:
            with limited(seconds):
                return report_alone(system, method, row)
        found = examined(system, seconds, row.engines, passes=PASSES if method == "auto" else PLAIN)
        return found.report if method == "auto" else _by_one_engine(found.report, found.outcome, method, row)
    except OutOfTimeError as error:
        return sketch(system, str(error))


def _by_one_engine(report: Report, outcome: Outcome, method: MethodName, row: Method) -> Report:
    """The report of one engine alone: no surer than the engine is, and what it cannot answer left open."""
    entries = [e.model_copy(update={"verdict": weakest(e.verdict, row.best)}) for e in report.constraints]
    changes: dict[str, Any] = {
        "constraints": entries,
        "verdict": weakest(report.verdict, row.best),
        "method": f"{method} alone ({report.method}): {row.cannot}",
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
