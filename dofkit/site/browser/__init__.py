"""Functions for the browser, which the bench and the practice sheets call by name, with JSON arguments.

`reports` checks and classifies a scene, and `shown` writes a printed sheet as JSON; `drawings` needs numpy, `equations`
SymPy; `answers` reads and judges the answers of a sheet. A module is imported at its first call, after the worker has
loaded its libraries. No function returns HTML.
"""

from __future__ import annotations

import json
from importlib import import_module

from dofkit.base.errors import DofkitError, Fault, SceneError


def answer(module: str, call: str, arguments: str) -> str:
    """Return the value of ``module.call(*arguments)`` as JSON; if it raises a DofkitError, the faults."""
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
