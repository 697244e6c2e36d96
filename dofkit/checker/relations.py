"""The relations of a scene, those that steps make of them by identities in the ring, and what follows from what.

A step carries two kinds of consequence. *Entailed*: where the relations it was made from hold, it holds. *Accounted
for*: where it holds, the relation it was made from holds. Either may need expressions not to be 0, which is asked at a
point, and others to have a value there, so that it is true near the point.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from flint import arb

from dofkit.checker.balls import CheckedPoint, excludes_zero
from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.problem import Problem
from dofkit.checker.texts import CheckedTexts
from dofkit.checker.trees import CheckError, Effort, Tree, add, number, power, refuse, symbol, times

#: What a certificate of another form, or a hostile one, may raise.
FAULTS = (CheckError, KeyError, TypeError, ValueError, AttributeError, IndexError, ArithmeticError, RecursionError)


@dataclass(frozen=True)
class Consequence:
    """``target`` holds where all ``sources`` do, where the ``nonzero`` are not 0 and the ``defined`` have a value.

    Made by a ``step``; near the point ``at`` only, where one is named.
    """

    target: str
    sources: tuple[str, ...]
    nonzero: tuple[Tree, ...] = ()
    defined: tuple[Tree, ...] = ()
    step: str = ""
    at: str = ""


@dataclass(frozen=True)
class DerivedRelation:
    """``left`` = 0; ``kind`` finite or velocity; ``leaf``: an integral, which keeps its value at the point."""

    name: str
    kind: str
    left: Tree
    leaf: bool = False


Made = tuple[list[DerivedRelation], list[Consequence]]


def total_derivative(tree: Tree, names: Sequence[str]) -> Tree:
    """The derivative by time along a motion."""
    held = symbols_in(tree)
    return add(*(times(derivative(tree, name), symbol(name + "dot")) for name in names if name in held))


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
        self._take_steps()

    def _take_steps(self) -> None:
        makers = {"branch": self._branch, "sos": self._squares, "rate": self._rate}
        for step in self.parts["relations"]:
            name = step["id"]
            try:
                if "of" in step:
                    refuse(self.relation(step["of"]).kind == "inequality", "a step is made from an equation")
                    refuse(self.known[step["of"]].leaf and step["by"] != "rate", "an integral has a rate, and no more")
                refuse(step["by"] not in (*makers, "implied", "integral"), "no such step")
                relations, consequences = makers.get(step["by"], self._implied)(step)
                taken = not self.known.keys().isdisjoint((name, *(one.name for one in relations)))
                refuse(taken, "a name of this step is taken")
                self.known.update({one.name: one for one in relations})
                self.consequences += [replace(one, step=name) for one in consequences]
            except FAULTS as error:
                self.faults[name] = f"step `{name[:60]}`: {told(error)}"

    def _derived(self, name: str, left: Tree, leaf: bool = False) -> DerivedRelation:
        return DerivedRelation(name, "velocity" if self.has_velocities(left) else "finite", left, leaf)

    def _branch(self, step: dict[str, Any]) -> Made:
        """A product is 0 where a factor is, and where the others are not 0 only there; so is a power of the factor."""
        of, chosen, exponent = self.relation(step["of"]), step["chosen"], step.get("power", 1)
        factors = [self.text(text) for text in step["factors"]]
        refuse(type(chosen) is not int or not 0 <= chosen < len(factors), "the chosen factor is none of the factors")
        refuse(type(exponent) is not int or not 1 <= exponent <= 64, "a power is a whole number from 1")
        base = factors.pop(chosen)
        self.identity(of.left, times(power(base, number(exponent)), *factors), "the product of the factors")
        others = [one for one in factors if one != symbol("tdot")]
        refuse(any(map(self.has_velocities, others)), "another factor holds velocities")
        free = all(self.reason(step.get("nonzero"), one) for one in others)
        new, defined = self._derived(step["id"], base), (base, *factors)
        down = Consequence(new.name, (of.name,), () if free else tuple(others), defined)
        return [new], [down, Consequence(of.name, (new.name,), (), defined)]

    def _squares(self, step: dict[str, Any]) -> Made:
        """A sum of squares with coefficients of one sign is 0 where every square is."""
        of, total = self.relation(step["of"]), self.squares(step["terms"])
        if not self.same(of.left, times(number(-1), total)):
            self.identity(of.left, total, "the sum of squares")
        new = [self._derived(f"{step['id']}.{i}", self.text(a)) for i, (_, a) in enumerate(step["terms"], 1)]
        return new, [
            *(Consequence(one.name, (of.name,)) for one in new),
            Consequence(of.name, tuple(one.name for one in new)),
        ]

    def _implied(self, step: dict[str, Any]) -> Made:
        """h g = sum c_i r_i: g is 0 where all r_i are and h is not; an integral with the rate g keeps its value.

        Integrals: along every motion near a point where h is not 0.
        """
        leaf, known = step["by"] == "integral", "of" in step
        refuse(leaf and known, "an integral is a function of its own")
        of = self.relation(step["of"]) if known else None
        left = of.left if of else self.text(step["function" if leaf else "text"])
        sources = [self.relation(name) for name in step["c"]]
        refuse(any(one.leaf or one.kind == "inequality" for one in sources), "an inequality or integral to start from")
        cofactors, h = [self.text(text) for text in step["c"].values()], self.text(step.get("h", "1"))
        refuse(
            self.has_velocities(h) or (leaf and self.has_velocities(left)), "the factor or integral holds velocities"
        )
        change = total_derivative(left, self.variables) if leaf else left
        total = add(*(times(c, one.left) for c, one in zip(cofactors, sources, strict=True)))
        self.identity(times(h, change), total, "the cofactors")
        needs = () if self.reason(step.get("nonzero"), h) else (h,)
        new, defined = self._derived(step["id"], left, leaf), (h, *cofactors) if known else (h, *cofactors, left)
        follows = Consequence(new.name, tuple(one.name for one in sources), needs, defined)
        return [new], [follows, replace(follows, target=of.name)] if of else [follows]

    def _rate(self, step: dict[str, Any]) -> Made:
        """What is constantly 0, or keeps its value, has the derivative 0."""
        of = self.relation(step["of"])
        refuse(of.kind != "finite", "only a finite relation has a rate")
        new = DerivedRelation(step["id"], "velocity", total_derivative(of.left, self.variables))
        return [new], [Consequence(new.name, (of.name,), (), (of.left,))]

    def owned(self, owner: str | None, kinds: Collection[str] = ("finite", "velocity")) -> tuple[str, ...]:
        """The relations of a constraint, or of all."""
        found = (one for one in self.problem.relations if one.kind in kinds)
        return tuple(one.name for one in found if owner is None or one.owner == owner)

    @cached_property
    def finite(self) -> tuple[str, ...]:
        """The finite relations of the scene."""
        return self.owned(None, ("finite",))

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """The velocity relations of the scene."""
        return self.owned(None, ("velocity",))

    @cached_property
    def equations(self) -> tuple[str, ...]:
        """The finite relations, then those of velocities."""
        return (*self.finite, *self.moving)

    def holds_time(self, names: Iterable[str]) -> bool:
        """Whether time or dt occurs in a relation."""
        return any(not {"t", "tdot"}.isdisjoint(symbols_in(self.relation(name).left)) for name in names)

    @cached_property
    def timed(self) -> bool:
        """Whether time or dt occurs in an equation."""
        return self.holds_time(self.equations)

    def relation(self, name: Any) -> DerivedRelation:
        """A relation by its id."""
        if name not in self.known:
            raise CheckError(self.faults.get(str(name).partition(".")[0], f"no relation `{str(name)[:60]}`"))
        return self.known[name]

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

    def follow(self, wanted: Iterable[str], start: Iterable[str], point: CheckedPoint | None, what: str) -> None:
        """`CheckError` unless all that is wanted holds near a point where ``start`` does."""
        left = set(wanted) - set(start)
        left -= self.closure(start, point) if left else set()
        if left:
            raise CheckError(f"`{min(left)}` is not shown to follow from {what}")

    def _met(self, place: int, point: CheckedPoint | None) -> bool:
        one = self.consequences[place]
        if point is None:
            return not one.at and not one.nonzero and all(map(self.has_value_everywhere, one.defined))
        key = (place, point.name)
        if key not in self.met:
            try:
                nonzero = one.at in ("", point.name) and all(excludes_zero(point.value(tree)) for tree in one.nonzero)
                wide = {v: arb(0, 10**30) for v in self.velocities - point.balls.keys()}
                self.met[key] = nonzero and all(point.value_with(tree, wide) is not None for tree in one.defined)
            except CheckError:
                refuse(self.effort.left < 0, "the work that a certificate may cost is used up")
                self.met[key] = False
        return self.met[key]

    def is_linear(self, name: str) -> bool:
        """Whether a relation is finite, or a linear form in the velocities (dt included)."""
        if name not in self.linear:
            one = self.relation(name)
            slopes = {v: derivative(one.left, v) for v in sorted(self.velocities & symbols_in(one.left))}
            form = add(*(times(symbol(v), slope) for v, slope in slopes.items()))
            self.linear[name] = one.kind != "velocity" or (
                not any(map(self.has_velocities, slopes.values())) and self.same(one.left, form)
            )
        return self.linear[name]

    def slope(self, row: str, column: str) -> Tree:
        """The entry of a row: by a coordinate, or by its velocity."""
        if (row, column) not in self.slopes:
            one = self.relation(row)
            self.slopes[row, column] = derivative(one.left, column if one.kind == "finite" else column + "dot")
        return self.slopes[row, column]


def told(error: Exception) -> str:
    """A fault in one line."""
    why = f"a field is missing or of another kind ({error!s:.80})"
    return str(error)[:200] if isinstance(error, CheckError) else why
