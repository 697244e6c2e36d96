"""Constraints: one small class a type, each with its equations in its docstring and its facts for all others.

`TYPES` maps every ``type`` to its class: the classes of this folder's modules that have one. A new type is a new file.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from importlib import import_module
from operator import or_
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, GetCoreSchemaHandler, GetPydanticSchema

from dofkit.scene.constraints.base import ConstraintBase

__all__ = ["TYPES", "AnyConstraint", "ConstraintBase"]

#: The order of the contract's table; what is not in it comes after, by name.
_ORDER = (
    "equation", "on", "link", "rigid", "fixed", "revolute", "prismatic", "weld", "cylindrical", "screw", "universal",
    "spherical", "planar", "coincident", "slot", "roll", "string", "gear",
)  # fmt: skip


def _place(cls: type[ConstraintBase]) -> tuple[int, str]:
    kind = cls.kind()
    return _ORDER.index(kind) if kind in _ORDER else len(_ORDER), kind


def _defined() -> Iterator[type[ConstraintBase]]:
    """The classes with a ``type`` that the modules of this folder define."""
    for path in Path(__file__).parent.glob("[!_]*.py"):
        module = import_module(f"{__name__}.{path.stem}")
        for cls in vars(module).values():
            own = isinstance(cls, type) and issubclass(cls, ConstraintBase) and cls.__module__ == module.__name__
            if own and "type" in cls.model_fields:
                yield cls


#: Every constraint type by its name in a scene.
TYPES: dict[str, type[ConstraintBase]] = {cls.kind(): cls for cls in sorted(_defined(), key=_place)}


def _by_type(source: Any, handler: GetCoreSchemaHandler) -> Any:
    """The union of all types, told apart by ``type``."""
    del source
    return handler(Annotated[reduce(or_, TYPES.values()), Field(discriminator="type")])


AnyConstraint = Annotated[ConstraintBase, GetPydanticSchema(_by_type)]
