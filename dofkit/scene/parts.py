"""The parts of a scene other than constraints: points, particles, bodies, forces, energies."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, WrapValidator

from dofkit.scene.fields import (
    Listed,
    Number,
    Text,
    Value,
    Vector,
    WrittenModel,
    as_written,
    exact,
    fault_at,
    fault_error,
    named,
    untagged,
)


class BodyPoint(WrittenModel):
    """The material point of a body that is at a given world position in the reference configuration."""

    on: str = Field(description="the body's name")
    at: Vector = Field(description="the world position of the point in the reference configuration")

    @classmethod
    def called(cls) -> str:
        return "a point of a body"


def _point_kind(value: object) -> str:
    if isinstance(value, str):
        return "name"
    return "material" if isinstance(value, (dict, Mapping, BodyPoint)) else "place"


#: A particle's name, a point fixed in the world, or a material point of a body.
Point = Annotated[
    Annotated[str, Tag("name")] | Annotated[Vector, Tag("place")] | Annotated[BodyPoint, Tag("material")],
    Discriminator(_point_kind),
    WrapValidator(untagged),
]


def _shape(value: object) -> str:
    return "several" if isinstance(value, (list, tuple)) else "one"


#: One value, or a list of them, or a list of lists.
_Entry = Annotated[
    Annotated[Value, Tag("one")] | Annotated[Vector, Tag("several")], Discriminator(_shape), WrapValidator(untagged)
]
Values = Annotated[
    Annotated[Value, Tag("one")] | Annotated[tuple[_Entry, ...], Tag("several")],
    Discriminator(_shape),
    WrapValidator(untagged),
]


def show_point(point: str | Vector | BodyPoint) -> str:
    """Return a point as a person reads it: ``A``, ``(0, 1)``, ``crank at (0, 1)``."""
    if isinstance(point, str):
        return point
    return f"{point.on} at {show_vector(point.at)}" if isinstance(point, BodyPoint) else show_vector(point)


def show_vector(vector: Vector) -> str:
    """Return a vector as text, ``(2, 1/2)``; a longer decimal with six significant digits."""
    return "(" + ", ".join(_shortened(as_written(value)) for value in vector) + ")"


def _shortened(number: str) -> str:
    """Return a decimal of more than six decimals with six significant digits, and any other text as it is.

    >>> _shortened("-0.999999999996"), _shortened("0.70710678"), _shortened("123456789"), _shortened("sqrt(2)/2")
    ('-1', '0.707107', '123456789', 'sqrt(2)/2')
    """
    long_decimal = re.fullmatch(r"-?\d*\.\d{7,}", number)
    return f"{float(number):.6g}" if long_decimal else number


class Particle(WrittenModel):
    """A point mass with d coordinates."""

    name: str = Field(description="its name; its coordinates are x_NAME, y_NAME, z_NAME (_ for a hyphen)")
    coordinates: tuple[str, ...] | None = Field(None, description="other names for its coordinates, in order")
    at: Vector | None = Field(None, description="its position in the reference configuration")
    mass: Value | None = Field(None, description="its mass, which is not a constraint")


class Body(WrittenModel):
    """A rigid body with d(d+1)/2 coordinates: its origin, then its angle or z-x-z Euler angles."""

    name: str = Field(description="its name; its coordinates are x_NAME, y_NAME, theta_NAME, ... (_ for a hyphen)")
    coordinates: tuple[str, ...] | None = Field(None, description="other names for its coordinates, in order")
    mass: Value | None = Field(None, description="its mass, which is not a constraint")
    inertia: Values | None = Field(None, description="its moment of inertia, or principal moments, or matrix rows")


#: A particle or a body as written: a plain name will do.
AnyParticle = Annotated[Particle, BeforeValidator(named, json_schema_input_type=str | Particle)]
AnyBody = Annotated[Body, BeforeValidator(named, json_schema_input_type=str | Body)]

Ends = tuple[Point, Point]
#: An empty YAML value (``expect:`` and nothing after it) as an empty mapping.
Mapped = BeforeValidator(lambda value: {} if value is None else value)


class Force(WrittenModel):
    """A force: it enters the equations of motion and removes no freedom."""

    type: Literal["spring", "damper", "force", "gravity"] = Field(description="the kind of force")
    name: str | None = Field(None, description="its name; by default f1, f2, ... by position")
    between: Ends | None = Field(None, description="the two points, or bodies, that it acts between")
    point: Point | None = Field(None, description="the point that it acts at")
    body: str | None = Field(None, description="the body that it acts on")
    stiffness: Value | None = Field(None, description="of a spring: force per unit of extension")
    rest_length: Value | None = Field(None, description="of a spring: its length without load")
    damping: Value | None = Field(None, description="of a damper: force per unit of speed")
    value: Values | None = Field(None, description="of a force: its size, or its components")
    acceleration: Values | None = Field(None, description="of gravity: its size, or its components")
    direction: Vector | None = Field(None, description="of a force or gravity")
    notes: str | None = Field(None, description="what is remarkable about it")

    @property
    def reason(self) -> str:
        """The reason why the force is not a constraint."""
        return (
            _REASONS[self.type]
            + " It enters the equations of motion and does not reduce the number of degrees of freedom."
        )


_REASONS = {
    "spring": "A spring pulls back when stretched but allows every distance between its ends, so it is no constraint.",
    "damper": "A damper resists the velocity but allows every position and every velocity, so it is no constraint.",
    "force": "An applied force changes the acceleration, not which positions can be taken, so it is no constraint.",
    "gravity": "Gravity acts on the masses and allows every position, so it is no constraint.",
}


class Energies(WrittenModel):
    """The energies of the system, for its equations of motion."""

    @classmethod
    def called(cls) -> str:
        return "the energies"

    kinetic: Text | None = Field(None, description="kinetic energy T in the coordinates and their velocities")
    potential: Text | None = Field(None, description="potential energy V")
    dissipation: Text | None = Field(None, description="Rayleigh's dissipation function")
    forces: Annotated[dict[str, Text], Mapped] = Field(
        default_factory=dict, description="non-conservative generalized forces by coordinate"
    )


def texts_of(value: Any) -> list[str]:
    """Return every text inside a value, which may be nested in tuples, mappings and points."""
    if isinstance(value, str):
        return [value]
    if isinstance(value, BodyPoint):
        return texts_of(value.at)
    if isinstance(value, Mapping):
        return [text for part in value.values() for text in texts_of(part)]
    if isinstance(value, tuple):
        return [text for part in value for text in texts_of(part)]
    return []


def _parameters(value: object) -> object:
    """Return {name: value}, with `real` for names without a value."""
    if value is None:
        return {}
    if isinstance(value, str):
        value = [value]
    if isinstance(value, (list, tuple)):
        seen: set[str] = set()
        for i, name in enumerate(value):
            if not isinstance(name, str):
                hint = "write `parameters: {NAME: VALUE}` to give values"
                raise fault_at((i,), "a list of parameters contains names only", hint)
            if name in seen:
                raise fault_at((i,), f"the parameter '{name}' is given twice", "leave one of them out")
            seen.add(name)
        return dict.fromkeys(value, "real")
    if isinstance(value, Mapping):
        return {name: "real" if entry is None else entry for name, entry in value.items()}
    return value


def _functions(value: object) -> object:
    """Return the mapping {name: arguments}; a single argument may be written without a list."""
    if value is None:
        return {}
    if isinstance(value, Mapping):
        return {name: (entry,) if isinstance(entry, str) else entry for name, entry in value.items()}
    return value


def _dimension(value: object) -> object:
    number = exact(value)
    if number not in (1, 2, 3):
        raise fault_error(f"the dimension is 1, 2 or 3, not {value}")
    return int(number)


def _tolerance(value: object) -> object:
    number = exact(value)
    if not 0 <= number < 1:
        raise fault_error(f"the tolerance is a fraction of the scene's size, from 0 up to 1, not {value}")
    return number


class Declarations(WrittenModel):
    """What a scene declares: its names, and the reference values of its coordinates."""

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
    tolerance: Annotated[Number, BeforeValidator(_tolerance)] | None = Field(
        None, description="measured geometry: right to within this fraction of the scene's size; absent: exact"
    )
    configuration: Annotated[dict[str, Value], Mapped] = Field(
        default_factory=dict, description="a reference configuration: coordinate -> value"
    )

    @classmethod
    def called(cls) -> str:
        return "a scene"
