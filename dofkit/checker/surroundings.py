"""What constraints mention: values, points, bodies and directions, given or generic."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from dofkit.checker.balls import evaluated, excludes_zero
from dofkit.checker.bodies import CheckedFrame, MaterialPoint, Vector, difference, identity
from dofkit.checker.derivatives import symbols_in
from dofkit.checker.document import value_text
from dofkit.checker.effort import Effort
from dofkit.checker.errors import CheckError
from dofkit.checker.grammar import parse
from dofkit.checker.trees import ONE, Tree, negative, number, symbol, times
from dofkit.checker.words import KnownNames

Entry = Mapping[str, Any]


@dataclass
class Surroundings:
    """A scene as one constraint after the other sees it.

    ``names``: what texts may mention; ``signs``: of the parameters that stay symbols. ``generic`` grows by a symbol for
    each length or component that was left out; ``drawn`` by the bodies that the drawing places, ``welded`` by pairs.
    ``index``: the place of the constraint that is read, from 1; ``made``: how many symbols of a stem it made.
    """

    dimension: int
    names: KnownNames
    signs: Mapping[str, str]
    frames: dict[str, CheckedFrame]
    particles: dict[str, MaterialPoint] = field(default_factory=dict)
    generic: list[str] = field(default_factory=list)
    drawn: set[str] = field(default_factory=set)
    welded: list[tuple[str, str]] = field(default_factory=list)
    index: int = 0
    made: Counter[tuple[str, int]] = field(default_factory=Counter)

    def expression(self, value: object, allowed: frozenset[str] = frozenset()) -> Tree:
        """A number or text that mentions parameters, and what is ``allowed`` besides."""
        exact = value_text(value)
        found = number(exact) if isinstance(exact, int) else parse(exact, self.names)
        if not symbols_in(found) <= allowed.union(self.signs):
            raise CheckError(f"`{value}` mentions what cannot stand there")
        return found

    def vector(self, values: Any) -> Vector:
        """A place or direction."""
        if not isinstance(values, list) or len(values) != self.dimension:
            raise CheckError(f"{self.dimension} components are needed, not {str(values)[:60]}")
        return tuple(map(self.expression, values))

    def fresh(self, stem: str) -> Tree:
        """A new generic symbol, named by the constraint it belongs to."""
        self.made[stem, self.index] += 1
        count = self.made[stem, self.index]
        self.generic.append(f"{stem}_c{self.index}" + (f"_{count}" if count > 1 else ""))
        return symbol(self.generic[-1])

    def place(self, values: object) -> Vector:
        """A given place, or a generic one."""
        return self.vector(values) if values is not None else tuple(self.fresh("place") for _ in range(self.dimension))

    def frame(self, name: str) -> CheckedFrame:
        """A body, or the ground."""
        if name not in self.frames:
            raise CheckError(f"there is no body '{name}'")
        return self.frames[name]

    def point(self, written: Any) -> MaterialPoint:
        """A particle, a point of the world, or a point of a body."""
        if isinstance(written, Mapping):
            known_fields(written, "point", ("on", "at"))
            self.drawn.add(written["on"])
            return self.frame(written["on"]).point(self.vector(written["at"]))
        if isinstance(written, str) and written not in self.particles:
            raise CheckError(f"there is no particle '{written}'")
        return (
            self.particles[written] if isinstance(written, str) else self.frames["ground"].point(self.vector(written))
        )

    def direction(self, values: object) -> tuple[Vector, tuple[Vector, ...]]:
        """A direction n, given or generic, and d - 1 independent vectors across it."""
        d = self.dimension
        n = self.vector(values) if values is not None else (ONE, *(self.fresh("axis") for _ in range(d - 1)))
        pivots = [i for i, part in enumerate(n) if self.nonzero(part)]
        if not pivots and (d == 3 or not any(map(symbols_in, n))):
            raise CheckError("no component of a direction is surely not 0")
        if d == 2:
            return n, ((negative(n[1]), n[0]),)
        k = min(pivots, key=lambda i: n[i].head != "number")
        units = identity(d)
        others = [i for i in range(d) if i != k]
        return n, tuple(
            tuple(difference(times(n[k], units[i][j]), times(n[i], units[k][j])) for j in range(d)) for i in others
        )

    def nonzero(self, tree: Tree) -> bool:
        """Is a constant certainly not 0?"""
        if tree.head == "symbol":
            return self.signs.get(str(tree.value)) in ("positive", "nonzero")
        if tree.head in ("product", "power") and symbols_in(tree):
            return all(map(self.nonzero, tree.below[: 1 if tree.head == "power" else None]))
        return not symbols_in(tree) and excludes_zero(evaluated(tree, {}, Effort()))


def known_fields(entry: Entry, called: str, fields: tuple[str, ...]) -> None:
    """Refuse an entry with a field that is not known: it would be read past."""
    unknown = [key for key in entry if key not in fields and entry[key] is not None]
    if unknown:
        raise CheckError(f"a {called} has no `{unknown[0]}`")
