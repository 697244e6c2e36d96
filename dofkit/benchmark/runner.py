"""Runs trials by methods, each in a worker that can be killed: a crash or timeout costs the line of that trial only.

The first half runs in a worker; the second distributes the trials and compares the answers with the truth.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import contextmanager, nullcontext
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

from dofkit.base.process_limits import LateError, interrupting
from dofkit.base.runs import Pool, StoppedError
from dofkit.base.worker_process import function_named
from dofkit.base.workers import MEMORY, Job, Json
from dofkit.base.workers import JobOutcome as Ended
from dofkit.benchmark.record import Outcome, TrialLine
from dofkit.benchmark.sentences import explained
from dofkit.benchmark.statistics import grouped
from dofkit.benchmark.tasks import TrialTask
from dofkit.methods.table import Reply

# In a worker

#: A reply in less than `SHORT` seconds is timed `AGAIN` more times, and the least time is taken.
SHORT, AGAIN = 0.05, 2
#: The modules that a worker imports first, and the function (``module:function``) that answers by a method.
MODULES, ANSWERING = ("dofkit.benchmark.runner", "dofkit.methods.ask", "sympy"), "dofkit.methods.ask:answered"
#: The scene for an untimed first call of a method in a process, which loads the libraries that the method needs.
_WARM_SCENE: Mapping[str, Any] = {
    "name": "warm",
    "coordinates": ["x", "y", "u"],
    "constraints": [
        {"name": "circle", "type": "equation", "text": "x^2 + y^2 = 1"},
        {"name": "edge", "type": "equation", "text": "xdot*sin(u) - ydot*cos(u) = 0"},
    ],
}
_WARM_ANSWER = {"constraint": "circle", "text": "2*x^2 + 2*y^2 = 2"}
#: {setting: context manager that sets its value, as ``module:function``}.
SETTINGS = {"tolerance": "dofkit.methods.numeric:tolerance_of", "bits": "dofkit.exact.points.balls:balls_of"}
_warm: set[tuple[str, str, str]] = set()


def timed_reply(asked: tuple[TrialTask, float, str]) -> Json:
    """Return the timed reply to ``asked``: (task, limit of processor time in seconds, answering ``module:function``).

    The reply is a mapping with ``value``, ``verdict``, ``reason``, ``cannot`` and ``seconds``; None if it took longer:
    then it is interrupted, and the process goes on. What cannot be interrupted is killed with the process. A tiny scene
    is answered first, so that imports are not timed; the least time of several counts where it is short.
    """
    task, limit, answering = asked
    function = partial(function_named(answering), task.trial.scene, task.trial.question, task.method, task.trial.answer)
    key = (answering, task.trial.question, task.method)
    if key not in _warm:
        _warm.add(key)
        answer = _WARM_ANSWER if task.trial.question == "equivalence" else None
        _timed(partial(function_named(answering), _WARM_SCENE, task.trial.question, task.method, answer))
    setting = function_named(SETTINGS[task.setting])(task.value) if task.setting else nullcontext()
    try:
        with interrupting(limit), setting:
            reply, seconds = _timed(function)
    except LateError:
        return None
    if seconds < SHORT and not task.setting:
        seconds = min([seconds, *(_timed(function)[1] for _ in range(AGAIN))])
    return {**asdict(reply), "seconds": seconds}


def _timed(function: Callable[[], Reply]) -> tuple[Reply, float]:
    """Return (reply, processor time in seconds), with SymPy's cache empty. A failure is a reply with a reason."""
    if "sympy" in sys.modules:
        sys.modules["sympy"].core.cache.clear_cache()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        start = time.thread_time()
        try:
            reply = function()
        except MemoryError:
            raise
        except Exception as error:
            message = " ".join(str(error).split())[:200]
            reply = Reply(None, reason=f"it failed: {type(error).__name__}: {message}")
        return reply, time.thread_time() - start


# Judging


def outcome_of(truth: Any, answer: Any) -> Outcome:
    """Return the outcome of an answer. None is undecided, also the value of a single constraint in a mapping.

    >>> outcome_of(2, 2), outcome_of(2, None), outcome_of(["c"], ["b"])
    ('right', 'undecided', 'wrong')
    >>> outcome_of({"a": True, "b": False}, {"a": True}), outcome_of({"a": True, "b": False}, {"a": False})
    ('undecided', 'wrong')
    """
    if answer is None:
        return "undecided"
    if not isinstance(truth, Mapping) or not isinstance(answer, Mapping):
        return "right" if _same(truth, answer) else "wrong"
    decided = {name: value for name, value in answer.items() if value is not None}
    if any(name not in truth or not _same(truth[name], value) for name, value in decided.items()):
        return "wrong"
    return "right" if len(decided) == len(truth) else "undecided"


def _same(truth: Any, answer: Any) -> bool:
    """Return whether two values are equal, where True is not 1 and the order of a list does not matter."""
    if isinstance(truth, list | tuple) and isinstance(answer, list | tuple):
        return sorted(map(str, truth)) == sorted(map(str, answer))
    return isinstance(truth, bool) == isinstance(answer, bool) and bool(truth == answer)


# Distributing trials

#: Trials under way for each worker.
AHEAD = 2
#: The wall-clock limit of a trial is `PATIENCE` times its limit of processor time, plus `SPARE` seconds.
PATIENCE, SPARE = 4.0, 20.0
SKIPPED = "timed out at a smaller size"


@dataclass(frozen=True)
class Bench:
    """The workers, the limit of processor time in seconds, and the answering function as ``module:function``."""

    pool: Pool
    limit: float
    answering: str

    def submit(self, task: TrialTask) -> Future[Ended]:
        """Start a trial, and return its future."""
        asked = (task, self.limit, self.answering)
        return self.pool.submit(self.pool.run, Job(timed_reply, asked, PATIENCE * self.limit + SPARE))

    def line(self, task: TrialTask, job: Ended) -> TrialLine:
        """Return the line of a trial by how its job ended. Raises StoppedError if no worker could be started."""
        if job.ended == "absent":
            raise StoppedError(job.reason)
        if job.finished and job.value is not None:
            answer, seconds = job.value["value"], float(job.value["seconds"])
            outcome = "cannot" if answer is None and job.value["cannot"] else outcome_of(task.trial.truth, answer)
            return _line(task, answer, outcome, seconds, str(job.value["reason"]))
        if job.finished or job.ended in ("overrun", "memory"):
            reason = job.reason if job.ended == "memory" else f"not done after {self.limit:g} s"
            return _line(task, None, "timed out", self.limit, reason)
        return _line(task, None, "undecided", self.limit, f"it failed: {job.reason}")


def _line(task: TrialTask, answer: object, outcome: Outcome, seconds: float, reason: str) -> TrialLine:
    t = task.trial
    why = "" if outcome == "right" else explained(task.method, t.question, outcome, reason)
    about = (t.family, t.name, t.question, task.method, t.size, t.truth)
    return TrialLine(*about, answer, outcome, seconds, " ".join(why.split()), task.setting, task.value)


def run(tasks: Iterable[TrialTask], bench: Bench) -> Iterator[TrialLine]:
    """Yield a line for every task, in the order in which they end. Raises StoppedError if no worker can be started.

    Tasks that differ in the size of the trial only form a ladder. A ladder is run size by size, the smallest first; if
    a size times out, the larger ones are not run.
    """
    ladders = grouped(sorted(tasks, key=lambda task: task.trial.size), lambda task: task.ladder)
    running: dict[Future[Ended], TrialTask] = {}
    timed_out_at: dict[tuple[str, ...], int] = {}
    while ladders or running:
        for ladder, rungs in [*ladders.items()]:
            sizes_running = {task.trial.size for task in running.values() if task.ladder == ladder}
            while rungs and len(running) < AHEAD * bench.pool.width and sizes_running <= {rungs[0].trial.size}:
                task = rungs.pop(0)
                if ladder in timed_out_at and task.trial.size > timed_out_at[ladder]:
                    yield _line(task, None, "timed out", bench.limit, SKIPPED)
                else:
                    sizes_running = {task.trial.size}
                    running[bench.submit(task)] = task
            if not rungs:
                del ladders[ladder]
            if len(running) >= AHEAD * bench.pool.width:
                break
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            task = running.pop(future)
            line = bench.line(task, future.result())
            if line.outcome == "timed out":
                timed_out_at[task.ladder] = task.trial.size
            yield line


@contextmanager
def bench_of(workers: int | None, limit: float) -> Iterator[Bench]:
    """Yield a bench of workers on this machine (default: one for each core).

    The workers are forks of this process if it can be forked. Raises StoppedError.
    """
    with Pool(workers, MEMORY, MODULES) as pool:
        pool.fork()
        yield Bench(pool, limit, ANSWERING)
