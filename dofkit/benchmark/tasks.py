"""What is to be run: the trials that are asked for by name, each by each method, and sweeps of methods' parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import chain, islice, zip_longest
from typing import Any, NamedTuple, get_args

from dofkit.benchmark.record import ChartError
from dofkit.benchmark.statistics import grouped
from dofkit.benchmark.trials.construction import Trial
from dofkit.methods.table import METHODS, Knobs, Question
from dofkit.scene.fields import suggestion

#: Trials of each family and question, at most, where nothing is said; and in a quick run.
MOST, MOST_QUICK = 32, 2
#: Of each question in a group of a sweep so many trials, at most; the fewer where it is to be quick.
MOST_SWEPT, MOST_SWEPT_QUICK = 10, 2
#: Sweeps of balls take what misses a special case by less than this.
NEAR = 0.1
#: Values of the knobs, all of them and a few.
TOLERANCES = tuple(10.0**-k for k in range(1, 17))
BITS = (16, 24, 32, 48, 64, 96, 128, 192, 256, 512)
#: Trials of a size up to this are swept.
SMALL = 8
#: The questions that a scene's tolerance bears on.
BY_GEOMETRY = ("dof", "redundancy")
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
    """A trial for a method; in a sweep with the name of the knob, its value, and the curve that it belongs to."""

    trial: Trial
    method: str
    knobs: Knobs = field(default_factory=Knobs)
    knob: str = ""
    value: float = 0.0
    group: str = ""

    @property
    def ladder(self) -> tuple[str, ...]:
        """What is the same in trials of which only the size differs."""
        t = self.trial
        swept = repr(sorted(t.swept.items(), key=str))
        return (t.family, t.question, swept, self.method, self.knob, repr(self.value), self.group)


def trial_tasks(trials: Iterable[Trial], methods: Sequence[str]) -> Iterator[TrialTask]:
    """Yield every trial by every method."""
    return (TrialTask(trial, method) for trial in trials for method in methods)


class SweepSize(NamedTuple):
    """So many trials of a group at most, and every so-many-th value of a knob."""

    most: int
    stride: int


def sweeps(trials: Sequence[Trial], methods: Sequence[str], quick: bool) -> Iterator[TrialTask]:
    """Yield tasks over tolerances of numbers and of scenes, and over the precision of balls."""
    size = SweepSize(MOST_SWEPT_QUICK, 3) if quick else SweepSize(MOST_SWEPT, 1)
    for method, swept in (("numeric", _rounding), ("auto", _tolerant), ("balls", _precision)):
        if method in methods:
            yield from swept(trials, size)


def _rounding(trials: Sequence[Trial], size: SweepSize) -> Iterator[TrialTask]:
    for trial, group in _groups(trials, _digits, size.most):
        scene = {key: part for key, part in trial.scene.items() if key != "tolerance"}
        for value in TOLERANCES[:: size.stride]:
            task = replace(trial, scene=scene)
            yield TrialTask(task, "numeric", Knobs(tolerance=value), "tolerance", value, group)


def _tolerant(trials: Sequence[Trial], size: SweepSize) -> Iterator[TrialTask]:
    for trial, group in _groups([t for t in trials if t.question in BY_GEOMETRY], _digits, size.most):
        for value in TOLERANCES[:: size.stride]:
            scene: dict[str, Any] = {**trial.scene, "tolerance": value}
            yield TrialTask(replace(trial, scene=scene), "auto", Knobs(), "scene tolerance", value, group)


def _precision(trials: Sequence[Trial], size: SweepSize) -> Iterator[TrialTask]:
    for trial, group in _groups(trials, _gap, size.most):
        for bits in BITS[:: size.stride]:
            yield TrialTask(trial, "balls", Knobs(bits=bits), "bits", bits, group)


def _digits(trial: Trial) -> str | None:
    """Return to how many digits its numbers are rounded, where the truth is that of what was rounded."""
    return str(trial.swept["digits"]) if "digits" in trial.swept and "tolerance" in trial.swept else None


def _gap(trial: Trial) -> str | None:
    """Return by how much it misses a special case, where that is little."""
    gap = abs(float(Fraction(str(trial.swept.get("gap", 0)))))
    return f"{gap:g}" if 0 < gap < NEAR else None


def _groups(trials: Iterable[Trial], key: Callable[[Trial], str | None], most: int) -> Iterator[tuple[Trial, str]]:
    """Yield at most ``most`` small trials of each question for each group, a value of ``key``, with its name."""
    for group, members in grouped((t for t in trials if t.size <= SMALL), key).items():
        if group is not None:
            yield from ((trial, group) for trial in _spread(members, most))


def _spread(trials: Iterable[Trial], most: int) -> Iterator[Trial]:
    """Yield so many trials of each question, taking the families in turn."""
    for same in grouped(trials, lambda trial: trial.question).values():
        rounds = zip_longest(*grouped(same, lambda trial: trial.family).values())
        yield from islice((trial for trial in chain.from_iterable(rounds) if trial is not None), most)
