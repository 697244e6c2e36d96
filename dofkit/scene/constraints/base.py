"""What every constraint type has in common, and checks against the drawing that several share."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, ClassVar, get_args

from pydantic import Field

from dofkit.expressions.enclosures import approximate
from dofkit.expressions.tree import Expr
from dofkit.expressions.vectors import Vec, minus, square
from dofkit.scene.fields import WrittenModel
from dofkit.scene.frames import Placed
from dofkit.scene.symbols import Symbol
from dofkit.scene.variation import NamesAtHand, Replacement, TypeVariation
from dofkit.scene.world import World
from dofkit.system import Relation, TypeFacts


class ConstraintBase(WrittenModel):
    """A constraint: its fields, and the scalar relations that it yields."""

    name: str | None = Field(None, description="its name; by default c1, c2, ... by position")

    #: The dimensions in which it is defined.
    dimensions: ClassVar[tuple[int, ...]] = (1, 2, 3)
    #: A line of a scene by its dimension (0: in any): it loads where the bodies crank and rod, the particles A, B and C
    #: and the coordinates x and y are declared.
    examples: ClassVar[Mapping[int, str]] = {}
    #: Lines of joints that the example names, by dimension.
    beside: ClassVar[Mapping[int, tuple[str, ...]]] = {}
    #: Other words for the type that are read; words that are understood, and only lead to a hint.
    synonyms: ClassVar[tuple[str, ...]] = ()
    understood: ClassVar[tuple[str, ...]] = ()
    #: Other words for its fields.
    other_keys: ClassVar[Mapping[str, str]] = {}
    #: What everyone else may know of the type.
    facts: ClassVar[TypeFacts] = TypeFacts()
    #: What of it may differ between the sheets of students.
    variation: ClassVar[TypeVariation] = TypeVariation()
    #: How the type is drawn.
    symbol: ClassVar[Symbol]

    @classmethod
    def kind(cls) -> str:
        """Its ``type``, as written."""
        return _kind(cls)

    @classmethod
    def called(cls) -> str:
        return f"a constraint of type '{cls.kind()}'"

    @classmethod
    def example(cls, dimension: int) -> str:
        """One line that would work in a scene of that dimension, or in another where it works in none of this."""
        return cls.examples.get(dimension) or cls.examples[max(cls.examples)]

    def relations(self, world: World) -> Iterable[Relation]:
        """Its scalar relations; faults go to the world."""
        raise NotImplementedError

    def notes(self, world: World) -> Iterator[str]:
        """Sentences for the report that only this type can know."""
        del world
        yield from ()

    def texts(self) -> Iterator[str]:
        """Its texts that may mention coordinates."""
        yield from ()

    def replacements(self, names: NamesAtHand) -> Iterator[Replacement]:
        """What may stand in its place on another student's sheet."""
        del names
        yield from ()

    @classmethod
    def offers(cls, names: NamesAtHand, known: Sequence[Mapping[str, Any]]) -> Iterator[Mapping[str, Any]]:
        """Constraints of the type that may be added to the ``known`` ones on another student's sheet."""
        del names, known
        yield from ()

    @classmethod
    def restated(cls, entry: Mapping[str, Any]) -> dict[str, Any]:
        """Return a faulty entry with what several wrong keys state together under the right one."""
        return dict(entry)

    def written(self) -> dict[str, Any]:
        """Its fields as they are written."""
        return self.model_dump(mode="json", exclude_none=True)

    @property
    def in_words(self) -> str:
        """One line for a person to read."""
        return self.kind()


@cache
def _kind(cls: type[ConstraintBase]) -> str:
    return str(get_args(cls.model_fields["type"].annotation)[0])


def component_relations(vector: Vec, label: str = "{}", about: Vec = ()) -> Iterator[Relation]:
    """One relation a component, named ``x``, ``y``, ``z`` within ``label``."""
    for letter, part in zip("xyz", vector, strict=False):
        yield Relation(part, part=label.format(letter), vector=about)


def meet(world: World, first: Placed, second: Placed, *where: str | int) -> None:
    """Check that two points that must coincide do so in the drawing."""
    if first.reference is None or second.reference is None:
        return
    gap = minus(second.reference, first.reference)
    if not world.any_differs(gap):
        return
    places = f"{figures(first.reference)} and {figures(second.reference)}"
    message = f"in the reference configuration {first.label} and {second.label} are apart, at {places}"
    hint = "give them the same position, or set `tolerance` if it is measured"
    world.misfit(root(square(gap)), message, *where, hint=hint)


def figures(position: Vec | None) -> str:
    """A position in figures."""
    components = [approximate(part) for part in position or ()]
    return "(" + ", ".join("?" if part is None else f"{part:.6g}" for part in components) + ")"


def root(squared: Expr) -> float | None:
    """The square root in figures, where it is a number."""
    value = approximate(squared)
    return None if value is None or value < 0 else float(value**0.5)
