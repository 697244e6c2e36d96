"""The JSON Schemas of what is read and written besides scenes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from dofkit.homework.assignment import Assignment
from dofkit.homework.result import Result
from dofkit.report import Report
from dofkit.scene.schema import identified

_ANSWER = {
    "description": "a text, a number, or a list of these",
    "anyOf": [
        {"type": ["string", "number", "null"]},
        {"type": "array", "items": {"type": ["string", "number"]}},
    ],
}


def submission_schema() -> dict[str, Any]:
    """The schema of a submission."""
    answers = {
        "description": "answers by problem, then by question",
        "type": "object",
        "additionalProperties": {"type": "object", "additionalProperties": _ANSWER},
    }
    student = {"type": ["string", "number"], "description": "who hands in; by default the file's name"}
    return {
        "title": "Submission",
        "description": "What a student hands in.",
        "type": "object",
        "properties": {"student": student, "answers": answers},
        "required": ["answers"],
        "additionalProperties": False,
    }


#: By what they describe.
SCHEMAS: dict[str, Callable[[], dict[str, Any]]] = {
    "assignment": lambda: identified(Assignment.model_json_schema(), "assignment"),
    "submission": lambda: identified(submission_schema(), "submission"),
    "result": lambda: identified(Result.model_json_schema(mode="serialization"), "result"),
    "report": lambda: identified(Report.model_json_schema(mode="serialization"), "report"),
}
