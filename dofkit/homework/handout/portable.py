"""An assignment as one mapping that needs no other scene files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from dofkit.base.documents import read_document
from dofkit.homework.assignment import Prepared
from dofkit.homework.handout.markup import pictures_of
from dofkit.homework.problem import DRAWN, UNDRAWN, Problem


def standing_alone(prepared: Prepared, out: Path) -> dict[str, Any]:
    """Return the assignment with its scenes included, and with paths of pictures relative to the folder ``out``."""
    value = prepared.assignment.model_dump(mode="json", exclude_none=True, exclude_defaults=True)
    value["problems"] = [
        problem.model_dump(mode="json", exclude_none=True)
        | {"scene": _scene(problem, prepared)}
        | _moved(problem, prepared.base, out)
        for problem in prepared.assignment.problems
    ]
    return value


def _scene(problem: Problem, prepared: Prepared) -> Any:
    """Return the scene of a problem as a mapping; if it varies, as written, with its placeholders."""
    if isinstance(problem.scene, dict):
        return problem.scene
    if problem.vary:
        path = prepared.base / problem.scene
        return read_document(path.read_bytes(), str(path)).value
    scene = prepared.keys[problem.id].scene.model_dump(mode="json", exclude_none=True)
    return {key: value for key, value in scene.items() if value not in ([], {}) and key != "expect"}


def _moved(problem: Problem, base: Path, out: Path) -> dict[str, str]:
    """Return {"figure", "text"} with paths relative to ``out``, as far as the problem contains paths."""
    moved: dict[str, str] = {}
    if problem.figure not in (None, DRAWN, UNDRAWN):
        moved["figure"] = os.path.relpath(base / str(problem.figure), out)
    if problem.text is not None and (pictures := pictures_of(problem.text)):
        text = problem.text
        for source in dict.fromkeys(pictures):
            text = text.replace(f"]({source}", f"]({os.path.relpath(base / source, out)}")
        moved["text"] = text
    return moved
