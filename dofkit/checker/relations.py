"""The relations of a scene and of a certificate's steps, and what follows from what."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from functools import cached_property
from typing import Any

from flint import arb

from dofkit.checker.balls import evaluated, excludes_zero
from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.effort import Effort
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.points import CheckedPoint
from dofkit.checker.problem import Problem
from dofkit.checker.steps import Consequence, DerivedRelation, made_by
from dofkit.checker.texts import CheckedTexts, has_value_everywhere
from dofkit.checker.trees import Tree, add, negative, symbol, times

#: What a certificate of another form, or a hostile one, may raise.
FAULTS = (CheckError, KeyError, TypeError, ValueError, AttributeError, IndexError, ArithmeticError, RecursionError)


class CheckedRelations(CheckedTexts):
    """The relations of the scene and of the steps, each step looked at once."""

    def __init__(self, problem: Problem, parts: Mapping[str, list[dict[str, Any]]], effort: Effort) -> None:
        super().__init__(problem, effort)
        self.parts = parts
        self.known = {one.name: DerivedRelation(one.name, one.kind, one.left) for one in problem.relations}
        refuse(len(self.known) < len(problem.relations), "two relations of the scene have one name")
        self.consequences: list[Consequence] = []
        self.faults: dict[str, str] = {}
        self.met: dict[tuple[int, str], bool] = {}
        self.slopes: dict[tuple[str, str], Tree] = {}
        self.linear: dict[str, bool] = {}
        self.taken: set[str] = set()
        self._take_steps()

    def _take_steps(self) -> None:
        for step in self.parts["relations"]:
            name = str(step.get("id"))
            try:
                if not isinstance(step.get("id"), str) or name in self.known:
                    raise CheckError(f"a step has no name of its own: {name[:40]!r}")
                relations, consequences = made_by(step, self)
                if clash := [one.name for one in relations if one.name in self.known]:
                    raise CheckError(f"the name `{clash[0]}` is taken")
                self.known.update({one.name: one for one in relations})
                self.consequences += consequences
            except FAULTS as error:
                self.faults[name] = f"step `{name[:60]}`: {told(error)}"

    @cached_property
    def finite(self) -> tuple[str, ...]:
        """The finite relations of the scene."""
        return tuple(one.name for one in self.problem.relations if one.kind == "finite")

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """The velocity relations of the scene."""
        return tuple(one.name for one in self.problem.relations if one.kind == "velocity")

    @cached_property
    def timed(self) -> bool:
        """Whether time or dt occurs in an equation."""
        return any(not {"t", "tdot"}.isdisjoint(symbols_in(self.known[n].left)) for n in (*self.finite, *self.moving))

    def owned(self, owner: str, kinds: Collection[str] = ("finite", "velocity")) -> tuple[str, ...]:
        """The relations of a constraint."""
        return tuple(one.name for one in self.problem.relations if one.owner == owner and one.kind in kinds)

    def relation(self, name: Any) -> DerivedRelation:
        """A relation by its id."""
        if not isinstance(name, str) or name not in self.known:
            raise CheckError(self.faults.get(str(name).partition(".")[0], f"no relation `{str(name)[:60]}`"))
        return self.known[name]

    @cached_property
    def index(self) -> dict[str, dict[str, dict[str, Any]]]:
        """The entries of every part by their ids."""
        return {part: {str(one.get("id")): one for one in entries} for part, entries in self.parts.items()}

    def named(self, part: str, name: Any) -> dict[str, Any]:
        """A point, minor, field or cover by its id."""
        if not isinstance(name, str) or name not in self.index[part]:
            raise CheckError(f"no such entry of `{part}`: {str(name)[:60]!r}")
        return self.index[part][name]

    def closure(self, start: Iterable[str], point: CheckedPoint | None) -> set[str]:
        """All that holds near a point (or, without one, everywhere) where ``start`` does, by the steps."""
        found, grew = set(start), True
        while grew:
            grew = False
            for i, one in enumerate(self.consequences):
                if one.target not in found and found.issuperset(one.sources) and self._met(i, point):
                    found.add(one.target)
                    grew = True
            self.effort.spend(len(self.consequences) + 1)
        return found

    def _met(self, place: int, point: CheckedPoint | None) -> bool:
        one = self.consequences[place]
        if point is None or one.at not in ("", point.name):
            return (
                point is None
                and not one.at
                and not one.nonzero
                and all(has_value_everywhere(tree) for tree in one.defined)
            )
        key = (place, point.name)
        if key not in self.met:
            try:
                self.met[key] = all(excludes_zero(point.value(tree)) for tree in one.nonzero) and all(
                    self._has_value(tree, point) for tree in one.defined
                )
            except CheckError:
                if self.effort.left < 0:
                    raise
                self.met[key] = False
        return self.met[key]

    def _has_value(self, tree: Tree, point: CheckedPoint) -> bool:
        """Whether a tree is defined at the point, and with whatever velocities, where it has none."""
        wide = {name: arb(0, 10**30) for name in self.velocities if not point.has(name)}
        evaluated(point.prepared(tree), {**wide, **point.balls}, self.effort)
        return True

    def is_linear(self, name: str) -> bool:
        """Whether a relation is finite, or a linear form in the velocities (dt included)."""
        if name not in self.linear:
            self.linear[name] = self.relation(name).kind != "velocity" or self._is_form(self.relation(name).left)
        return self.linear[name]

    def _is_form(self, left: Tree) -> bool:
        slopes = [(v, derivative(left, v)) for v in sorted(self.velocities & symbols_in(left))]
        if any(self.has_velocities(slope) for _, slope in slopes):
            return False
        return self.ring.vanishes(add(left, *(negative(times(symbol(v), slope)) for v, slope in slopes)))

    def slope(self, row: str, column: str) -> Tree:
        """The entry of a row: by a coordinate, or by its velocity."""
        if (row, column) not in self.slopes:
            one = self.relation(row)
            name = column if one.kind == "finite" else column + "dot"
            self.slopes[row, column] = derivative(one.left, name)
        return self.slopes[row, column]


def told(error: Exception) -> str:
    """A fault in one line."""
    return (
        str(error)[:200] if isinstance(error, CheckError) else f"a field is missing or of another kind ({error!s:.80})"
    )
