"""The options of the command, and the tasks that they select: trials by each method, and sweeps of settings."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple, TypeVar, get_args

from dofkit.benchmark.record import ChartError
from dofkit.benchmark.statistics import grouped
from dofkit.benchmark.trials.construction import Trial, few
from dofkit.methods.table import METHODS, Question
from dofkit.scene.fields import suggestion

#: The most trials of a family and question.
MOST = 32
T = TypeVar("T")
Families = Mapping[str, Callable[[], Iterator[Trial]]]


class Sweep(NamedTuple):
    """A setting of a method and its values, for trials of families near a special case.

    ``near``: a pattern that finds the distance from the special case, in decimal digits, in the name of a trial.
    """

    method: str
    setting: str
    values: tuple[float, ...]
    families: tuple[str, ...]
    near: str

    def by_digits(self, members: Iterable[T], name: Callable[[T], str]) -> dict[int, list[T]]:
        """Return {digits: members whose name matches `near`}; ``name`` gives the name of the trial of a member."""
        matches = [(re.search(self.near, name(member)), member) for member in members]
        near = grouped([(int(match[1]), member) for match, member in matches if match], lambda pair: pair[0])
        return {digits: [member for _, member in near[digits]] for digits in sorted(near)}


TOLERANCES, BITS = tuple(10.0**-k for k in range(16, 0, -1)), (16, 23, 32, 45, 64, 91, 128, 181, 256, 362, 512)
SWEEPS = (
    Sweep("numeric", "tolerance", TOLERANCES, ("rounded, with tolerance",), r"(\d+) digits"),
    Sweep("balls", "bits", BITS, ("linear rows", "touching surfaces", "tiny steps"), r"by 1e-([1-9]\d*)"),
)
#: A quick run takes only every third value of a setting.
STRIDE_QUICK = 3


#: Seconds of processor time for a trial, and in a quick run.
LIMIT, LIMIT_QUICK = 2.0, 0.5


@dataclass(frozen=True)
class TrialTask:
    """A trial to be answered by a method; in a sweep with a value of a setting."""

    trial: Trial
    method: str
    setting: str = ""
    value: float | None = None

    @property
    def ladder(self) -> tuple[str, ...]:
        """A key that is equal for tasks that differ only in size, which n replaces in the trial's name."""
        t = self.trial
        member, count = re.subn(rf"\b{t.size} by {t.size}\b|\b{t.size}\b", "n", t.name, count=1)
        return (t.family, t.question, member if count else "", self.method, repr(self.value))


@dataclass(frozen=True)
class ChartOptions:
    """The options of the command; ``questions``, ``families`` and ``methods`` are names, none for all of them.

    ``source``: a folder with the data of a run, to draw its figures; ``limit``: seconds of processor time for a trial.
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
        """Return the selected trials, family by family, each with each selected method.

        Raises ChartError if there are none, or for an unknown name, with the nearest known name.
        """
        methods = _names(self.methods, METHODS, "method", "methods")
        trials = [trial for asked in self._asked(families).values() for trial in self._some(asked)]
        if not trials:
            raise ChartError("no trial of these families asks such a question")
        return [TrialTask(trial, method) for trial in trials for method in methods]

    def sweeps(self, families: Families) -> list[TrialTask]:
        """Return the selected trials near special cases, with each value of a setting."""
        methods = _names(self.methods, METHODS, "method", "methods")
        asked = self._asked(families)
        swept: list[TrialTask] = []
        for sweep in (sweep for sweep in SWEEPS if sweep.method in methods):
            values = sweep.values[:: STRIDE_QUICK if self.quick else 1]
            trials = [trial for family in sweep.families for trial in asked.get(family, ())]
            for same in sweep.by_digits(trials, lambda trial: trial.name).values():
                tasks = (TrialTask(trial, sweep.method, sweep.setting) for trial in self._some(same))
                swept += [replace(task, value=value) for task in tasks for value in values]
        return swept

    def _asked(self, families: Families) -> dict[str, list[Trial]]:
        """Return {family: trials of the selected questions} for the selected families. Raises ChartError."""
        questions = _names(self.questions, get_args(Question), "question", "questions")
        names = _names(self.families, list(families), "family", "families")
        return {name: [trial for trial in families[name]() if trial.question in questions] for name in names}

    def _some(self, trials: Sequence[Trial]) -> Iterator[Trial]:
        """Yield at most `MOST` of the trials for each question, or a few in a quick run."""
        return few(trials) if self.quick else _thinned(trials)

    def command(self) -> str:
        """Return the command that reproduces the data, without the output folder."""
        names = {"question": self.questions, "families": self.families, "methods": self.methods}
        words = [f"--{option} {','.join(values)}" for option, values in names.items() if values]
        words += ["--quick"] if self.quick else []
        words += [] if self.limit is None else [f"--timeout {self.limit:g}"]
        return " ".join(["dofkit chart", *words])


def _thinned(trials: Sequence[Trial]) -> Iterator[Trial]:
    """Yield at most `MOST` trials of each question, evenly spaced from the smallest to the largest."""
    for row in grouped(trials, lambda trial: trial.question).values():
        by_size, most = sorted(row, key=lambda trial: trial.size), min(MOST, len(row))
        yield from (by_size[round(i * (len(row) - 1) / max(1, most - 1))] for i in range(most))


def _names(asked: Iterable[str], available: Sequence[str], what: str, plural: str) -> list[str]:
    names = [name.strip() for text in asked for name in text.split(",") if name.strip()]
    for name in names:
        if name not in available:
            raise ChartError(f"there is no {what} '{name}': {suggestion(name, available, plural)}")
    return [name for name in available if name in names] if names else list(available)
