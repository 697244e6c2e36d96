"""A first assignment with the best questions for each scene; and an empty submission to fill in."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml
from pydantic import TypeAdapter

from dofkit.homework.assignment import Prepared
from dofkit.homework.key.key import Key
from dofkit.homework.questions import KINDS, MOTION, AnyQuestion
from dofkit.scene.reading import load

#: The equations of a constraint are asked for only if there are fewer than this.
FEW = 3
_NOT_PLAIN = re.compile(r"[^\w-]+")
_QUESTION: TypeAdapter[Any] = TypeAdapter(AnyQuestion)


def starting(sources: Sequence[str]) -> str:
    """Return the YAML of an assignment about scenes (catalog names or paths). Raises SceneError."""
    problems: list[dict[str, Any]] = []
    for source in sources:
        scene = load(source)
        title = {} if scene.title is None else {"title": scene.title}
        name = _unused(scene.name or Path(source).stem, [p["id"] for p in problems])
        key = Key(scene)
        problems.append({"id": name, **title, "scene": source, "questions": list(best_questions(key))})
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
            asked = " ".join(question.asked(", ".join(question.about)).translated(prepared.assignment.language).split())
            lines.append(f"    {json.dumps(question.id, ensure_ascii=False)}:  # {asked}")
    return "\n".join(lines) + "\n"


def best_questions(key: Key) -> Iterator[dict[str, Any]]:
    """Yield one question of each kind, unless its answer is obvious, about the constraint with most negative labels."""
    chosen: dict[str, dict[str, Any]] = {}
    for question in sorted(questions(key), key=lambda question: -_labels_that_fail(question, key)):
        if not _is_plain(question, key):
            chosen.setdefault(question["ask"], question)
    yield from (question for question in questions(key) if question in chosen.values())


def _labels_that_fail(asked: Mapping[str, Any], key: Key) -> int:
    """Return how many labels (holonomic, scleronomic, bilateral) are false for the constraint of a question."""
    entry = key.constraints.get(asked.get("constraint", ""))
    return 0 if entry is None else [entry.holonomic, entry.scleronomic, entry.bilateral].count(False)


def _is_plain(asked: Mapping[str, Any], key: Key) -> bool:
    """Return whether an answer is obvious from the text of the scene, or too long."""
    report, entry = key.report, key.constraints.get(asked.get("constraint", ""))
    if asked["ask"] == "equation" and entry is not None:
        facts = dict(zip(key.constraints, key.scene.constraints, strict=True))[entry.name].facts
        return facts.written or entry.equations >= FEW
    return {
        "velocity_dof": report.velocity_dof == report.dof,
        "redundant": not report.redundant,
        "coordinates": not 0 < (report.dof or 0) < len(key.coordinates),
    }.get(asked["ask"], False)


def questions(key: Key) -> Iterator[dict[str, Any]]:
    """Yield all possible questions about a scene, as they are written in an assignment."""
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
    """Yield every kind of question, for each constraint or coordinate if it needs one."""
    about = {"constraint": [*key.constraints], "coordinate": key.report.generalized_coordinates or []}
    for ask, kind in KINDS.items():
        needed = [name for name in about if name in kind.model_fields and kind.model_fields[name].is_required()]
        if key.scene.energies is not None or not issubclass(kind, MOTION):
            yield from ({"ask": ask, field: name} for field in needed for name in about[field])
            yield from () if needed else [{"ask": ask}]


def _unused(name: str, taken: Sequence[str]) -> str:
    return next(n for n in (name, *(f"{name}-{i}" for i in range(2, len(taken) + 3))) if n not in taken)
