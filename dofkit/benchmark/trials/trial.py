"""A scene with a question whose answer is known by construction. Nothing here asks dofkit what is true."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from dofkit.methods.table import Question

#: ``dof``: a number (-1: the constraints contradict each other); ``integrability``: whether each constraint is
#: holonomic in the system, by name; ``redundancy``: the names of what can be dropped, sorted; ``equivalence``: whether
#: ``answer`` says the same as the constraint that it names.
Truth = int | bool | list[str] | dict[str, bool]


@dataclass(frozen=True)
class Trial:
    """One question about one scene.

    ``scene`` is a mapping as `dofkit.load` takes it; ``truth`` see `Truth`; ``because`` says in one line why it holds.
    ``traits`` name what makes it hard (keys of `dofkit.benchmark.failures`), the one that matters most first; ``size``
    counts what grows with the family; ``swept`` holds what is varied (``digits``, ``gap``, ``scale``, ...).
    ``answer``: for equivalence, ``{"constraint": name, "text": what was handed in}``.
    """

    family: str
    name: str
    question: Question
    scene: Mapping[str, Any]
    truth: Truth
    because: str
    traits: tuple[str, ...] = ()
    size: int = 1
    swept: Mapping[str, Any] = field(default_factory=dict)
    answer: Mapping[str, str] | None = None
