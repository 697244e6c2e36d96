"""A case answered, in this process or in a worker that is killed where it does not end, and what is wrong with it."""

from __future__ import annotations

import traceback
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import dofkit
from dofkit.base.deadline import by_processor
from dofkit.base.runs import Pool
from dofkit.base.workers import Job
from dofkit.benchmark.trials.construction import KnownScene

from .judgement import judged, overall, rechecked

#: Seconds of processor time for one scene.
SECONDS = 60.0


class Answer(NamedTuple):
    """``report`` as JSON where there is one; otherwise ``why`` not, and the ``end``.

    A scene that is ``refused``, as too large to read, is no fault; one that ``failed``, or was ``killed``, is.
    ``verified`` and ``unaccepted``: what the checker says, where it was asked (see `rechecked`).
    """

    end: str
    report: Mapping[str, Any] | None
    why: str = ""
    verified: Sequence[str] = ()
    unaccepted: Mapping[str, str] = {}


def answered(scene: Mapping[str, Any], seconds: float = SECONDS, *, certificates: bool = False) -> Answer:
    """Return the answer of this process; its time is counted by the processor. ``certificates``: ask the checker."""
    try:
        with by_processor(seconds):
            report = dofkit.classify(dict(scene), certificate=certificates)
        verified, unaccepted = rechecked(scene, report) if certificates else ([], {})
        told = report.model_dump(mode="json", exclude={"certificate"})
        return Answer("answered", told, "", verified, unaccepted)
    except dofkit.SceneError as error:
        return Answer("refused", None, str(error))
    except Exception as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        return Answer("failed", None, f"{type(error).__name__}: {error} ({Path(where.filename).stem}.{where.name})")


def answered_apart(
    pool: Pool, scene: Mapping[str, Any], seconds: float = SECONDS, *, certificates: bool = False
) -> Answer:
    """Return the answer of a worker, which is killed after twice the time."""
    ended = pool.run(Job(_answered, (dict(scene), seconds, certificates), 2 * seconds + 10))
    return Answer(*ended.value) if ended.finished else Answer("killed", None, ended.reason)


def _answered(asked: tuple[Mapping[str, Any], float, bool]) -> Answer:
    scene, seconds, certificates = asked
    return answered(scene, seconds, certificates=certificates)


def faults(case: KnownScene, answer: Answer) -> dict[str, Any]:
    """Return the fields that are answered wrongly with their values; or the end, where there is no report.

    Where the checker was asked, ``certified FIELD`` is wrong and verified; the claims that it refuses are faults too.
    """
    if answer.report is None:
        return {} if answer.end == "refused" else {answer.end: answer.why}
    wrong = [judgement for judgement in judged(case, answer.report) if judgement.outcome == "wrong"]
    sure = {row.field for row in wrong if row.verdict == "proved"} & {*answer.verified}
    values = {f"{'certified ' * (row.field in sure)}{row.field}": f"{row.value} ({row.verdict})" for row in wrong}
    return {**values, **answer.unaccepted}


def outcome(case: KnownScene, answer: Answer) -> str:
    """Return ``right``, ``undecided`` or ``wrong``; or how it ended without a report."""
    return answer.end if answer.report is None else overall(judged(case, answer.report))
