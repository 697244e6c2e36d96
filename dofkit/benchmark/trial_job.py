"""A trial in a worker: the method answers, and its processor time is taken."""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from dofkit.base.workers import Json
from dofkit.base.workers.child import LateError, function_named, interrupting
from dofkit.methods.table import Knobs, MethodReply

#: What is shorter, in seconds, is done again, so many times, and the least is taken.
SHORT, AGAIN = 0.05, 2
#: What a worker imports before its first job.
MODULES = ("dofkit.benchmark.trial_job", "dofkit.methods.ask", "sympy")
#: A method's first call in a process also loads what it needs: it answers this first, and no clock runs.
_WARM_SCENE: Mapping[str, Any] = {
    "name": "warm",
    "coordinates": ["x", "y", "u"],
    "constraints": [
        {"name": "circle", "type": "equation", "text": "x^2 + y^2 = 1"},
        {"name": "edge", "type": "equation", "text": "xdot*sin(u) - ydot*cos(u) = 0"},
    ],
}
_WARM_ANSWER = {"constraint": "circle", "text": "2*x^2 + 2*y^2 = 2"}
_warm: set[tuple[str, str, str]] = set()


@dataclass(frozen=True)
class TrialQuestion:
    """What a worker is asked: a question about a scene, for one method; ``limit`` in seconds of processor time.

    ``again``: how often a short one is repeated; ``answering``: what knows the methods, as ``module:function``.
    """

    scene: Mapping[str, Any]
    question: str
    method: str
    knobs: Knobs
    answer: Mapping[str, str] | None
    limit: float
    again: int = AGAIN
    answering: str = "dofkit.methods.ask:answered"


def timed_reply(asked: TrialQuestion) -> Json:
    """What is told, as a mapping ``value, reason, cannot``, with ``seconds``; None where these went beyond the limit.

    What is late is interrupted, so that the process stays warm; only what cannot be is killed with it.
    """
    function = function_named(asked.answering)
    _warm_up(function, asked)
    try:
        with interrupting(asked.limit):
            told, seconds = _timed(function, asked)
    except LateError:
        return None
    if seconds < SHORT:
        seconds = min([seconds, *(_timed(function, asked)[1] for _ in range(asked.again))])
    return {**asdict(told), "seconds": seconds}


def _timed(function: Any, asked: TrialQuestion) -> tuple[MethodReply, float]:
    """What SymPy remembers is forgotten first: each trial counts for itself."""
    if "sympy" in sys.modules:
        sys.modules["sympy"].core.cache.clear_cache()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        start = time.thread_time()
        try:
            told: MethodReply = function(asked.scene, asked.question, asked.method, asked.knobs, asked.answer)
        except MemoryError:
            raise
        except Exception as error:
            said = " ".join(str(error).split())[:200]
            told = MethodReply(None, f"it failed: {type(error).__name__}: {said}")
        return told, time.thread_time() - start


def _warm_up(function: Any, asked: TrialQuestion) -> None:
    key = (asked.answering, asked.question, asked.method)
    if key in _warm:
        return
    _warm.add(key)
    answer = _WARM_ANSWER if asked.question == "equivalence" else None
    first = TrialQuestion(_WARM_SCENE, asked.question, asked.method, Knobs(), answer, asked.limit)
    _timed(function, first)


def ablation_rows(quick: bool) -> Iterator[Json]:
    """What each reduction of the model saves: all rows so far, each time there is one more."""
    rows: list[Json] = []
    for row in function_named("dofkit.benchmark.ablation:ablation")(quick):
        rows.append(row.model_dump())
        yield rows
