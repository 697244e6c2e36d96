"""From a `System` to a `Report`: freedom, dependence, labels with their reasons, special cases.

`study` makes a `Study` in a file of its own name, which hides a function that a room would hand on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.classification.dependence.equivalence import compare
    from dofkit.classification.dependence.implication import follows
    from dofkit.classification.passes import report_of
    from dofkit.classification.study import Study

__all__ = ["Study", "compare", "follows", "report_of"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "Study": "dofkit.classification.study",
    "compare": "dofkit.classification.dependence.equivalence",
    "follows": "dofkit.classification.dependence.implication",
    "report_of": "dofkit.classification.passes",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
