"""What students may have of an assignment: what is asked, and the names of its scenes, so that answers can be read.

Nothing of a scene is in it but names: no geometry, no constraint's text, no value, no ``expect``; of a constraint its
name, since answers name constraints. Coordinates that an assignment offers stand beside the others.
"""

from __future__ import annotations

from typing import Any

from dofkit.homework.assignment import Prepared
from dofkit.homework.key.key import Key
from dofkit.homework.problem import Problem
from dofkit.scene.names import coordinate_table

#: Stands for a constraint's text.
_NOTHING = "0 = 0"


def names_only(prepared: Prepared) -> dict[str, Any]:
    """An assignment that reads as this one does, and knows nothing."""
    problems = [
        {
            "id": problem.id,
            "scene": _names(prepared.keys[problem.id]),
            "names": {name: list(others) for name, others in problem.names.items()},
            "questions": _asked(problem),
        }
        for problem in prepared.assignment.problems
    ]
    return {"title": prepared.assignment.title, "language": prepared.assignment.language, "problems": problems}


def _asked(problem: Problem) -> list[dict[str, Any]]:
    return [question.model_dump(mode="json", exclude_none=True) for question in problem.questions]


def _names(key: Key) -> dict[str, Any]:
    table = coordinate_table(key.scene)
    return {
        "coordinates": [*(c.name for c in table.coordinates), *key.also],
        "parameters": list(key.scene.parameters),
        "functions": {name: list(key.names.arguments.get(name, ())) for name in key.scene.functions},
        "constraints": [{"name": name, "text": _NOTHING} for name in key.constraints],
    }
