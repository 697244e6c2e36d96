"""A starting assignment: of each scene the questions most worth asking, or all; and an empty submission to fill in."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Hashable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml
from pydantic import TypeAdapter

from dofkit.homework.assignment import Prepared
from dofkit.homework.key.key import Key
from dofkit.homework.key.own_coordinates import polar_angles
from dofkit.homework.questions import AnyQuestion
from dofkit.scene.reading import load

#: Questions about the whole scene, and about each constraint, and those about equations of motion.
_OF_SCENE = ("dof", "velocity_dof", "k", "coordinates", "redundant")
_OF_CONSTRAINT = ("label", "equation", "integral")
_OF_MOTION = ("lagrangian", "motion")
_OF_COORDINATE = ("momentum", "force")
#: So many questions are asked of a scene; a constraint of fewer equations is one to write down.
MOST, FEW = 5, 3
_NOT_PLAIN = re.compile(r"[^\w-]+")
_QUESTION: TypeAdapter[Any] = TypeAdapter(AnyQuestion)


def starting(sources: Sequence[str], every: bool = False) -> str:
    """The YAML of an assignment over these scenes: catalog names or paths; ``every`` question. Raises SceneError."""
    problems: list[dict[str, Any]] = []
    for source in sources:
        scene = load(source)
        title = {} if scene.title is None else {"title": scene.title}
        name = _unused(scene.name or Path(source).stem, [p["id"] for p in problems])
        key = Key(scene)
        asked = list(questions(key)) if every else list(best_questions(key))
        angles = polar_angles(key)
        also = {"also": angles} if angles else {}
        problems.append({"id": name, **title, "scene": source, **also, "questions": asked})
    assignment = {"title": "Assignment", "convention": "configuration", "problems": problems}
    return yaml.safe_dump(assignment, sort_keys=False, allow_unicode=True, width=110)


def template(prepared: Prepared, form: str) -> str:
    """Return an empty submission of an assignment to fill in, as ``yaml`` or ``csv``."""
    if form == "csv":
        return ",".join(["student", *prepared.columns()]) + "\n"
    lines = ["# Fill in the answers and submit this file.", "student:", "answers:"]
    for problem in prepared.assignment.problems:
        lines.append(f"  {json.dumps(problem.id, ensure_ascii=False)}:")
        for question in problem.questions:
            asked = " ".join(question.asked(", ".join(question.about)).told(prepared.assignment.language).split())
            lines.append(f"    {json.dumps(question.id, ensure_ascii=False)}:  # {asked}")
    return "\n".join(lines) + "\n"


def best_questions(key: Key) -> Iterator[dict[str, Any]]:
    """The questions most worth asking of a scene: those whose answer is not plain from how it is written."""
    ranked = sorted(questions(key), key=QuestionWorth(key).of, reverse=True)[:MOST]
    yield from (asked for asked in questions(key) if asked in ranked)


class QuestionWorth:
    """How much each question of a scene is worth asking; of questions of a kind the first counts most."""

    def __init__(self, key: Key) -> None:
        self._key = key
        self._asked: Counter[Hashable] = Counter()

    def of(self, asked: Mapping[str, Any]) -> int:
        """A number, the larger the better; it depends on what was asked about before."""
        if "constraint" in asked:
            return self._about_constraint(asked)
        report = self._key.report
        n, dof = len(self._key.coordinates), report.dof or 0
        hidden = n - dof != len(report.constraints)
        return {
            "dof": 100,
            "velocity_dof": 90 if report.velocity_dof != report.dof else 5,
            "k": 40 if hidden else 20,
            "coordinates": 60 if 0 < dof < n else 10,
            "redundant": 85 if report.redundant else 15,
            "motion": 92,
            "lagrangian": 88,
        }.get(asked["ask"], 30)

    def _about_constraint(self, asked: Mapping[str, Any]) -> int:
        """A label is worth more where it is no plain one, an equation where it has to be found."""
        entry = self._key.constraints[asked["constraint"]]
        written = dict(zip(self._key.constraints, self._key.scene.constraints, strict=True))[entry.name].facts.written
        labels: tuple[bool | None, ...] = (entry.holonomic, entry.scleronomic, entry.bilateral)
        if asked["ask"] == "label":
            worth = 66 + 4 * labels.count(False) + 3 * (entry.form == "pfaffian")
        elif asked["ask"] == "integral":
            worth, labels = 75, (entry.holonomic,)
        else:
            worth, labels = 8 if written else 70 if entry.equations < FEW else 30, ()
        self._asked[asked["ask"], labels] += 1
        self._asked[asked["ask"]] += 1
        again = self._asked[asked["ask"], labels] > 1
        return worth - (60 if again else 20 if self._asked[asked["ask"]] > 1 else 0)


def questions(key: Key) -> Iterator[dict[str, Any]]:
    """Every question that a scene can be asked, as it is written in an assignment."""
    taken: list[str] = []
    for asked in _candidates(key):
        question = _QUESTION.validate_python({"id": "q", **asked})
        if any(question.faults(key)):
            continue
        about = asked.get("constraint") or asked.get("coordinate")
        name = _unused(_NOT_PLAIN.sub("-", f"{asked['ask']}-{about}" if about else asked["ask"]), taken)
        taken.append(name)
        yield {"id": name, **asked, "points": 1}


def _candidates(key: Key) -> Iterator[Mapping[str, str]]:
    for ask in _OF_SCENE:
        yield {"ask": ask}
    for name in key.constraints:
        for ask in _OF_CONSTRAINT:
            yield {"ask": ask, "constraint": name}
    if key.scene.energies is None:
        return
    for ask in _OF_MOTION:
        yield {"ask": ask}
    for name in key.report.generalized_coordinates or ():
        for ask in _OF_COORDINATE:
            yield {"ask": ask, "coordinate": name}


def _unused(name: str, taken: Sequence[str]) -> str:
    return next(n for n in (name, *(f"{name}-{i}" for i in range(2, len(taken) + 3))) if n not in taken)
