"""Constraints: one small class a type, each with its equations in its docstring.

`AnyConstraint` at the end is the union of them all, told apart by ``type``; `TYPES` maps every
``type`` to its class.
"""

from __future__ import annotations

from typing import Annotated, get_args

from pydantic import Field

from dofkit.scene.constraints.base import ConstraintBase
from dofkit.scene.constraints.distances import Link, Rigid, String
from dofkit.scene.constraints.equations import Equation, On
from dofkit.scene.constraints.places import Coincident, Fixed, Slot
from dofkit.scene.constraints.plane_and_space import Prismatic, Revolute, Weld
from dofkit.scene.constraints.rolling import Gear, Roll
from dofkit.scene.constraints.spatial import Cylindrical, Planar, Screw, Spherical, Universal

__all__ = [
    "TYPES", "AnyConstraint", "Coincident", "ConstraintBase", "Cylindrical", "Equation", "Fixed", "Gear", "Link",
    "On", "Planar", "Prismatic", "Revolute", "Rigid", "Roll", "Screw", "Slot", "Spherical", "String", "Universal",
    "Weld",
]  # fmt: skip

AnyConstraint = Annotated[
    Equation
    | On
    | Link
    | Rigid
    | Fixed
    | Revolute
    | Prismatic
    | Weld
    | Cylindrical
    | Screw
    | Universal
    | Spherical
    | Planar
    | Coincident
    | Slot
    | Roll
    | String
    | Gear,
    Field(discriminator="type"),
]

#: Every constraint type by its name in a scene.
TYPES: dict[str, type[ConstraintBase]] = {cls.kind(): cls for cls in get_args(get_args(AnyConstraint)[0])}
