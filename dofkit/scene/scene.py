"""A scene as a person writes it: particles, bodies, coordinates, and the constraints on them.

`Scene` checks its structure when it is built; `lowering.check` finds every fault across its fields and in its texts:
names that are not declared, joints without their axis, lengths that contradict the reference.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, Field, PrivateAttr, WrapValidator

from dofkit.base.display import Displayed
from dofkit.base.wording import require_one_of
from dofkit.report import Companion
from dofkit.scene.constraints import TYPES, AnyConstraint, ConstraintBase
from dofkit.scene.constraints.base import as_equation
from dofkit.scene.fields import Listed, TaggedUnion
from dofkit.scene.hints import type_advice
from dofkit.scene.parts import Energies, Force, Mapped
from dofkit.scene.picture import Pictured

_CONSTRAINT = TaggedUnion(
    base=ConstraintBase,
    called="a constraint",
    key="type",
    allowed=TYPES,
    names="types",
    listing="the types are ",
    unknown="there is no constraint type '{}'",
    otherwise=("a constraint is a text or a mapping with a `type`", None),
    advise=type_advice,
)


_AnyConstraint = Annotated[
    AnyConstraint,
    WrapValidator(_CONSTRAINT.validated),
    BeforeValidator(as_equation, json_schema_input_type=str | AnyConstraint),
]


class Scene(Displayed, Pictured):
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

    constraints: Annotated[tuple[_AnyConstraint, ...], Listed] = Field(
        (), description="mappings with a `type`; a plain text is an equation"
    )
    forces: Annotated[tuple[Force, ...], Listed] = Field(
        (), description="springs, dampers and other forces, which are not constraints"
    )
    energies: Energies | None = Field(None, description="energies, for the equations of motion")
    expect: Annotated[dict[str, Any], Mapped] = Field(
        default_factory=dict, description="what the report must say, by report key"
    )

    _kept: Companion = PrivateAttr(default_factory=Companion)


def without(scene: Scene, names: Sequence[str]) -> Scene:
    """Return the scene without the constraints ``names``; the others keep their names, also those by position.

    The result expects nothing. Raises ArgumentError, with the nearest name, if a name is not a constraint's.

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
