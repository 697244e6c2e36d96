"""What runs in the browser: the functions that the bench and the practice sheets call, by name and with texts.

`reports` checks and classifies a scene, and `shown` is a printed sheet as JSON; `drawings` needs numpy, `equations`
SymPy, and `answers` reads and judges the answers of a sheet. A module is imported when it is first asked for, after
the worker has loaded what it needs. Nothing returned is HTML.
"""

from __future__ import annotations

import json
from importlib import import_module

from dofkit.base.errors import DofkitError, Fault, SceneError


def answer(module: str, call: str, arguments: str) -> str:
    """Return what a function says, as JSON; what is no scene, and what has no answer, gives its faults."""
    try:
        value = getattr(import_module(f"{__name__}.{module}"), call)(*json.loads(arguments))
    except SceneError as error:
        value = {"faults": [_fault(fault) for fault in error.faults]}
    except DofkitError as error:
        value = {"faults": [_fault(Fault(str(error)))]}
    return json.dumps(value)


def _fault(fault: Fault) -> dict[str, str | int]:
    line, column = fault.line or 1, fault.column or 1
    return {"message": fault.message, "line": line, "column": column, "hint": fault.hint or ""}
