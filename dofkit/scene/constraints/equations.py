"""Constraints given by texts: an equation, and points on a surface or a curve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import BeforeValidator, Field

from dofkit.base.errors import NoValueError
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import MINUS_ONE, ONE, Expr, coordinate, mul, power
from dofkit.scene.constraints.base import ConstraintBase
from dofkit.scene.fields import Text
from dofkit.scene.frames import Placed
from dofkit.scene.ledger import FINITE
from dofkit.scene.names import within_member
from dofkit.scene.parts import Point, show_point
from dofkit.scene.symbols import Symbol
from dofkit.scene.variation import NamesAtHand, Replacement, TypeVariation, angle_for_turning
from dofkit.scene.world import World
from dofkit.system import Relation, TypeFacts

LETTERS = ("x", "y", "z")


class Equation(ConstraintBase):
    """``left = right`` gives left - right = 0; ``left <= right`` gives right - left >= 0.

    A chain ``0 <= x <= L`` gives two relations. The text may hold velocities, differentials and time,
    and second derivatives where it integrates once.
    """

    type: Literal["equation"] = Field(default="equation", description="an equation or inequality as text")
    examples: ClassVar[Mapping[int, str]] = {0: '"x^2 + y^2 = 4"'}
    understood: ClassVar[tuple[str, ...]] = ("formula", "relation", "inequality", "pfaffian")
    text: Text = Field(description="the equation, such as `x^2 + y^2 = l^2` or `dy = R cos(theta) dphi`")
    facts: ClassVar[TypeFacts] = TypeFacts(written=True, surface=True)
    symbol: ClassVar[Symbol] = Symbol(run="locus")
    variation: ClassVar[TypeVariation] = TypeVariation(texts=("text",))

    def relations(self, world: World) -> Iterator[Relation]:
        yield from world.equations(self.text, "text")

    def texts(self) -> Iterator[str]:
        yield self.text

    def replacements(self, names: NamesAtHand) -> Iterator[Replacement]:
        """Where it turns at a steady rate: the same at rest."""
        resting = angle_for_turning(self.text, names)
        if resting is not None:
            text, rate, angle = resting
            yield Replacement("supports", {**self.written(), "text": text}, {angle: "real"}, f"{angle} for {rate} t")

    @property
    def in_words(self) -> str:
        return self.text


def as_equation(value: object) -> object:
    """A constraint as it may be written; a plain text is an equation."""
    return {"type": Equation.kind(), "text": value} if isinstance(value, str) else value


def _texts(value: object) -> object:
    return (value,) if isinstance(value, str) else value


class On(ConstraintBase):
    """Every member lies on a surface g(x, y, z) = 0, or on a curve g1 = g2 = 0: members x texts relations.

    ``x``, ``y``, ``z`` stand for each member's coordinates in turn; an inequality keeps it on one side.
    """

    type: Literal["on"] = Field(description="points on a surface or a curve")
    examples: ClassVar[Mapping[int, str]] = {
        1: "{type: on, members: [A], surface: x - 1}",
        2: "{type: on, members: [A], surface: y - x^2}",
        3: "{type: on, members: [A], surface: z - x^2 - y^2}",
    }
    understood: ClassVar[tuple[str, ...]] = ("surface", "curve", "wire", "bead")
    members: tuple[Point, ...] = Field(min_length=1, description="particles or points")
    surface: Text | None = Field(None, description="one equation in x, y, z")
    curve: Annotated[
        tuple[Text, ...] | None, Field(min_length=1), BeforeValidator(_texts, json_schema_input_type=str | list[str])
    ] = Field(None, description="equations in x, y, z: a curve in space is where two surfaces meet")
    facts: ClassVar[TypeFacts] = TypeFacts(written=True, lettered=True, surface=True, shared=True)
    symbol: ClassVar[Symbol] = Symbol(run="locus")
    variation: ClassVar[TypeVariation] = TypeVariation(places=("members",), texts=("surface", "curve"))

    def texts(self) -> Iterator[str]:
        yield from () if self.surface is None else (self.surface,)
        yield from self.curve or ()

    def _places(self) -> Iterator[tuple[str, tuple[str | int, ...]]]:
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
            stands = {coordinate(letter): part for letter, part in zip(letters, _position(point), strict=True)}
            for j, (e, sense, *_, domain) in enumerate(read):
                part = f"at {show_point(member)}" + (f", text {j + 1}" if len(read) > 1 else "")
                try:
                    value = substitute(e, stands)
                    there = tuple((substitute(u, stands), required) for u, required in domain)
                except NoValueError:
                    world.fault(f"the text has no value at {show_point(member)}", "members", i)
                    return
                yield Relation(value, sense, part, domain=there)

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
