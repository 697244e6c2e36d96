"""What was handed in at one place, in a worker: read, graded, and returned as lines of JSON."""

from __future__ import annotations

import pickle
from collections.abc import Generator, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple

from dofkit.base.process_limits import allow_processor
from dofkit.base.workers import Json
from dofkit.homework.answers.sources import Handed
from dofkit.homework.answers.submission import Submission
from dofkit.homework.assignment import Prepared
from dofkit.homework.echo import Echo, echo
from dofkit.homework.grading import ANSWER_SECONDS, Grader, Spot
from dofkit.homework.result import Result


class ResultLine(NamedTuple):
    """What is written of a submission: whose it is, whether it could not be graded, and the JSON.

    ``doubted``: whether a person has to say whose it is.
    """

    student: str
    failed: bool
    text: str
    doubted: bool = False

    @classmethod
    def of(cls, result: Result | Echo) -> ResultLine:
        """The line of a result."""
        return cls(result.student, result.error is not None, result.model_dump_json())


@dataclass(frozen=True)
class Orders:
    """How to grade: the pickled assignment, and limits in seconds of processor time.

    ``seconds``: for one answer, which then needs a review; ``hard``: after which its process is ended. ``wall``: the
    same by the clock. ``check_only``: read the answers and do not grade them.
    """

    assignment: bytes
    max_score: float
    check_only: bool = False
    seconds: float = ANSWER_SECONDS
    hard: float = 2 * ANSWER_SECONDS
    wall: float = 60.0

    @classmethod
    def of(cls, prepared: Prepared, check_only: bool = False) -> Orders:
        """Orders to grade an assignment."""
        points = sum((question.points for _, question in prepared.questions()), Fraction(0))
        return cls(pickle.dumps(prepared), float(points), check_only)

    def refused(self, student: str, error: str) -> ResultLine:
        """The line of a submission that could not be graded."""
        if self.check_only:
            return ResultLine.of(Echo(student=student, items=[], error=error))
        return ResultLine.of(Result(student=student, score=None, max_score=self.max_score, items=[], error=error))


@dataclass(frozen=True)
class GradingTask:
    """Something handed in, to be graded. ``condemned``: why some answers are not to be judged."""

    orders: Orders
    handed: Handed
    condemned: Mapping[Spot, str] = field(default_factory=dict)


def graded_lines(task: GradingTask) -> Iterator[Json]:
    """Yield ``{"next": ...}`` before each answer that takes work, and at the end ``{"lines": ...}``."""
    grader = _grader(task.orders)
    grader.condemned = task.condemned
    lines: list[ResultLine] = []
    allow_processor(task.orders.hard)
    for submission in task.handed.submissions(grader.prepared.columns()):
        allow_processor(task.orders.hard)
        steps = _steps(grader, submission, task.orders.check_only)
        while True:
            try:
                spot = next(steps)
            except StopIteration as stop:
                lines.append(ResultLine.of(stop.value))
                break
            yield {"next": spot}
            allow_processor(task.orders.hard)
    yield {"lines": lines}


def _steps(grader: Grader, submission: Submission, check_only: bool) -> Generator[Spot, None, Any]:
    if check_only:
        return echo(grader.prepared, submission)
    return (yield from grader.steps(submission))


@lru_cache(maxsize=2)
def _grader(orders: Orders) -> Grader:
    prepared: Prepared = pickle.loads(orders.assignment)
    return Grader(prepared, orders.seconds)
