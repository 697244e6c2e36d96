"""Constraints: one small class a type, each with its equations in its docstring and its facts for all others.

`TYPES` maps every ``type`` to its class: the classes of this folder's modules that have one. A new type is a new file.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import reduce
from importlib import import_module
from operator import or_
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import (
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    GetPydanticSchema,
    TypeAdapter,
    ValidationError,
)
from pydantic_core import core_schema

from dofkit.scene.constraints.base import ConstraintBase
from dofkit.scene.fields import retold

__all__ = ["TYPES", "AnyConstraint", "ConstraintBase", "OneConstraint"]

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


class _OneOfAll:
    """A constraint, validated by the one class that its ``type`` names, and dumped as what it is.

    The other classes are not made ready, as they are for `AnyConstraint`, whose JSON Schema this has.
    """

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        del source, handler
        as_it_is = core_schema.simple_ser_schema("any")
        return core_schema.no_info_plain_validator_function(cls._validated, serialization=as_it_is)

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        del schema
        return handler(TypeAdapter(AnyConstraint).core_schema)

    @staticmethod
    def _validated(value: Any) -> ConstraintBase:
        """What is a constraint or a mapping; paths of faults begin with the type, as those of a union do."""
        kind = value["type"] if isinstance(value, Mapping) else value.kind()
        try:
            return TYPES[kind].model_validate(value)
        except ValidationError as error:
            raise retold(error, kind, (), lambda loc: (kind, *loc)) from None


if TYPE_CHECKING:
    OneConstraint = ConstraintBase
else:
    OneConstraint = _OneOfAll
