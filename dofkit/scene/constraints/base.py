"""The base class of all constraint types, and the types given by texts: equations, surfaces and curves."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Annotated, ClassVar, Literal, NamedTuple, get_args

from pydantic import BeforeValidator, Field

from dofkit.base.documents import package_table
from dofkit.base.errors import NoValueError
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.tree import MINUS_ONE, ONE, Expr, coordinate, mul, power
from dofkit.expressions.vectors import Vec, minus, square
from dofkit.scene.fields import Text, WrittenModel
from dofkit.scene.frames import Placed
from dofkit.scene.ledger import FINITE
from dofkit.scene.names import within_member
from dofkit.scene.parts import Point, show_point
from dofkit.scene.symbols import Symbol
from dofkit.scene.world import World
from dofkit.system import Relation, TypeFacts

LETTERS = ("x", "y", "z")
#: The fields of constraints that are texts, or tuples of them.
_TEXTS = ("text", "surface", "curve", "length", "drive")


class TypeWords(NamedTuple):
    """How a type is written: its row of ``words.yaml``."""

    examples: Mapping[int, Sequence[str]]
    synonyms: Sequence[str] = ()
    understood: Sequence[str] = ()
    keys: Mapping[str, str] = {}


class ConstraintBase(WrittenModel):
    """A constraint: its fields, and the scalar relations that it yields."""

    name: str | None = Field(None, description="its name; by default c1, c2, ... by position")

    #: The dimensions of a scene in which the type is defined.
    dimensions: ClassVar[tuple[int, ...]] = (1, 2, 3)
    #: The properties of the type, which other packages use instead of its name.
    facts: ClassVar[TypeFacts] = TypeFacts()
    #: How the type is drawn.
    symbol: ClassVar[Symbol]

    @classmethod
    def kind(cls) -> str:
        """Return the constraint's ``type``, as it is written in a scene."""
        return _kind(cls)

    @classmethod
    def called(cls) -> str:
        return f"a constraint of type '{cls.kind()}'"

    @classmethod
    def words(cls) -> TypeWords:
        """Return how it is written."""
        return _words()[cls.kind()]

    @classmethod
    def example(cls, dimension: int) -> Sequence[str]:
        """Return a line that would work in a scene of that dimension, or else in another, and the joints it names."""
        examples = cls.words().examples
        return examples.get(dimension) or examples[max(examples)]

    def relations(self, world: World) -> Iterable[Relation]:
        """Yield the scalar relations of the constraint; faults are recorded in ``world``."""
        raise NotImplementedError

    def notes(self, world: World) -> Iterator[str]:
        """Yield sentences about this constraint for the report."""
        del world
        yield from ()

    def texts(self) -> Iterator[str]:
        """Yield the formulas of the constraint that may mention coordinates."""
        for key in _TEXTS:
            value = getattr(self, key, None)
            yield from (value,) if isinstance(value, str) else value if isinstance(value, tuple) else ()

    @property
    def in_words(self) -> str:
        """The constraint in one line for a person to read."""
        return self.kind()


@cache
def _words() -> Mapping[str, TypeWords]:
    return {
        kind: TypeWords(**{**row, "examples": {int(dimension): lines for dimension, lines in row["examples"].items()}})
        for kind, row in package_table(__package__, "words.yaml").items()
    }


@cache
def _kind(cls: type[ConstraintBase]) -> str:
    return str(get_args(cls.model_fields["type"].annotation)[0])


def component_relations(vector: Vec, label: str = "{}", about: Vec = ()) -> Iterator[Relation]:
    """Yield a relation v = 0 for each component v of ``vector``, named ``x``, ``y``, ``z`` within ``label``."""
    for letter, part in zip("xyz", vector, strict=False):
        yield Relation(part, part=label.format(letter), vector=about)


def meet(world: World, first: Placed, second: Placed, *where: str | int) -> None:
    """Record a fault if two points that must coincide are apart in the reference configuration."""
    if first.reference is None or second.reference is None:
        return
    offset = minus(second.reference, first.reference)
    if not world.any_differs(offset):
        return
    places = f"{figures(first.reference)} and {figures(second.reference)}"
    message = f"in the reference configuration {first.label} and {second.label} are apart, at {places}"
    hint = "give them the same position, or set `tolerance` if it is measured"
    world.misfit(root(square(offset)), message, *where, hint=hint)


def figures(position: Vec | None) -> str:
    """Return a position as text, such as (1, 2.5); unknown components as `?`."""
    components = [approximate(part) for part in position or ()]
    return "(" + ", ".join("?" if part is None else f"{part:.6g}" for part in components) + ")"


def root(squared: Expr) -> float | None:
    """Return the square root as a float; None if ``squared`` is not a number or is negative."""
    value = approximate(squared)
    return None if value is None or value < 0 else float(value**0.5)


class Equation(ConstraintBase):
    """``left = right`` gives left - right = 0; ``left <= right`` gives right - left >= 0.

    A chain ``0 <= x <= L`` gives two relations. The text may contain velocities, differentials and time,
    and second derivatives if it can be integrated once.
    """

    type: Literal["equation"] = Field(default="equation", description="an equation or inequality as text")
    text: Text = Field(description="the equation, such as `x^2 + y^2 = l^2` or `dy = R cos(theta) dphi`")
    facts: ClassVar[TypeFacts] = TypeFacts(written=True, surface=True)
    symbol: ClassVar[Symbol] = Symbol(run="locus")

    def relations(self, world: World) -> Iterator[Relation]:
        yield from world.equations(self.text, "text")

    @property
    def in_words(self) -> str:
        return self.text


def as_equation(value: object) -> object:
    """Return a constraint that is a plain text as the mapping of an equation, any other value unchanged."""
    return {"type": Equation.kind(), "text": value} if isinstance(value, str) else value


def _texts(value: object) -> object:
    return (value,) if isinstance(value, str) else value


def with_values(relation: Relation, values: Mapping[Expr, Expr], part: str = "") -> Relation:
    """Return ``relation``, and its domain, with ``values`` substituted for its letters and named ``part``."""
    domain = tuple((substitute(e, values), required) for e, required in relation.domain)
    return Relation(substitute(relation.expr, values), relation.sense, part, domain=domain)


class On(ConstraintBase):
    """Every member lies on a surface g(x, y, z) = 0, or on a curve g1 = g2 = 0: one relation per member and text.

    ``x``, ``y``, ``z`` stand for each member's coordinates in turn; an inequality keeps the members on one side.
    """

    type: Literal["on"] = Field(description="points on a surface or a curve")
    members: tuple[Point, ...] = Field(min_length=1, description="particles or points")
    surface: Text | None = Field(None, description="one equation in x, y, z")
    curve: Annotated[
        tuple[Text, ...] | None, Field(min_length=1), BeforeValidator(_texts, json_schema_input_type=str | list[str])
    ] = Field(None, description="equations in x, y, z: a curve in space is where two surfaces meet")
    facts: ClassVar[TypeFacts] = TypeFacts(written=True, lettered=True, surface=True, shared=True)
    symbol: ClassVar[Symbol] = Symbol(run="locus")

    def _places(self) -> Iterator[tuple[str, tuple[str | int, ...]]]:
        """Yield each text with the keys of its location in the constraint."""
        if self.surface is not None:
            yield self.surface, ("surface",)
        for i, text in enumerate(self.curve or ()):
            yield text, ("curve", i)

    def relations(self, world: World) -> Iterator[Relation]:
        if (self.surface is None) == (self.curve is None):
            hint = "`surface` is one text, `curve` a list of texts"
            world.fault(
                "one of `surface` and `curve` is needed, and not both",
                *(() if self.curve is None else ("curve",)),
                hint=hint,
            )
        letters = LETTERS[: world.dimension]
        names = within_member(world.names, letters)
        read = [
            value
            for text, where in self._places()
            for value in world.relations(text, *where, names=names, allow=FINITE)
        ]
        for i, member in enumerate(self.members):
            point = world.point(member, "members", i)
            position = {coordinate(letter): part for letter, part in zip(letters, _position(point), strict=True)}
            for j, relation in enumerate(read):
                part = f"at {show_point(member)}" + (f", text {j + 1}" if len(read) > 1 else "")
                try:
                    yield with_values(relation, position, part)
                except NoValueError:
                    world.fault(f"the text has no value at {show_point(member)}", "members", i)
                    return

    def notes(self, world: World) -> Iterator[str]:
        if world.dimension != 3 or self.curve is None:
            return
        if len(self.curve) == 2:
            yield (
                "A curve in space is where two surfaces meet, so k = 2 for each point on it: "
                "one equation alone would leave a surface."
            )
        elif len(self.curve) == 1:
            yield "One equation in space leaves a surface: a curve is where two surfaces meet, and needs two equations."

    @property
    def in_words(self) -> str:
        members = ", ".join(show_point(member) for member in self.members)
        return f"{members} on {'; '.join(self.texts())}"


def _position(point: Placed) -> tuple[Expr, ...]:
    if point.under == ONE:
        return point.over
    inverse = power(point.under, MINUS_ONE)
    return tuple(mul(part, inverse) for part in point.over)
