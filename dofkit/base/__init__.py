"""What knows no mathematics: faults, the time allowed, verdicts, documents with their places, killable processes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.base.deadline import OutOfTimeError, check, limited
    from dofkit.base.documents import read_document
    from dofkit.base.errors import ArgumentError, DofkitError, Fault, SceneError, TextError
    from dofkit.base.spelling import nearest
    from dofkit.base.verdicts import Verdict, weakest
    from dofkit.base.workers import Job, Pool, Worker

__all__ = [
    "ArgumentError", "DofkitError", "Fault", "Job", "OutOfTimeError", "Pool", "SceneError", "TextError", "Verdict",
    "Worker", "check", "limited", "nearest", "read_document", "weakest",
]  # fmt: skip

#: What is handed on, imported when it is first asked for.
_HOMES = {
    "ArgumentError": "dofkit.base.errors",
    "DofkitError": "dofkit.base.errors",
    "Fault": "dofkit.base.errors",
    "Job": "dofkit.base.workers",
    "OutOfTimeError": "dofkit.base.deadline",
    "Pool": "dofkit.base.workers",
    "SceneError": "dofkit.base.errors",
    "TextError": "dofkit.base.errors",
    "Verdict": "dofkit.base.verdicts",
    "Worker": "dofkit.base.workers",
    "check": "dofkit.base.deadline",
    "limited": "dofkit.base.deadline",
    "nearest": "dofkit.base.spelling",
    "read_document": "dofkit.base.documents",
    "weakest": "dofkit.base.verdicts",
}


def __getattr__(name: str) -> Any:
    found = globals()[name] = handed_on(__name__, _HOMES, name)
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
