"""A starting assignment: all the questions that scenes can be asked, to be cut down by the lecturer."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from io import StringIO
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter
from ruamel.yaml import YAML

from dofkit.homework.key.key import Key
from dofkit.homework.questions import AnyQuestion
from dofkit.scene.reading import load

#: Questions about the whole scene, and about each constraint, and those about equations of motion.
_OF_SCENE = ("dof", "velocity_dof", "k", "coordinates", "redundant")
_OF_CONSTRAINT = ("label", "equation", "integral")
_OF_MOTION = ("lagrangian", "motion")
_OF_COORDINATE = ("momentum", "force")
_NOT_PLAIN = re.compile(r"[^\w-]+")
_QUESTION: TypeAdapter[Any] = TypeAdapter(AnyQuestion)


def starting(sources: Sequence[str]) -> str:
    """The YAML of an assignment over these scenes: catalog names or paths. Raises SceneError."""
    problems: list[dict[str, Any]] = []
    for source in sources:
        scene = load(source)
        title = {} if scene.title is None else {"title": scene.title}
        name = _unused(scene.name or Path(source).stem, [p["id"] for p in problems])
        problems.append({"id": name, **title, "scene": source, "questions": list(questions(Key(scene)))})
    yaml = YAML()
    yaml.width = 110
    out = StringIO()
    yaml.dump({"title": "Assignment", "convention": "configuration", "problems": problems}, out)
    return out.getvalue()


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
