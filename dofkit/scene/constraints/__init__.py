"""Constraints: one small class a type, each with its equations in its docstring and its facts for all others.

`TYPES` maps every ``type`` to its class: the classes of this folder's modules that have one. A new type is a new file.
A class is made when it is first asked for: most scenes have constraints of few types.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache, reduce
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

#: The file of each type, in the order of the contract's table. What is not in it comes after, by name, and is found by
#: looking through all files.
_FILES = {
    "equation": "equations", "on": "equations", "link": "distances", "rigid": "distances", "fixed": "places",
    "revolute": "plane_and_space", "prismatic": "plane_and_space", "weld": "plane_and_space", "cylindrical": "spatial",
    "screw": "spatial", "universal": "spatial", "spherical": "spatial", "planar": "spatial", "coincident": "places",
    "slot": "places", "roll": "rolling", "string": "distances", "gear": "rolling", "cam": "cam", "coupling": "coupling",
}  # fmt: skip


class ConstraintTypes(Mapping[str, type[ConstraintBase]]):
    """Every constraint type by its name in a scene, and its class from the one file that it needs."""

    def __getitem__(self, kind: str) -> type[ConstraintBase]:
        """The class of a type. Raises KeyError where there is no such type."""
        return (_classes(_FILES[kind]) if kind in _FILES else _all_classes())[kind]

    def __contains__(self, kind: object) -> bool:
        return kind in _FILES or kind in _all_classes()

    def __iter__(self) -> Iterator[str]:
        return iter(_all_classes())

    def __len__(self) -> int:
        return len(_all_classes())


@cache
def _classes(file: str) -> dict[str, type[ConstraintBase]]:
    """The classes with a ``type`` that a module of this folder defines, by their types."""
    module = import_module(f"{__name__}.{file}")
    own = (
        cls
        for cls in vars(module).values()
        if isinstance(cls, type) and issubclass(cls, ConstraintBase) and cls.__module__ == module.__name__
    )
    return {cls.kind(): cls for cls in own if "type" in cls.model_fields}


@cache
def _all_classes() -> dict[str, type[ConstraintBase]]:
    """The classes of all modules of this folder."""
    found = {kind: cls for path in Path(__file__).parent.glob("[!_]*.py") for kind, cls in _classes(path.stem).items()}
    first = {kind: found.pop(kind) for kind in _FILES}
    return {**first, **dict(sorted(found.items()))}


TYPES = ConstraintTypes()


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
