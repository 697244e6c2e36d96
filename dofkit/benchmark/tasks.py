"""What is to be run: each trial by each method, and sweeps of what can be turned on a method."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, NamedTuple

from dofkit.benchmark.trials.trial import Trial
from dofkit.methods.table import Knobs

#: Of each question in a group of a sweep so many trials, at most; the fewer where it is to be quick.
MOST_SWEPT, MOST_SWEPT_QUICK = 10, 2
#: Sweeps of balls take what misses a special case by less than this.
NEAR = 0.1
#: Values of the knobs, all of them and a few.
TOLERANCES = tuple(10.0**-k for k in range(1, 17))
BITS = (16, 24, 32, 48, 64, 96, 128, 192, 256, 512)
PRIME_BITS = (3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 31, 61)
#: Trials of a size up to this are asked with other primes.
SMALL = 8
#: The questions that a scene's tolerance bears on.
BY_GEOMETRY = ("dof", "redundancy")


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
        return (t.family, t.question, repr(t.traits), swept, self.method, self.knob, repr(self.value), self.group)


def trial_tasks(trials: Iterable[Trial], methods: Sequence[str]) -> Iterator[TrialTask]:
    """Every trial by every method."""
    for trial in trials:
        for method in methods:
            yield TrialTask(trial, method)


def sweeps(trials: Sequence[Trial], methods: Sequence[str], quick: bool) -> Iterator[TrialTask]:
    """The tolerance of numbers, the tolerance of scenes, the precision of balls and the size of a field's primes."""
    few = Few(MOST_SWEPT_QUICK, 3, 1) if quick else Few(MOST_SWEPT, 1, 3)
    for method, swept in (("numeric", _rounding), ("auto", _tolerant), ("balls", _precision), ("field", _primes)):
        if method in methods:
            yield from swept(trials, few)


class Few(NamedTuple):
    """So many trials of a group at most, every so-many-th value of a knob, and so many seeds."""

    most: int
    stride: int
    seeds: int


def _rounding(trials: Sequence[Trial], few: Few) -> Iterator[TrialTask]:
    for trial, group in _groups(trials, _digits, few.most):
        scene = {key: part for key, part in trial.scene.items() if key != "tolerance"}
        for value in TOLERANCES[:: few.stride]:
            task = replace(trial, scene=scene)
            yield TrialTask(task, "numeric", Knobs(tolerance=value), "tolerance", value, group)


def _tolerant(trials: Sequence[Trial], few: Few) -> Iterator[TrialTask]:
    for trial, group in _groups([t for t in trials if t.question in BY_GEOMETRY], _digits, few.most):
        for value in TOLERANCES[:: few.stride]:
            scene: dict[str, Any] = {**trial.scene, "tolerance": value}
            yield TrialTask(replace(trial, scene=scene), "auto", Knobs(), "scene tolerance", value, group)


def _precision(trials: Sequence[Trial], few: Few) -> Iterator[TrialTask]:
    for trial, group in _groups(trials, _gap, few.most):
        for bits in BITS[:: few.stride]:
            yield TrialTask(trial, "balls", Knobs(bits=bits), "bits", bits, group)


def _digits(trial: Trial) -> str | None:
    """To how many digits its numbers are rounded, where the truth is that of what was rounded."""
    return str(trial.swept["digits"]) if "digits" in trial.swept and "tolerance" in trial.swept else None


def _gap(trial: Trial) -> str | None:
    """By how much it misses a special case, where that is little."""
    gap = abs(float(Fraction(str(trial.swept.get("gap", 0)))))
    return f"{gap:g}" if 0 < gap < NEAR else None


def _primes(trials: Sequence[Trial], few: Few) -> Iterator[TrialTask]:
    small = (t for t in trials if t.size <= SMALL and t.question != "equivalence")
    for trial in _spread(small, few.most):
        for seed in range(few.seeds):
            for bits in PRIME_BITS[:: few.stride]:
                yield TrialTask(trial, "field", Knobs(prime_bits=bits, seed=seed), "prime bits", bits, trial.question)


def _groups(trials: Iterable[Trial], key: Callable[[Trial], str | None], most: int) -> Iterator[tuple[Trial, str]]:
    """Small trials of each group, with its name."""
    groups: dict[str, list[Trial]] = {}
    for trial in trials:
        group = key(trial) if trial.size <= SMALL else None
        if group is not None:
            groups.setdefault(group, []).append(trial)
    for group, members in groups.items():
        for trial in _spread(members, most):
            yield trial, group


def _spread(trials: Iterable[Trial], most: int) -> Iterator[Trial]:
    """So many trials of each question, taking the families in turn."""
    rows: dict[tuple[str, str], list[Trial]] = {}
    for trial in trials:
        rows.setdefault((trial.question, trial.family), []).append(trial)
    for question in dict.fromkeys(question for question, _ in rows):
        families = [iter(row) for (q, _), row in rows.items() if q == question]
        left = most
        while families and left:
            for family in families[:]:
                chosen = next(family, None)
                if chosen is None:
                    families.remove(family)
                elif left:
                    left -= 1
                    yield chosen
