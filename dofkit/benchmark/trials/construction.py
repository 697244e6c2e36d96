"""What families are made of: scenes whose answers are known by construction, and the trials that ask for these."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypedDict, Unpack

from dofkit.benchmark.trials.trial import Trial, Truth
from dofkit.methods.table import Question


@dataclass(frozen=True)
class KnownScene:
    """A scene with what is true of it by the way it is made. Nothing of dofkit is asked for it.

    ``truth``: values of fields of the report, and of its entries as ``CONSTRAINT.field``; of some fields only.
    ``elsewhere``: further values of a field, those on smaller components of the configuration space, which are true
    where the report says that it speaks of one component only. ``chart``: the coordinates in order as functions of
    p0, p1, ..., of t and of coordinates before them, onto an open part of the configuration space that the truth
    speaks of: as many parameters as ``dof``. By it the truth can be confirmed.
    ``group``: scenes that belong together; ``equivalence``: a constraint, a text, and whether they say the same. For
    ``because``, ``traits``, ``size`` and ``swept`` see `Trial`.
    """

    scene: Mapping[str, Any]
    truth: Mapping[str, Any]
    elsewhere: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    chart: Mapping[str, str] | None = None
    name: str = ""
    group: str = ""
    because: str = ""
    traits: Sequence[str] = ()
    size: int = 1
    swept: Mapping[str, Any] = field(default_factory=dict)
    equivalence: tuple[str, str, bool] | None = None

    @property
    def dof(self) -> int | None:
        """The degree of freedom, -1 where the constraints contradict each other; None where it is not known."""
        return -1 if self.truth.get("consistent") is False else self.truth.get("dof")

    @property
    def integrability(self) -> dict[str, bool] | None:
        """Whether every constraint is holonomic, where that is known of all."""
        constraints = self.scene.get("constraints", ())
        names = [c.get("name") if isinstance(c, Mapping) else None for c in constraints]
        labels = {name: self.truth.get(f"{name}.holonomic") for name in (n or f"c{i + 1}" for i, n in enumerate(names))}
        return None if None in labels.values() else {name: bool(value) for name, value in labels.items()}

    def trials(self, family: str) -> Iterator[Trial]:
        """A trial for every question whose answer is known."""
        redundant = self.truth.get("redundant")
        truths: dict[Question, Truth | None] = {
            "dof": self.dof,
            "integrability": self.integrability,
            "redundancy": None if redundant is None or self.dof == -1 else sorted(redundant),
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


class Answers(TypedDict, total=False):
    """Answers to the questions of a trial; those that are None, or left out, are not known.

    ``dof`` -1: the constraints contradict each other; ``integrability``: whether each constraint is holonomic in the
    system; ``redundancy``: what can be dropped; ``equivalence`` and ``swept``: see `KnownScene`.
    """

    dof: int | None
    integrability: Mapping[str, bool] | None
    redundancy: Sequence[str] | None
    equivalence: tuple[str, str, bool]
    swept: Mapping[str, Any]


def known_scene(
    name: str,
    scene: Mapping[str, Any],
    because: str,
    traits: Sequence[str],
    size: int = 1,
    **answers: Unpack[Answers],
) -> KnownScene:
    """Return a scene with the answers to the questions of a trial."""
    dof, redundant = answers.get("dof"), answers.get("redundancy")
    truth: dict[str, Any] = dict(IMPOSSIBLE) if dof == -1 else {} if dof is None else {"consistent": True, "dof": dof}
    truth |= {f"{constraint}.holonomic": value for constraint, value in (answers.get("integrability") or {}).items()}
    truth |= {} if redundant is None else {"redundant": list(redundant)}
    swept, equivalence = answers.get("swept", {}), answers.get("equivalence")
    return KnownScene(scene, truth, {}, None, name, "", because, traits, size, swept, equivalence)


#: Of constraints that contradict each other.
IMPOSSIBLE: Mapping[str, Any] = {"consistent": False, "dof": None, "velocity_dof": None}


def truths(dof: int, velocity_dof: int | None = None, **more: Any) -> dict[str, Any]:
    """Of a consistent system: its freedoms, as many velocities as ``dof`` unless they are given, and more."""
    return {"consistent": True, "dof": dof, "velocity_dof": dof if velocity_dof is None else velocity_dof, **more}


def scene_of(coordinates: str | Sequence[str], *constraints: Any, **more: Any) -> dict[str, Any]:
    """A scene in coordinates, with spaces between them or as a list; what is given as None is left out."""
    names = coordinates.split() if isinstance(coordinates, str) else [*coordinates]
    given = {key: value for key, value in more.items() if value is not None}
    return {"coordinates": names, "constraints": [*constraints], **given}


#: A line of a table: name, coordinates, rows, dof (-1: the rows contradict each other), which rows are holonomic, which
#: are redundant, because, the trait. What is None is not asked.
Line = tuple[str, str, Sequence[str], int, Sequence[bool] | None, Sequence[str] | None, str, str]


def tabled(line: Line) -> KnownScene:
    """A scene in coordinates alone, its size the number of its rows."""
    name, coordinates, rows, dof, holonomic, redundant, because, trait = line
    labels = None if holonomic is None else dict(zip(numbered(len(rows)), holonomic, strict=True))
    about = name, scene_of(coordinates, *rows), because, (trait,), len(rows)
    return known_scene(*about, dof=dof, integrability=labels, redundancy=redundant)


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
