"""The JSON Schemas of assignments, results and reports."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from dofkit.homework.assignment import Assignment
from dofkit.homework.result import Result
from dofkit.report import Report
from dofkit.scene.schema import identified

#: {what the schema describes: function that returns it}.
SCHEMAS: dict[str, Callable[[], dict[str, Any]]] = {
    "assignment": lambda: identified(Assignment.model_json_schema(), "assignment"),
    "result": lambda: identified(Result.model_json_schema(mode="serialization"), "result"),
    "report": lambda: identified(Report.model_json_schema(mode="serialization"), "report"),
}
