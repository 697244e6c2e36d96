"""What constraints mention: values, points, bodies and directions, given or generic."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from dofkit.checker.balls import evaluated, excludes_zero
from dofkit.checker.derivatives import symbols_in
from dofkit.checker.geometry import CheckedFrame, MaterialPoint, Vector
from dofkit.checker.grammar import KnownNames, Sided, parse, parse_relations
from dofkit.checker.trees import ONE, ZERO, Effort, Tree, negative, refuse, symbol

Entry = Mapping[str, Any]


@dataclass
class Surroundings:
    """A scene as one constraint after the other sees it.

    ``names``: what texts may mention; ``signs``: of the parameters that stay symbols. ``generic`` grows by a symbol for
    each length or component that was left out; ``drawn`` by the bodies that the drawing places, ``welded`` by pairs.
    ``index``: the place of the constraint that is read, from 1; ``made``: how many symbols of a stem it made.
    """

    dimension: int
    frames: dict[str, CheckedFrame]
    names: KnownNames = field(default_factory=KnownNames)
    signs: dict[str, str] = field(default_factory=dict)
    particles: dict[str, MaterialPoint] = field(default_factory=dict)
    generic: list[str] = field(default_factory=list)
    drawn: set[str] = field(default_factory=set)
    welded: list[tuple[str, str]] = field(default_factory=list)
    index: int = 0
    made: Counter[str] = field(default_factory=Counter)

    def expression(self, value: object, *allowed: str) -> Tree:
        """A number or text that mentions parameters, and what is ``allowed`` besides."""
        found = parse(value, self.names)
        refuse(not symbols_in(found) <= {*self.signs, *allowed}, f"`{value}` mentions what cannot stand there")
        return found

    def moving(self, value: object) -> Tree:
        """A length that may change with time and place."""
        return self.expression(value, "t", *self.names.coordinates)

    def vector(self, values: Any) -> Vector:
        """A place or direction."""
        bad = not isinstance(values, list) or len(values) != self.dimension
        refuse(bad, f"{self.dimension} components are needed, not {str(values)[:60]}")
        return tuple(map(self.expression, values))

    def fresh(self, stem: str) -> Tree:
        """A new generic symbol, named by the constraint it belongs to."""
        name = f"{stem}_c{self.index}"
        self.made[name] += 1
        self.generic.append(name if self.made[name] == 1 else f"{name}_{self.made[name]}")
        return symbol(self.generic[-1])

    def place(self, values: object) -> Vector:
        """A given place, or a generic one."""
        return self.vector(values) if values is not None else tuple(self.fresh("place") for _ in range(self.dimension))

    def point(self, written: Any) -> MaterialPoint:
        """A particle, a point of the world, or a point of a body."""
        if isinstance(written, Mapping):
            known_fields(written, "on at")
            self.drawn.add(written["on"])
            return self.frames[written["on"]].point(self.vector(written["at"]))
        if isinstance(written, list):
            return self.frames["ground"].point(self.vector(written))
        return self.particles[str(written)]

    def direction(self, values: object) -> tuple[Vector, tuple[Vector, ...]]:
        """A direction n, given or generic, and d - 1 independent vectors across it."""
        every = range(self.dimension)
        n = self.vector(values) if values is not None else (ONE, *(self.fresh("axis") for _ in every[1:]))
        sure = [i for i in every if self.nonzero(n[i])]
        doubtful = not sure and (self.dimension == 3 or not any(map(symbols_in, n)))
        refuse(doubtful, "no component of a direction is surely not 0")
        k = min(sure, key=lambda i: n[i].head != "number", default=0)
        rows = [{i: n[k], k: negative(n[i])} for i in every if i != k]
        return n, tuple(tuple(row.get(j, ZERO) for j in every) for row in rows)

    def nonzero(self, tree: Tree) -> bool:
        """Is a constant certainly not 0?"""
        if tree.head == "symbol":
            return self.signs.get(str(tree.value)) in ("positive", "nonzero")
        if tree.head in ("product", "power") and symbols_in(tree):
            return all(map(self.nonzero, tree.below[: 1 if tree.head == "power" else None]))
        return not symbols_in(tree) and excludes_zero(evaluated(tree, {}, Effort()))

    def on_places(self, texts: Sequence[str]) -> list[Sided]:
        """Relations in which x, y, z are the coordinates of a point; no velocity occurs."""
        refuse(not isinstance(texts, list), "a curve is a list of texts")
        letters = set("xyz"[: self.dimension])
        values = {name: tree for name, tree in self.names.values.items() if name not in letters}
        functions = {name: own for name, own in self.names.functions.items() if name not in letters}
        own = KnownNames(self.names.coordinates.union(letters), values, functions)
        found = [relation for text in texts for relation in parse_relations(text, own)]
        used = frozenset().union(*(symbols_in(one.tree) for one in found))
        refuse(not used <= own.coordinates.union(self.signs, "t"), "a surface mentions places, parameters and t")
        return found


def known_fields(entry: Entry, fields: str) -> None:
    """Refuse an entry with a field that is not known: it would be read past."""
    unknown = entry.keys() - set(fields.split())
    refuse(unknown, f"there is no {' '.join(sorted(unknown))}; known are {fields}")
