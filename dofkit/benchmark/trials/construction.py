"""Trials, scenes whose answers are known by construction, and the tables of such scenes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any, TypedDict, Unpack

import yaml

from dofkit.methods.table import Question

#: The right answer to a question. ``dof``: a number (-1: the constraints contradict each other); ``integrability``:
#: {constraint: whether it is holonomic in the system}; ``redundancy``: the names of redundant constraints, sorted;
#: ``equivalence``: whether the text of ``answer`` is equivalent to the constraint that it names.
Truth = int | bool | list[str] | dict[str, bool]


@dataclass(frozen=True)
class Trial:
    """One question about one scene, with the true answer, which was never computed by dofkit.

    ``scene`` is a mapping for `dofkit.load`; ``truth``: see `Truth`; ``because``: in one line why the truth is so.
    ``size``: the number that grows within the family, such as of bodies. ``answer``: for equivalence,
    ``{"constraint": name, "text": submitted text}``.
    """

    family: str
    name: str
    question: Question
    scene: Mapping[str, Any]
    truth: Truth
    because: str
    size: int = 1
    answer: Mapping[str, str] | None = None


@dataclass(frozen=True)
class KnownScene:
    """A scene with its true answers, known by construction and not computed by dofkit.

    ``truth``: {field of the report, or CONSTRAINT.field of an entry: value}, for some fields only. ``elsewhere``: other
    right values of a field, on smaller components of the configuration space, for reports about one component only.
    ``chart``: a parametrization of an open part of the configuration space, by which the truth can be confirmed: the
    coordinates in order as functions of p0, p1, ... (as many as ``dof``), of t and of earlier coordinates.
    ``group``: the name of scenes that belong together; ``equivalence``: (constraint, text, are they equivalent?);
    ``because`` and ``size``: see `Trial`.
    """

    scene: Mapping[str, Any]
    truth: Mapping[str, Any]
    elsewhere: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    chart: Mapping[str, str] | None = None
    name: str = ""
    group: str = ""
    because: str = ""
    size: int = 1
    equivalence: tuple[str, str, bool] | None = None

    @property
    def dof(self) -> int | None:
        """The number of degrees of freedom, -1 if the constraints contradict each other, None if it is not known."""
        return -1 if self.truth.get("consistent") is False else self.truth.get("dof")

    @property
    def integrability(self) -> dict[str, bool] | None:
        """{constraint: whether it is holonomic}; None unless this is known for all constraints."""
        labels = {name: self.truth.get(f"{name}.holonomic") for name in constraint_names(self.scene)}
        return None if None in labels.values() else {name: bool(value) for name, value in labels.items()}

    def trials(self, family: str) -> Iterator[Trial]:
        """Yield a trial for every question whose answer is known."""
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
        return Trial(family, name, question, self.scene, truth, self.because, self.size, answer)


class Answers(TypedDict, total=False):
    """Answers to the questions of trials; an answer that is None or missing is not known.

    See `Truth`; ``equivalence``: see `KnownScene`.
    """

    dof: int | None
    integrability: Mapping[str, bool] | None
    redundancy: Sequence[str] | None
    equivalence: tuple[str, str, bool]


def known_scene(
    name: str,
    scene: Mapping[str, Any],
    because: str,
    size: int = 1,
    **answers: Unpack[Answers],
) -> KnownScene:
    """Return a known scene from the answers to the questions of its trials."""
    dof, redundant = answers.get("dof"), answers.get("redundancy")
    truth: dict[str, Any] = dict(IMPOSSIBLE) if dof == -1 else {} if dof is None else {"consistent": True, "dof": dof}
    truth |= {f"{constraint}.holonomic": value for constraint, value in (answers.get("integrability") or {}).items()}
    truth |= {} if redundant is None else {"redundant": list(redundant)}
    return KnownScene(scene, truth, {}, None, name, "", because, size, answers.get("equivalence"))


#: The truth about constraints that contradict each other.
IMPOSSIBLE: Mapping[str, Any] = {"consistent": False, "dof": None, "velocity_dof": None}


def truths(dof: int, velocity_dof: int | None = None, **more: Any) -> dict[str, Any]:
    """Return the truth of a consistent system; its velocity freedom is ``dof`` unless given; ``more``: other fields."""
    return {"consistent": True, "dof": dof, "velocity_dof": dof if velocity_dof is None else velocity_dof, **more}


def scene_of(coordinates: str | Sequence[str], *constraints: Any, **more: Any) -> dict[str, Any]:
    """Return a scene in coordinates only, a list or a text with spaces; ``more``: other sections, left out if None."""
    names = coordinates.split() if isinstance(coordinates, str) else [*coordinates]
    sections = {key: value for key, value in more.items() if value is not None}
    return {"coordinates": names, "constraints": [*constraints], **sections}


def constraint_names(scene: Mapping[str, Any]) -> list[str]:
    """Return the names of a scene's constraints; those without a name are c1, c2, ... by their place."""
    constraints = scene.get("constraints", ())
    names = [c.get("name") if isinstance(c, Mapping) else None for c in constraints]
    return [name or f"c{i + 1}" for i, name in enumerate(names)]


def numbered(number: int, first: int = 1) -> list[str]:
    """Return the names of ``number`` constraints without a name, c1, c2, ..., beginning with ``first``."""
    return [f"c{i}" for i in range(first, first + number)]


def labels(values: Sequence[bool] | None) -> dict[str, bool] | None:
    """Return {c1: first value, c2: second value, ...}; None for None."""
    return None if values is None else dict(zip(numbered(len(values)), values, strict=True))


# Tables

Row = Mapping[str, Any]
#: The loader by libyaml if it is installed.
LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@cache
def tables(file: str) -> Mapping[str, Sequence[Row]]:
    """Return {name: rows} of the tables in a YAML file of this folder."""
    text = (resources.files(__package__) / file).read_text(encoding="utf-8")
    rows_by_table: Mapping[str, Sequence[Row]] = yaml.load(text, LOADER)
    return rows_by_table


def tabled(row: Row) -> KnownScene:
    """Return the known scene of a table's row, in coordinates only; its size is the number of its equations."""
    about = row["name"], scene_of(row["coordinates"], *row["rows"]), row["because"], len(row["rows"])
    holonomic = labels(row.get("holonomic"))
    return known_scene(*about, dof=row["dof"], integrability=holonomic, redundancy=row.get("redundant"))


# Quick runs

#: The number of trials of a family's first question in a quick run.
FEW = 2


def few(trials: Iterable[Trial]) -> Iterator[Trial]:
    """Return a few small trials of a family: two of the first question, of different kind, and one of each other."""
    chosen: dict[str, list[Trial]] = {}
    for trial in sorted(trials, key=lambda trial: trial.size):
        same = chosen.setdefault(trial.question, [])
        most = FEW if next(iter(chosen)) == trial.question else 1
        if len(same) < most and kind(trial) not in map(kind, same):
            same.append(trial)
    return (trial for same in chosen.values() for trial in same)


def kind(trial: Trial) -> Any:
    """Return the kind of a trial's truth; a constant answer is right for all trials of one question and kind."""
    truth = trial.truth
    if isinstance(truth, dict):
        return tuple(sorted(set(truth.values())))
    return bool(truth) if isinstance(truth, list) else truth
