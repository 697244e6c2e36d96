"""A scene as a person writes it: particles, bodies, coordinates, and the constraints on them.

`Scene` checks its structure when it is built; `lowering.check` finds every fault across its fields and in its texts:
names that are not declared, joints without their axis, lengths that contradict the drawing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field, PrivateAttr, WrapValidator

from dofkit.base.arguments import require_one_of
from dofkit.base.display import Companion, Displayed
from dofkit.scene.constraints import TYPES, ConstraintBase, OneConstraint
from dofkit.scene.constraints.equations import as_equation
from dofkit.scene.fields import (
    Listed,
    Number,
    TaggedUnion,
    Value,
    WrittenModel,
    exact,
    fault_at,
    fault_error,
)
from dofkit.scene.hints import type_advice
from dofkit.scene.parts import AnyBody, AnyParticle, Energies, Force

_CONSTRAINT = TaggedUnion(
    base=ConstraintBase,
    called="a constraint",
    key="type",
    known=TYPES,
    names="types",
    listing="the types are ",
    unknown="there is no constraint type '{}'",
    otherwise=("a constraint is a text or a mapping with a `type`", None),
    advise=type_advice,
)


def _parameters(value: object) -> object:
    """A list of names, or a mapping whose empty values mean `real`."""
    if value is None:
        return {}
    if isinstance(value, str):
        value = [value]
    if isinstance(value, (list, tuple)):
        seen: set[str] = set()
        for i, name in enumerate(value):
            if not isinstance(name, str):
                hint = "write `parameters: {NAME: VALUE}` to give values"
                raise fault_at((i,), "a list of parameters holds names only", hint)
            if name in seen:
                raise fault_at((i,), f"the parameter '{name}' is given twice", "leave one of them out")
            seen.add(name)
        return dict.fromkeys(value, "real")
    if isinstance(value, Mapping):
        return {name: "real" if given is None else given for name, given in value.items()}
    return value


def _functions(value: object) -> object:
    """A mapping; a single argument needs no list."""
    if value is None:
        return {}
    if isinstance(value, Mapping):
        return {name: (given,) if isinstance(given, str) else given for name, given in value.items()}
    return value


def _mapping(value: object) -> object:
    return {} if value is None else value


def _dimension(value: object) -> object:
    found = exact(value)
    if found not in (1, 2, 3):
        raise fault_error(f"the dimension is 1, 2 or 3, not {value}")
    return int(found)


def _tolerance(value: object) -> object:
    found = exact(value)
    if not 0 <= found < 1:
        raise fault_error(f"the tolerance is a fraction of the scene's size, from 0 up to 1, not {value}")
    return found


_Mapping = BeforeValidator(_mapping)
_AnyConstraint = Annotated[
    OneConstraint,
    WrapValidator(_CONSTRAINT.validated),
    BeforeValidator(as_equation, json_schema_input_type=str | OneConstraint),
]


class Scene(Displayed, WrittenModel):
    """A mechanical system as it is written: its fields are the keys of a scene's file.

    Numbers are exact, in the units of the file. A scene is frozen; ``model_copy(update=...)`` returns a changed one.
    Use `dofkit.load` rather than ``Scene(...)``, which checks neither texts nor geometry.

    Examples
    --------
    >>> import dofkit
    >>> scene = dofkit.load({"particles": ["A", "B"], "constraints": [{"type": "link", "between": ["A", "B"]}]})
    >>> scene.dimension, [p.name for p in scene.particles], scene.constraints[0].in_words
    (3, ['A', 'B'], 'link A-B')
    """

    _in_brief: ClassVar[tuple[str, ...]] = ("name", "title")

    name: str = Field("scene", min_length=1, description="a short name, used in reports; by default the file's stem")
    title: str | None = Field(None, description="one line about it")
    source: str | None = Field(None, description="where it comes from")
    notes: str | None = Field(None, description="what is remarkable about it")
    left_out: Annotated[tuple[str, ...], Listed] = Field(
        (), description="what was left out of the imported model, and why"
    )
    dimension: Annotated[Literal[1, 2, 3], BeforeValidator(_dimension)] = Field(
        3, description="the dimension of the world: 1, 2 or 3"
    )
    parameters: Annotated[
        dict[str, Value],
        BeforeValidator(_parameters, json_schema_input_type=list[str] | dict[str, Value]),
    ] = Field(
        default_factory=dict,
        description="constants: a list of names, or a mapping name -> real, positive, nonzero, or a value",
    )
    functions: Annotated[
        dict[str, Annotated[tuple[str, ...], Field(min_length=1)]],
        BeforeValidator(_functions, json_schema_input_type=dict[str, list[str] | str]),
    ] = Field(default_factory=dict, description="unknown smooth functions: name -> list of arguments")
    particles: Annotated[tuple[AnyParticle, ...], Listed] = Field((), description="names, or mappings")
    bodies: Annotated[tuple[AnyBody, ...], Listed] = Field((), description="names, or mappings")
    coordinates: Annotated[tuple[str, ...], Listed] = Field(
        (), description="configuration coordinates that belong to no particle or body"
    )
    constraints: Annotated[tuple[_AnyConstraint, ...], Listed] = Field(
        (), description="mappings with a `type`; a plain text is an equation"
    )
    forces: Annotated[tuple[Force, ...], Listed] = Field(
        (), description="springs, dampers and other forces, which are not constraints"
    )
    energies: Energies | None = Field(None, description="energies, for the equations of motion")
    tolerance: Annotated[Number, BeforeValidator(_tolerance)] | None = Field(
        None, description="measured geometry: right to within this fraction of the scene's size; absent: exact"
    )
    configuration: Annotated[dict[str, Value], _Mapping] = Field(
        default_factory=dict, description="a reference configuration: coordinate -> value"
    )
    expect: Annotated[dict[str, Any], _Mapping] = Field(
        default_factory=dict, description="what the report must say, by report key"
    )

    _kept: Companion = PrivateAttr(default_factory=Companion)

    @classmethod
    def called(cls) -> str:
        return "a scene"


def without(scene: Scene, names: Sequence[str]) -> Scene:
    """Return the scene without the constraints of these names; the others keep theirs, those given by position too.

    What the scene expects is dropped as well. Raises ArgumentError, with the nearest name, for one that is no
    constraint's.

    >>> import dofkit
    >>> scene = dofkit.load({"coordinates": ["x", "y"], "constraints": ["x = 1", "y = 2", "x = y"]})
    >>> [c.name for c in without(scene, ["c2"]).constraints]
    ['c1', 'c3']
    """
    named = {c.name or f"c{i}": c for i, c in enumerate(scene.constraints, 1)}
    for name in names:
        require_one_of(name, named, "constraint")
    kept = tuple(c.model_copy(update={"name": name}) for name, c in named.items() if name not in names)
    return scene.model_copy(update={"constraints": kept, "expect": {}})
