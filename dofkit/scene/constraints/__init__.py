"""Constraints: one small class for each type, with its equations in its docstring and its properties in its ``facts``.

`TYPES` maps every ``type`` to its class. A new type is a class of this folder, a row of `AnyConstraint` and
one of ``words.yaml``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, get_args

from pydantic import Field

from dofkit.scene.constraints.base import ConstraintBase, Equation, On
from dofkit.scene.constraints.contacts import Cam, Gear, Roll
from dofkit.scene.constraints.coupling import Coupling
from dofkit.scene.constraints.distances import Link, Rigid, String
from dofkit.scene.constraints.joints import Cylindrical, Planar, Prismatic, Revolute, Screw, Spherical, Universal, Weld
from dofkit.scene.constraints.places import Coincident, Fixed, Slot

__all__ = ["TYPES", "AnyConstraint", "ConstraintBase"]

#: Every type, distinguished by ``type``, in the order of the contract's table.
AnyConstraint = Annotated[
    Equation | On | Link | Rigid | Fixed | Revolute | Prismatic | Weld | Cylindrical | Screw | Universal | Spherical
    | Planar | Coincident | Slot | Roll | String | Gear | Cam | Coupling,
    Field(discriminator="type"),
]  # fmt: skip
TYPES: Mapping[str, type[ConstraintBase]] = {cls.kind(): cls for cls in get_args(get_args(AnyConstraint)[0])}
