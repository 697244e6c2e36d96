"""The options of the command, and what they ask for: trials by name, each by each method."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

from dofkit.benchmark.record import ChartError
from dofkit.benchmark.statistics import grouped
from dofkit.benchmark.trials.construction import Trial, few
from dofkit.methods.table import METHODS, Question
from dofkit.scene.fields import suggestion

#: Trials of each family and question, at most.
MOST = 32
Families = Mapping[str, Callable[[], Iterator[Trial]]]


#: Seconds of processor time for a trial, and in a quick run.
LIMIT, LIMIT_QUICK = 2.0, 0.5


@dataclass(frozen=True)
class TrialTask:
    """A trial for a method."""

    trial: Trial
    method: str

    @property
    def ladder(self) -> tuple[str, ...]:
        """What is the same in trials of which only the size differs: in a name that has it, n stands for it."""
        t = self.trial
        member, count = re.subn(rf"\b{t.size} by {t.size}\b|\b{t.size}\b", "n", t.name, count=1)
        return (t.family, t.question, member if count else "", self.method)


@dataclass(frozen=True)
class ChartOptions:
    """The options of the command; questions, families and methods by name, where no name stands for all of them.

    ``source``: a folder with the data of a run, to be drawn again; ``limit``: seconds of processor time for a trial.
    """

    out: Path
    questions: Sequence[str] = ()
    families: Sequence[str] = ()
    methods: Sequence[str] = ()
    quick: bool = False
    source: Path | None = None
    workers: int | None = None
    limit: float | None = None

    @property
    def seconds(self) -> float:
        """The limit for a trial, in seconds of processor time."""
        return self.limit or (LIMIT_QUICK if self.quick else LIMIT)

    def tasks(self, families: Families) -> list[TrialTask]:
        """Return the trials that are asked for, family by family, each by each method.

        Raises ChartError where there are none, and with the nearest name for one that is none.
        """
        questions = _names(self.questions, get_args(Question), "question", "questions")
        methods = _names(self.methods, list(METHODS), "method", "methods")
        trials: list[Trial] = []
        for family in _names(self.families, list(families), "family", "families"):
            asked = [trial for trial in families[family]() if trial.question in questions]
            trials += few(asked) if self.quick else _thinned(asked)
        if not trials:
            raise ChartError("no trial of these families asks such a question")
        return [TrialTask(trial, method) for trial in trials for method in methods]

    def command(self) -> str:
        """Return the command that makes the same data again, wherever it is written."""
        names = {"question": self.questions, "families": self.families, "methods": self.methods}
        words = [f"--{option} {','.join(values)}" for option, values in names.items() if values]
        words += ["--quick"] if self.quick else []
        words += [] if self.limit is None else [f"--timeout {self.limit:g}"]
        return " ".join(["dofkit chart", *words])


def _thinned(trials: Sequence[Trial]) -> Iterator[Trial]:
    """Yield at most `MOST` trials of each question, from the smallest to the largest at even distances."""
    for row in grouped(trials, lambda trial: trial.question).values():
        by_size, most = sorted(row, key=lambda trial: trial.size), min(MOST, len(row))
        yield from (by_size[round(i * (len(row) - 1) / max(1, most - 1))] for i in range(most))


def _names(asked: Iterable[str], available: Sequence[str], what: str, plural: str) -> list[str]:
    names = [name.strip() for text in asked for name in text.split(",") if name.strip()]
    for name in names:
        if name not in available:
            raise ChartError(f"there is no {what} '{name}': {suggestion(name, available, plural)}")
    return [name for name in available if name in names] if names else list(available)
