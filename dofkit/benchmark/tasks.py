"""What is to be run: the trials that are asked for by name, each by each method."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import get_args

from dofkit.benchmark.record import ChartError
from dofkit.benchmark.statistics import grouped
from dofkit.benchmark.trials.construction import Trial, few
from dofkit.methods.table import METHODS, Question
from dofkit.scene.fields import suggestion

#: Trials of each family and question, at most.
MOST = 32
Families = Mapping[str, Callable[[], Iterator[Trial]]]


@dataclass(frozen=True)
class Selection:
    """Questions, families and methods by name; an empty one stands for all of them."""

    questions: Sequence[str] = ()
    families: Sequence[str] = ()
    methods: Sequence[str] = ()
    quick: bool = False

    def with_names(self, families: Families) -> Selection:
        """Return it with all names written out. Raises ChartError with the nearest one for a name that is none."""
        return replace(
            self,
            questions=_names(self.questions, get_args(Question), "question", "questions"),
            families=_names(self.families, list(families), "family", "families"),
            methods=_names(self.methods, list(METHODS), "method", "methods"),
        )

    def trials(self, families: Families) -> list[Trial]:
        """Return the trials of what was chosen, family by family. Raises ChartError where there are none."""
        chosen: list[Trial] = []
        for name in self.families:
            trials = [trial for trial in families[name]() if trial.question in self.questions]
            chosen += few(trials) if self.quick else _thinned(trials)
        if not chosen:
            raise ChartError("no trial of these families asks such a question")
        return chosen

    def options(self) -> Iterator[str]:
        """Yield the same, as it is written on the command line."""
        for option, names in (("question", self.questions), ("families", self.families), ("methods", self.methods)):
            if names:
                yield f"--{option} {','.join(names)}"
        if self.quick:
            yield "--quick"


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


@dataclass(frozen=True)
class TrialTask:
    """A trial for a method."""

    trial: Trial
    method: str

    @property
    def ladder(self) -> tuple[str, ...]:
        """What is the same in trials of which only the size differs."""
        t = self.trial
        swept = repr(sorted(t.swept.items(), key=str))
        return (t.family, t.question, swept, self.method)


def trial_tasks(trials: Iterable[Trial], methods: Sequence[str]) -> Iterator[TrialTask]:
    """Yield every trial by every method."""
    return (TrialTask(trial, method) for trial in trials for method in methods)
