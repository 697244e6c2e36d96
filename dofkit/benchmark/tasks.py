"""What is to be run: the trials that are asked for by name, each by each method."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

from dofkit.benchmark.record import ChartError
from dofkit.benchmark.statistics import grouped
from dofkit.benchmark.trials.construction import Trial
from dofkit.methods.table import METHODS, Question
from dofkit.scene.fields import suggestion

#: Trials of each family and question, at most, where nothing is said; and in a quick run.
MOST, MOST_QUICK = 32, 2
Families = Mapping[str, Callable[[bool], Iterator[Trial]]]


@dataclass(frozen=True)
class Selection:
    """Questions, families and methods by name; an empty one stands for all of them.

    ``most``: so many trials of each family and question, at most; 0: all.
    """

    questions: Sequence[str] = ()
    families: Sequence[str] = ()
    methods: Sequence[str] = ()
    quick: bool = False
    most: int | None = None

    def with_names(self, families: Families) -> Selection:
        """Return it with all names written out. Raises ChartError with the nearest one for a name that is none."""
        return replace(
            self,
            questions=_names(self.questions, get_args(Question), "question", "questions"),
            families=_names(self.families, list(families), "family", "families"),
            methods=_names(self.methods, list(METHODS), "method", "methods"),
        )

    def trials(self, families: Families, quick: bool) -> list[Trial]:
        """Return all trials of what was chosen, family by family. Raises ChartError where there are none."""
        chosen = [t for name in self.families for t in families[name](quick) if t.question in self.questions]
        if not chosen:
            raise ChartError("no trial of these families asks such a question")
        return chosen

    def thinned(self, trials: Sequence[Trial]) -> list[Trial]:
        """Return not more of each family and question than wanted, from the smallest to the largest."""
        most = self.most if self.most is not None else MOST_QUICK if self.quick else MOST
        rows = grouped(trials, lambda trial: (trial.family, trial.question)).values()
        return [trial for row in rows for trial in evenly(sorted(row, key=lambda t: t.size), most or len(row))]

    def options(self) -> Iterator[str]:
        """Yield the same, as it is written on the command line."""
        for option, names in (("question", self.questions), ("families", self.families), ("methods", self.methods)):
            if names:
                yield f"--{option} {','.join(names)}"
        if self.quick:
            yield "--quick"
        if self.most is not None:
            yield f"--most {self.most}"


def evenly(row: Sequence[Any], most: int) -> list[Any]:
    """Return at most so many members: the first, the last and what lies between them at even distances."""
    if len(row) <= most:
        return list(row)
    return [row[round(i * (len(row) - 1) / max(1, most - 1))] for i in range(most)]


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
