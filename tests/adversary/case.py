"""A scene with what is true of it."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

Scene = Mapping[str, Any]
Truth = Mapping[str, Any]


@dataclass(frozen=True)
class Case:
    """``truth``: values of fields of the report, and of its entries as ``CONSTRAINT.field``; of some fields only.

    ``elsewhere``: further values of a field, those on smaller parts of the set, that are true where the report says
    that it speaks of one component only. ``chart``: the coordinates in order as functions of p0, p1, ..., of t and of
    coordinates before, onto an open part of the set that the truth speaks of: as many parameters as ``dof``. By it the
    truth is confirmed.
    """

    scene: Scene
    truth: Truth
    elsewhere: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    chart: Mapping[str, str] | None = None


#: A family: a case of a size (0 is the smallest) from random choices.
Generator = Callable[[random.Random, int], Case]


def plain(coordinates: str | Sequence[str], constraints: Sequence[Any], **more: Any) -> Scene:
    """A scene of coordinates and constraints; what is given as None is left out."""
    names = coordinates.split() if isinstance(coordinates, str) else [*coordinates]
    given = {key: value for key, value in more.items() if value is not None}
    return {"coordinates": names, "constraints": [*constraints], **given}


def texts(scene: Scene) -> list[str]:
    """The equations of a scene in which nothing else stands."""
    return [c if isinstance(c, str) else c["text"] for c in scene["constraints"]]


def truths(dof: int, velocity_dof: int | None = None, **more: Any) -> dict[str, Any]:
    """Of a consistent system: its freedoms, as many velocities as coordinates unless they are given, and more."""
    return {"consistent": True, "dof": dof, "velocity_dof": dof if velocity_dof is None else velocity_dof, **more}


#: Of a system that no motion satisfies.
IMPOSSIBLE: Truth = {"consistent": False, "dof": None, "velocity_dof": None}


def at(fields: Mapping[str, Any]) -> Mapping[str, str]:
    """A reference configuration as text."""
    return {name: str(value) for name, value in fields.items()}
