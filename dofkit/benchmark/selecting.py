"""What of all trials and methods is asked for by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import get_args

from dofkit.benchmark.storing import ChartError
from dofkit.benchmark.trials.trial import Trial
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
        """With all names written out. Raises ChartError with the nearest one for a name that is none."""
        return Selection(
            _known(self.questions, get_args(Question), "question"),
            _known(self.families, list(families), "family"),
            _known(self.methods, list(METHODS), "method"),
            self.quick,
            self.most,
        )

    def trials(self, families: Families) -> list[Trial]:
        """All trials of what was chosen, family by family. Raises ChartError where there are none."""
        found = self._all(families, self.quick)
        if not found:
            raise ChartError("no trial of these families asks such a question")
        return found

    def swept(self, families: Families) -> list[Trial]:
        """Those among which sweeps choose: of all, also in a quick run, which takes fewer of them."""
        return self._all(families, False)

    def _all(self, families: Families, quick: bool) -> list[Trial]:
        return [t for name in self.families for t in families[name](quick) if t.question in self.questions]

    def thinned(self, trials: Sequence[Trial]) -> list[Trial]:
        """Not more of each family and question than wanted, from the smallest to the largest."""
        most = self.most if self.most is not None else MOST_QUICK if self.quick else MOST
        rows: dict[tuple[str, str], list[Trial]] = {}
        for trial in trials:
            rows.setdefault((trial.family, trial.question), []).append(trial)
        return [trial for row in rows.values() for trial in evenly(sorted(row, key=lambda t: t.size), most or len(row))]

    def options(self) -> Iterator[str]:
        """The same, as it is written on the command line."""
        for option, names in (("question", self.questions), ("families", self.families), ("methods", self.methods)):
            if names:
                yield f"--{option} {','.join(names)}"
        if self.quick:
            yield "--quick"
        if self.most is not None:
            yield f"--most {self.most}"


def evenly(row: Sequence[Trial], most: int) -> list[Trial]:
    """So many of them, at most, the first and the last and what lies between them at even distances."""
    if len(row) <= most:
        return list(row)
    return [row[round(i * (len(row) - 1) / max(1, most - 1))] for i in range(most)]


def _known(asked: Iterable[str], known: Sequence[str], what: str) -> list[str]:
    names = [name.strip() for one in asked for name in one.split(",") if name.strip()]
    plural = "families" if what == "family" else f"{what}s"
    for name in names:
        if name not in known:
            raise ChartError(f"there is no {what} '{name}': {suggestion(name, known, plural)}")
    return [name for name in known if name in names] if names else list(known)
