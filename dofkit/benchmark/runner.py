"""Every trial by every method, each in a killable worker: those that hang or crash cost their own line, no other."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Protocol

from dofkit.base.workers import MEMORY, Job
from dofkit.base.workers import JobOutcome as Ended
from dofkit.base.workers.pool import Cluster, Crew, Pool, StoppedError
from dofkit.benchmark.judging import outcome_of
from dofkit.benchmark.record import Outcome, TrialLine
from dofkit.benchmark.tasks import TrialTask
from dofkit.benchmark.trial_job import AGAIN, MODULES, TrialQuestion, timed_reply

#: Trials under way for each worker.
AHEAD = 2
#: By the clock a trial may take so many times its processor time, and this much more: the machine has others to serve.
PATIENCE, SPARE = 4.0, 20.0
SKIPPED = "timed out at a smaller size"


class Explain(Protocol):
    """Why a method is not right on a trial, in a sentence."""

    def __call__(self, method: str, question: str, traits: tuple[str, ...], outcome: str, reason: str) -> str: ...


@dataclass(frozen=True)
class Bench:
    """Who answers, and how: ``crew`` calls ``ask`` with a job and gets how it ended."""

    crew: Crew
    ask: Callable[[Job], Ended]
    limit: float
    explain: Explain
    answering: str = "dofkit.methods.ask:answered"

    def submit(self, task: TrialTask) -> Future[Ended]:
        """Begin with a trial."""
        t = task.trial
        again = 0 if task.knob else AGAIN
        asked = TrialQuestion(t.scene, t.question, task.method, task.knobs, t.answer, self.limit, again, self.answering)
        return self.crew.submit(self.ask, Job(timed_reply, asked, PATIENCE * self.limit + SPARE))

    def line(self, task: TrialTask, ended: Ended) -> TrialLine:
        """What became of a trial."""
        if ended.ended == "absent":
            raise StoppedError(ended.reason)
        if ended.finished and ended.value is not None:
            told, seconds = ended.value["value"], float(ended.value["seconds"])
            outcome = outcome_of(task.trial.truth, told)
            if told is None and ended.value["cannot"]:
                outcome = "cannot"
            return self._line(task, told, outcome, seconds, str(ended.value["reason"]))
        if ended.finished or ended.ended in ("overrun", "memory"):
            reason = ended.reason if ended.ended == "memory" else f"not done after {self.limit:g} s"
            return self._line(task, None, "timed out", self.limit, reason)
        return self._line(task, None, "undecided", self.limit, f"it failed: {ended.reason}")

    def skipped(self, task: TrialTask) -> TrialLine:
        """A trial that is not run: a smaller one took too long."""
        return self._line(task, None, "timed out", self.limit, SKIPPED)

    def _line(self, task: TrialTask, told: object, outcome: Outcome, seconds: float, reason: str) -> TrialLine:
        t = task.trial
        why = "" if outcome == "right" else self.explain(task.method, t.question, t.traits, outcome, reason)
        if reason == SKIPPED:
            why = f"{SKIPPED}: {why}"
        about = (t.family, t.name, t.question, task.method, t.size, tuple(t.traits), dict(t.swept), t.truth)
        return TrialLine(
            *about, told, outcome, seconds, " ".join(why.split()), task.knob, float(task.value), task.group
        )


@dataclass
class _Ladder:
    """Trials that differ in size, the smallest first; ``climbing`` of them are under way, all of one size."""

    tasks: deque[TrialTask]
    climbing: int = 0
    at: int = 0
    broken: bool = False

    def ready(self) -> bool:
        """May the next one begin? Only beside others of its size: what takes too long ends the ladder."""
        return bool(self.tasks) and (self.broken or not self.climbing or self.tasks[0].trial.size == self.at)


@dataclass
class _Ladders:
    """All ladders; those with trials left take turns."""

    left: deque[_Ladder] = field(default_factory=deque)

    @classmethod
    def of(cls, tasks: Iterable[TrialTask]) -> _Ladders:
        """Sorted into ladders."""
        found: dict[tuple[str, ...], list[TrialTask]] = {}
        for task in tasks:
            found.setdefault(task.ladder, []).append(task)
        return cls(deque(_Ladder(deque(sorted(row, key=lambda task: task.trial.size))) for row in found.values()))

    def next(self) -> tuple[_Ladder, TrialTask] | None:
        """A trial that may begin now."""
        for _ in range(len(self.left)):
            ladder = self.left.popleft()
            if ladder.ready():
                task = ladder.tasks.popleft()
                if ladder.tasks:
                    self.left.append(ladder)
                return ladder, task
            self.left.append(ladder)
        return None


def run(tasks: Iterable[TrialTask], bench: Bench) -> Iterator[TrialLine]:
    """A line for every task, as they end. Raises StoppedError where no worker can be had."""
    ladders = _Ladders.of(tasks)
    running: dict[Future[Ended], tuple[_Ladder, TrialTask]] = {}
    while True:
        while len(running) < AHEAD * bench.crew.width and (found := ladders.next()):
            ladder, task = found
            if ladder.broken and task.trial.size > ladder.at:
                yield bench.skipped(task)
                continue
            ladder.climbing, ladder.at = ladder.climbing + 1, task.trial.size
            running[bench.submit(task)] = found
        if not running:
            return
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            ladder, task = running.pop(future)
            line = bench.line(task, future.result())
            ladder.climbing -= 1
            ladder.broken = ladder.broken or line.outcome == "timed out"
            yield line


@contextmanager
def local_bench(workers: int, limit: float, explain: Explain, memory: int = MEMORY) -> Iterator[Bench]:
    """Workers on this machine, copies of this process where it may be forked."""
    with Pool(workers, memory, MODULES) as pool:
        pool.fork()
        yield Bench(pool, pool.run, limit, explain)


@contextmanager
def cluster_bench(address: str, limit: float, explain: Explain) -> Iterator[Bench]:
    """The machines of a Dask scheduler, each with workers of its own. Raises StoppedError."""
    with Cluster(address) as cluster:
        yield Bench(cluster, run_there, limit, explain)


def run_there(job: Job) -> Ended:
    """A job, on a machine of the cluster."""
    return _pool().run(job)


@lru_cache(maxsize=1)
def _pool() -> Pool:
    return Pool(modules=MODULES)
