"""The `picture` of a scene: shapes whose places are expressions in coordinates, parameters and time.

No answer depends on a shape. A shape with the name of a constraint, a particle or a body is drawn instead of that
entry's symbol; with ``show: false`` nothing is drawn for the entry.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Annotated, Any, NamedTuple

from pydantic import BeforeValidator, ConfigDict, Field, ValidationError, model_serializer, model_validator
from pydantic_core import InitErrorDetails

from dofkit.base.documents import package_table
from dofkit.base.errors import Fault
from dofkit.expressions.tree import ONE, ZERO, Expr, parameter
from dofkit.expressions.vectors import Vec
from dofkit.scene.fields import Listed, Value, Vector, WrittenModel, as_written, fault_at, fault_error, suggestion
from dofkit.scene.ledger import FINITE, ParsedTexts, Texts
from dofkit.scene.names import Vocabulary
from dofkit.scene.parts import Declarations, Values


class ShapeKeys(NamedTuple):
    """A kind of shape: its required keys (``needs``), its optional keys (``may``), an example, a description."""

    needs: tuple[str, ...]
    may: tuple[str, ...]
    example: str
    meaning: str


@cache
def shape_kinds() -> Mapping[str, ShapeKeys]:
    """Return {kind of shape: its keys}, in the order of shapes.yaml."""
    return {
        kind: ShapeKeys(tuple(row["needs"]), tuple(row.get("may", ())), row["example"], row["meaning"])
        for kind, row in package_table(__package__, "shapes.yaml").items()
    }


_KEYS = ("at", "from", "to", "through", "heading", "axis", "turn", "radius", "size", "range", "show")
_LETTERS = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
QUOTED = 'at: ["atan2(y, x)", 0]'
UP_IN_PLANE, UP = (ZERO, ONE), (ZERO, ZERO, ONE)


def _axis(value: object) -> object:
    """Return ``x``, ``y`` or ``z`` as a direction in space, any other value unchanged."""
    return _LETTERS.get(value, value) if isinstance(value, str) else value


class PictureShape(WrittenModel):
    """A shape of a picture, ``{SHAPE: NAME, ...}``; the name is printed next to the shape."""

    model_config = ConfigDict(populate_by_name=True)

    shape: str = Field(description="one of the shapes, as a key")
    name: str = Field("", description="its name, the value of that key; it stands beside the shape")
    at: Vector | None = Field(None, description="where it is: its centre, or a place in the parameters of `range`")
    start: Vector | None = Field(None, alias="from", description="where it begins")
    to: Vector | None = Field(None, description="where it ends")
    through: tuple[Vector, ...] | None = Field(None, description="places that it joins", min_length=2)
    axis: Annotated[Vector, BeforeValidator(_axis)] | None = Field(None, description="the direction across it")
    heading: Value | None = Field(None, description="the angle, from the x axis, of the direction that it points to")
    turn: Value | None = Field(None, description="the angle by which it is turned about its own axis")
    radius: Value | None = Field(None, description="its radius")
    size: Values | None = Field(None, description="its length, or its sides")
    range: dict[str, Annotated[tuple[Value, ...], Field(min_length=2, max_length=2)]] | None = Field(
        None, description="parameter -> [from, to]"
    )
    show: bool = Field(True, description="false: nothing is drawn under this name")

    @classmethod
    def called(cls) -> str:
        return "a shape"

    @model_validator(mode="before")
    @classmethod
    def _with_kind(cls, value: Any) -> Any:
        """Return ``{SHAPE: NAME, ...}`` as ``{shape: SHAPE, name: NAME, ...}``. Raises a fault for wrong keys."""
        if not isinstance(value, Mapping):
            raise fault_error("a shape is a mapping such as " + shape_kinds()["point"].example)
        kinds = [key for key in value if key in shape_kinds()]
        if not kinds:
            other = next((key for key in value if key not in _KEYS), None)
            hint = suggestion(other, list(shape_kinds()), "shapes")
            if other is None:
                raise fault_error("a shape begins with its kind, as in " + shape_kinds()["point"].example, hint)
            raise fault_at((other,), f"unknown key '{other}' in a shape", hint)
        if len(kinds) > 1:
            hint = "write each as an entry of its own"
            raise fault_at((kinds[1],), f"one entry is a {kinds[0]} and a {kinds[1]}", hint)
        kind = kinds[0]
        details = list(_key_faults(kind, [key for key in value if key != kind], value.get("show") is False))
        if details:
            raise ValidationError.from_exception_data("scene", details)
        name = value[kind]
        return {"shape": kind, "name": "" if name is None else str(name)} | {
            k: v for k, v in value.items() if k != kind
        }

    @model_serializer
    def _written(self) -> dict[str, Any]:
        pairs = {key: getattr(self, "start" if key == "from" else key) for key in _KEYS}
        written_keys = {key: part for key, part in pairs.items() if part is not None and (key != "show" or not part)}
        return {self.shape: self.name, **{key: _plain(part) for key, part in written_keys.items()}}


def _plain(value: Any) -> Any:
    if isinstance(value, (tuple, list)):
        return [_plain(part) for part in value]
    if isinstance(value, Mapping):
        return {key: _plain(part) for key, part in value.items()}
    return value if isinstance(value, bool) else as_written(value)


def _key_faults(kind: str, keys: Sequence[str], hidden: bool) -> list[InitErrorDetails]:
    """Return a fault for each of ``keys`` that the kind does not allow, and for each required key that is missing."""
    row = shape_kinds()[kind]
    allowed = [*row.needs, *row.may, "show"]
    faults = [
        (fault_error(f"unknown key '{key}' in a {kind}", suggestion(key, allowed, "keys")), (key,))
        for key in keys
        if key not in allowed
    ]
    missing = [] if hidden else [key for key in row.needs if key not in keys]
    faults += [(fault_error(f"a {kind} needs '{key}'", f"for example {row.example}"), (key,)) for key in missing]
    return [InitErrorDetails(type=error, loc=loc, input=None) for error, loc in faults]


class Pictured(Declarations):
    """The declarations of a scene, with its picture."""

    picture: Annotated[tuple[PictureShape, ...], Listed] = Field(
        (), description="shapes that are drawn; they change no answer"
    )


class PlacedShape(NamedTuple):
    """A shape with expressions as places; ``range``: its own parameters, each as (symbol, lower end, upper end)."""

    kind: str
    name: str
    places: tuple[Vec, ...]
    axis: Vec | None
    heading: Expr | None
    turn: Expr | None
    radius: Expr | None
    size: tuple[Expr, ...]
    range: tuple[tuple[Expr, Expr, Expr], ...]


class PlacedPicture(NamedTuple):
    """The shapes of a scene, the dimension of the picture, and the names of entries whose symbols are replaced."""

    shapes: tuple[PlacedShape, ...]
    dimension: int
    taken: frozenset[str]


def picture_of(scene: Pictured, vocabulary: Vocabulary, faults: list[Fault]) -> PlacedPicture:
    """Return the picture of a scene with its texts parsed; errors are added to ``faults``."""
    placed: list[PlacedShape] = []
    dimension: int = scene.dimension if scene.dimension > 1 and (scene.bodies or scene.particles) else 0
    for index, shape in enumerate(scene.picture):
        reader = _ShapeReader(shape, vocabulary, index, faults, dimension)
        if shape.show:
            placed.append(reader.placed())
        dimension = dimension or reader.dimension
    owners = frozenset(shape.name for shape in scene.picture if shape.name)
    return PlacedPicture(tuple(placed), dimension or 3, owners)


class _ShapeReader(Texts):
    """Reads the texts of one shape with the scene's names and the parameters of the shape's range."""

    def __init__(
        self, shape: PictureShape, vocabulary: Vocabulary, index: int, faults: list[Fault], dimension: int
    ) -> None:
        super().__init__(vocabulary.texts, ("picture", index), faults)
        self.shape, self.dimension = shape, dimension
        self.ends = {
            name: tuple(self.expression(end, "range", name, k) for k, end in enumerate(ends))
            for name, ends in (shape.range or {}).items()
        }
        if self.ends:
            names = vocabulary.names
            range_symbols = {name: parameter(name) for name in self.ends}
            extended = replace(
                names,
                coordinates=names.coordinates - range_symbols.keys(),
                parameters={**names.parameters, **range_symbols},
            )
            self._reader = ParsedTexts(extended)

    def placed(self) -> PlacedShape:
        """Return the shape with its texts parsed."""
        shape = self.shape
        ends = [(key, place) for key, place in (("from", shape.start), ("to", shape.to), ("at", shape.at)) if place]
        places = [self._place(place, key) for key, place in ends]
        places += [self._place(place, "through", k) for k, place in enumerate(shape.through or ())]
        size = shape.size if isinstance(shape.size, tuple) else () if shape.size is None else (shape.size,)
        return PlacedShape(
            shape.shape,
            shape.name,
            tuple(places),
            None if shape.axis is None else self._place(shape.axis, "axis"),
            self._scalar("heading"),
            self._scalar("turn"),
            self._scalar("radius"),
            tuple(self.expression(part, "size") for part in size if not isinstance(part, tuple)),
            tuple((parameter(name), low, high) for name, (low, high) in self.ends.items()),
        )

    def _scalar(self, key: str) -> Expr | None:
        value = getattr(self.shape, key)
        return None if value is None else self.expression(value, key)

    def _place(self, values: Vector, *where: str | int) -> Vec:
        """Return a place or direction; a fault if its dimension, 2 or 3, differs from that of the places before."""
        texts = [value for value in values if isinstance(value, str)]
        if any(text.count("(") > text.count(")") for text in texts):
            self.fault("a comma ends an entry of a place", *where, hint=f"quote a text that has one: {QUOTED}")
            return tuple(ZERO for _ in values)
        if len(values) not in ((self.dimension,) if self.dimension else (2, 3)):
            needed = f"{self.dimension} components in this picture" if self.dimension else "2 or 3 components"
            hint = "a picture is in the plane or in space: give all its places two components, or all three"
            self.fault(f"a place has {needed}, not {len(values)}", *where, hint=hint)
        else:
            self.dimension = len(values)
        return tuple(self.expression(value, *where, k, allow=FINITE) for k, value in enumerate(values))
