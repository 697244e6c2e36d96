"""An assignment with its scenes in place, as JSON: it stands alone, whatever it was made of."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

from dofkit.base.documents import read_document
from dofkit.homework.assignment import load_assignment
from dofkit.scene.catalog import find


def inlined(source: str | os.PathLike[str]) -> dict[str, Any]:
    """The assignment of a file, every scene in place. Raises AssignmentError, as `load_assignment` does."""
    load_assignment(source)
    shown = os.fspath(source)
    found = find(shown)
    value: Any = read_document(found.data, found.name).value
    problems = [{**problem, "scene": _scene(problem["scene"], Path(shown).parent)} for problem in value["problems"]]
    return {**value, "problems": problems}


def _scene(scene: Any, base: Path) -> Any:
    if isinstance(scene, Mapping):
        return scene
    found = find(base / scene if (base / scene).is_file() else scene)
    value: Any = read_document(found.data, found.name).value
    return {"name": found.name, **value}


def exact_json(value: Any) -> str:
    """JSON with every number as it was written: 0.1 is one tenth there, too.

    >>> exact_json({"a": [Decimal("0.10"), 1, True, None, "é"], "b": {}})
    '{"a": [0.10, 1, true, null, "\\\\u00e9"], "b": {}}'
    """
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(str(key))}: {exact_json(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(exact_json, value)) + "]"
    if isinstance(value, Decimal):
        return str(value)
    if isinstance(value, Fraction):
        return json.dumps(str(value))
    return json.dumps(value)
