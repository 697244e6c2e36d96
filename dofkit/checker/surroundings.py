"""What a scene declares, and what its constraints mention: names, values, points, bodies and directions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from flint import arb, fmpq

from dofkit.checker.bodies import BodyFrame, MaterialPoint, Vector, difference, identity
from dofkit.checker.derivatives import symbols_in
from dofkit.checker.document import value_text
from dofkit.checker.errors import CheckError
from dofkit.checker.grammar import parse
from dofkit.checker.trees import ONE, Tree, negative, number, symbol, times
from dofkit.checker.words import KnownNames

Entry = Mapping[str, Any]


@dataclass
class Surroundings:
    """A scene as one constraint after the other sees it.

    ``names``: what texts may mention; ``signs``: of the parameters that stay symbols. ``generic`` grows by a symbol for
    each length or component that was left out; ``drawn`` by the bodies that the drawing places. ``index``: the place of
    the constraint that is read, from 1.
    """

    dimension: int
    names: KnownNames
    signs: Mapping[str, str]
    ground: BodyFrame
    particles: dict[str, MaterialPoint] = field(default_factory=dict)
    frames: dict[str, BodyFrame] = field(default_factory=dict)
    generic: list[str] = field(default_factory=list)
    drawn: set[str] = field(default_factory=set)
    welded: list[tuple[str, str]] = field(default_factory=list)
    index: int = 0

    def expression(self, value: object, allowed: frozenset[str]) -> Tree:
        """A number or text that mentions parameters and what is ``allowed`` besides."""
        value = value_text(value)
        if isinstance(value, bool) or not isinstance(value, (int, str)):
            raise CheckError(f"a number or a text is needed, not {str(value)[:40]}")
        found = number(value) if isinstance(value, int) else parse(value, self.names)
        other = symbols_in(found) - frozenset(self.signs) - allowed
        if other:
            raise CheckError(f"`{min(other)}` cannot stand in `{value}`")
        return found

    def value(self, value: object) -> Tree:
        """A constant."""
        return self.expression(value, frozenset())

    def law(self, value: object) -> Tree:
        """A value that may depend on time."""
        return self.expression(value, frozenset("t"))

    def vector(self, values: object) -> Vector:
        """A place or direction."""
        if not isinstance(values, (list, tuple)) or len(values) != self.dimension:
            raise CheckError(f"{self.dimension} components are needed, not {str(values)[:60]}")
        return tuple(map(self.value, values))

    def fresh(self, stem: str) -> Tree:
        """A new generic symbol, named by the constraint it belongs to."""
        count = sum(name.startswith(f"{stem}_c{self.index}") for name in self.generic)
        name = f"{stem}_c{self.index}" + (f"_{count + 1}" if count else "")
        self.generic.append(name)
        return symbol(name)

    def place(self, values: object) -> Vector:
        """A given place, or a generic one."""
        if values is None:
            return tuple(self.fresh("place") for _ in range(self.dimension))
        return self.vector(values)

    def frame(self, name: object) -> BodyFrame:
        """A body, or the ground."""
        found = self.ground if name == "ground" else self.frames.get(str(name))
        if found is None:
            raise CheckError(f"there is no body '{name}'")
        return found

    def point(self, written: object) -> MaterialPoint:
        """A particle, a point of the world, or a point of a body."""
        if isinstance(written, str):
            if written not in self.particles:
                raise CheckError(f"there is no particle '{written}'")
            return self.particles[written]
        if isinstance(written, Mapping):
            if set(written) != {"on", "at"}:
                raise CheckError("a point of a body has `on` and `at`")
            frame = self.frame(written["on"])
            self.drawn.add(frame.name)
            return frame.point(self.vector(written["at"]))
        return self.ground.point(self.vector(written))

    def direction(self, values: object, stem: str = "axis") -> tuple[Vector, tuple[Vector, ...]]:
        """A direction n, given or generic, and d - 1 independent vectors across it."""
        d = self.dimension
        if values is None:
            n: Vector = (ONE, *(self.fresh(stem) for _ in range(d - 1)))
        else:
            n = self.vector(values)
        pivots = [i for i, part in enumerate(n) if self.nonzero(part)]
        if not pivots and (d != 2 or not any(map(symbols_in, n))):
            raise CheckError("no component of a direction is surely not 0")
        if d == 2:
            return n, ((negative(n[1]), n[0]),)
        pivot = min(pivots, key=lambda i: n[i].head != "number")
        units = identity(d)
        across = tuple(
            tuple(difference(times(n[pivot], e), times(n[i], f)) for e, f in zip(units[i], units[pivot], strict=True))
            for i in range(d)
            if i != pivot
        )
        return n, across

    def nonzero(self, tree: Tree) -> bool:
        """Is a constant certainly not 0?"""
        if tree.head == "symbol":
            return self.signs.get(str(tree.value)) in ("positive", "nonzero")
        if tree.head in ("product", "power", "sqrt"):
            return all(self.nonzero(part) for part in tree.below[: 1 if tree.head == "power" else None])
        found = ball(tree)
        return found is not None and not found.contains(0)


def ball(tree: Tree) -> arb | None:
    """A ball that holds the value of a constant; None where it holds symbols or functions that are not known."""
    if isinstance(tree.value, Fraction):
        return arb(fmpq(tree.value.numerator, tree.value.denominator))
    if tree.head == "pi":
        return arb.pi()
    below = [ball(part) for part in tree.below]
    parts = [part for part in below if part is not None]
    if not parts or len(parts) < len(below):
        return None
    if tree.head == "sum":
        return sum(parts[1:], parts[0])
    if tree.head == "product":
        found = parts[0]
        for part in parts[1:]:
            found = found * part
        return found
    if tree.head == "power":
        return parts[0] ** parts[1]
    named = getattr(parts[0], tree.head, None) if len(parts) == 1 and tree.head != "apply" else None
    return named() if named else None


def fields_of(entry: Entry, kind: str, fields: Sequence[str]) -> None:
    """Refuse a constraint with a field that its type does not have."""
    unknown = {key for key in entry if entry[key] is not None} - {"type", "name", *fields}
    if unknown:
        raise CheckError(f"a constraint of type {kind} has no `{min(unknown)}`")
