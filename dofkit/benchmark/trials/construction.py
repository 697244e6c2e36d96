"""What families are made of: constructions, scenes whose answers are known, and the trials that ask for these."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from dofkit.benchmark.trials.trial import Trial, Truth
from dofkit.methods.names import Question


@dataclass(frozen=True)
class KnownTruth:
    """A scene and what is true of it.

    ``truth`` by report key; ``labels`` by constraint and key. Those of one ``group`` belong together.
    """

    group: str
    name: str
    scene: Mapping[str, Any]
    truth: Mapping[str, Any]
    labels: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @property
    def dof(self) -> int | None:
        """The degree of freedom, -1 where the constraints contradict each other; None where it is not known."""
        return -1 if self.truth.get("consistent") is False else self.truth.get("dof")

    @property
    def integrability(self) -> dict[str, bool] | None:
        """Whether every constraint is holonomic, where that is known of all."""
        if len(self.labels) < len(self.scene["constraints"]):
            return None
        found = {name: label.get("holonomic") for name, label in self.labels.items()}
        return None if None in found.values() else {name: bool(value) for name, value in found.items()}


@dataclass(frozen=True)
class Construction:
    """A scene with its answers, by construction; those that are None are not asked for.

    ``dof`` -1: the constraints contradict each other, and what is redundant then is not asked; ``integrability``: is
    each constraint holonomic in the system? ``redundancy``: what can be dropped; ``equivalence``: a constraint, a
    text, and whether they say the same. For ``because``, ``traits``, ``size`` and ``swept`` see `Trial`.
    """

    name: str
    scene: Mapping[str, Any]
    because: str
    traits: Sequence[str]
    size: int = 1
    swept: Mapping[str, Any] | None = None
    dof: int | None = None
    integrability: Mapping[str, bool] | None = None
    redundancy: Sequence[str] | None = None
    equivalence: tuple[str, str, bool] | None = None

    @classmethod
    def of(cls, known: KnownTruth, because: str, traits: Sequence[str]) -> Construction:
        """All that is known of a scene."""
        about = known.name, known.scene, because, traits
        redundant = known.truth.get("redundant")
        return cls(*about, dof=known.dof, integrability=known.integrability, redundancy=redundant)

    def trials(self, family: str) -> Iterator[Trial]:
        """A trial for every question whose answer is given."""
        truths: dict[Question, Truth | None] = {
            "dof": self.dof,
            "integrability": None if self.integrability is None else dict(self.integrability),
            "redundancy": None if self.redundancy is None or self.dof == -1 else sorted(self.redundancy),
        }
        for question, truth in truths.items():
            if truth is not None:
                yield self._trial(family, f"{self.name}: {question}", question, truth)
        if self.equivalence is not None:
            constraint, text, same = self.equivalence
            yield self._trial(family, self.name, "equivalence", same, {"constraint": constraint, "text": text})

    def _trial(
        self, family: str, name: str, question: Question, truth: Truth, answer: Mapping[str, str] | None = None
    ) -> Trial:
        about = (self.because, tuple(self.traits), self.size, self._variation())
        return Trial(family, name, question, self.scene, truth, *about, answer)

    def _variation(self) -> dict[str, Any]:
        """What is varied; where only the size is, the member of the family that grows: its name with n for the size."""
        member, sizes = re.subn(rf"\b{self.size} by {self.size}\b|\b{self.size}\b", "n", self.name, count=1)
        return dict(self.swept) if self.swept else {"member": member} if sizes else {}


def scene(coordinates: Sequence[str], *constraints: Any, **more: Any) -> dict[str, Any]:
    """A scene in coordinates alone."""
    return {"coordinates": list(coordinates), "constraints": list(constraints), **more}


#: A line of a table: name, coordinates, rows, dof (-1: the rows contradict each other), which rows are holonomic, which
#: are redundant, because, the trait. What is None is not asked.
Line = tuple[str, str, Sequence[str], int, Sequence[bool] | None, Sequence[str] | None, str, str]


def tabled(line: Line) -> Construction:
    """A scene in coordinates alone, its size the number of its rows."""
    name, coordinates, rows, dof, holonomic, redundant, because, trait = line
    labels = None if holonomic is None else dict(zip(numbered(len(rows)), holonomic, strict=True))
    about = name, scene(coordinates.split(), *rows), because, (trait,), len(rows)
    return Construction(*about, dof=dof, integrability=labels, redundancy=redundant)


def every(names: Sequence[str], value: bool) -> dict[str, bool]:
    """The same of every constraint."""
    return dict.fromkeys(names, value)


def numbered(number: int, first: int = 1) -> list[str]:
    """The names of constraints without one: c1, c2, ..."""
    return [f"c{i}" for i in range(first, first + number)]


#: How many trials of a question stand for a family.
FEW = 2


def few(trials: Iterable[Trial]) -> Iterator[Trial]:
    """Trials that stand for a family: of the first question a small one, the next with another truth; then one each."""
    chosen: dict[str, list[Trial]] = {}
    for trial in sorted(trials, key=lambda trial: trial.size):
        known = chosen.setdefault(trial.question, [])
        most = FEW if next(iter(chosen)) == trial.question else 1
        if len(known) < most and kind(trial) not in map(kind, known):
            known.append(trial)
    return (trial for known in chosen.values() for trial in known)


def kind(trial: Trial) -> Any:
    """What must not be the same of all trials of a family and question, lest a method be right by always saying it."""
    truth = trial.truth
    if isinstance(truth, dict):
        return tuple(sorted(set(truth.values())))
    return bool(truth) if isinstance(truth, list) else truth
