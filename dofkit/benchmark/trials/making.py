"""What families are made with: scenes, and trials from what is known of one."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from dofkit.benchmark.trials.trial import Trial, Truth
from dofkit.methods.names import Question

#: What is asked where nothing is said: all that is known.
ALL: tuple[Question, ...] = ("dof", "integrability", "redundancy")


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


def scene(coordinates: Sequence[str], *constraints: Any, **more: Any) -> dict[str, Any]:
    """A scene in coordinates alone."""
    return {"coordinates": list(coordinates), "constraints": list(constraints), **more}


def ask(
    family: str,
    name: str,
    scene: Mapping[str, Any],
    because: str,
    traits: Sequence[str],
    *,
    size: int = 1,
    swept: Mapping[str, Any] | None = None,
    dof: int | None = None,
    integrability: Mapping[str, bool] | None = None,
    redundancy: Sequence[str] | None = None,
) -> Iterator[Trial]:
    """A trial for every question whose answer is given; ``dof`` -1: the constraints contradict each other.

    Where only the size varies, ``swept`` says of which member of the family it is the size.
    """
    truths: dict[Question, Truth | None] = {
        "dof": dof,
        "integrability": None if integrability is None else dict(integrability),
        "redundancy": None if redundancy is None else sorted(redundancy),
    }
    varied = _varied(name, size, swept)
    for question, truth in truths.items():
        if truth is not None:
            told = f"{name}: {question}"
            yield Trial(family, told, question, scene, truth, because, tuple(traits), size, varied)


def same(
    family: str,
    name: str,
    scene: Mapping[str, Any],
    answer: tuple[str, str],
    truth: bool,
    because: str,
    traits: Sequence[str],
    *,
    size: int = 1,
    swept: Mapping[str, Any] | None = None,
) -> Trial:
    """Does a text say the same as a constraint? ``answer``: the constraint's name, and the text."""
    handed = {"constraint": answer[0], "text": answer[1]}
    varied = _varied(name, size, swept)
    return Trial(family, name, "equivalence", scene, truth, because, tuple(traits), size, varied, handed)


def _varied(name: str, size: int, swept: Mapping[str, Any] | None) -> dict[str, Any]:
    """What is varied; where that is the size alone, of which member: its name with n for the size."""
    member, sizes = re.subn(rf"\b{size} by {size}\b|\b{size}\b", "n", name, count=1)
    return dict(swept) if swept else {"member": member} if sizes else {}


def asked(
    family: str,
    known: KnownTruth,
    because: str,
    traits: Sequence[str],
    *,
    size: int = 1,
    swept: Mapping[str, Any] | None = None,
    questions: Sequence[Question] = ALL,
) -> Iterator[Trial]:
    """The trials of what is known of a scene."""
    found = ask(
        family,
        known.name,
        known.scene,
        because,
        traits,
        size=size,
        swept=swept,
        dof=-1 if known.truth.get("consistent") is False else known.truth.get("dof"),
        integrability=_labels(known),
        redundancy=known.truth.get("redundant"),
    )
    return (trial for trial in found if trial.question in questions)


def _labels(known: KnownTruth) -> dict[str, bool] | None:
    """Whether every constraint is holonomic, where that is known of all."""
    if len(known.labels) < len(known.scene["constraints"]):
        return None
    found = {name: label.get("holonomic") for name, label in known.labels.items()}
    return None if None in found.values() else {name: bool(value) for name, value in found.items()}


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
