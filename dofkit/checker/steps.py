"""Steps: relations made from relations, each by an identity in the ring.

A step carries two kinds of consequence. *Entailed*: where the relations it was made from hold, it holds. *Accounted
for*: where it holds, the relation it was made from holds. Either may need expressions not to be 0, which is asked at a
point, and cofactors that have a value there, so that it is true near the point.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.trees import Tree, add, negative, number, power, symbol, times


@dataclass(frozen=True)
class Consequence:
    """``target`` holds where all ``sources`` do, where the ``nonzero`` are not 0 and the ``defined`` have a value.

    Near the point ``at`` only, where one is named.
    """

    target: str
    sources: tuple[str, ...]
    nonzero: tuple[Tree, ...] = ()
    defined: tuple[Tree, ...] = ()
    at: str = ""


@dataclass(frozen=True)
class DerivedRelation:
    """``left`` = 0; ``kind`` finite or velocity; ``leaf``: an integral, which keeps its value at the point."""

    name: str
    kind: str
    left: Tree
    leaf: bool = False


Made = tuple[list[DerivedRelation], list[Consequence]]


class StepRoom(Protocol):
    """What a step may ask: texts are read, identities decided, relations looked up."""

    variables: tuple[str, ...]

    def text(self, text: Any) -> Tree:
        """The tree of a text."""

    def identity(self, tree: Tree, what: str) -> None:
        """`CheckError` unless a tree is 0 in the ring."""

    def number_sign(self, text: Any) -> int:
        """The sign of a text of numbers."""

    def relation(self, name: Any) -> DerivedRelation:
        """A relation by its id."""

    def has_velocities(self, tree: Tree) -> bool:
        """Whether a velocity occurs."""

    def reason(self, why: Any, tree: Tree) -> bool:
        """Whether ``why`` shows that a tree is nowhere 0; False where no reason is given."""


def total_derivative(tree: Tree, names: Sequence[str]) -> Tree:
    """The derivative by time along a motion."""
    held = symbols_in(tree)
    return add(*(times(derivative(tree, name), symbol(name + "dot")) for name in names if name in held))


def made_by(step: dict[str, Any], room: StepRoom) -> Made:
    """What a step makes."""
    makers = {"branch": _branch, "sos": _squares, "factor": _factor, "square": _square}
    makers |= {"implied": _implied, "rate": _rate, "integral": _integral}
    refuse(step.get("by") not in makers, f"no such step: {str(step.get('by'))[:40]!r}")
    if "of" in step:
        of = room.relation(step["of"])
        if of.kind == "inequality" or (of.leaf and step["by"] != "rate"):
            raise CheckError("a step is made from an equation of the scene or a step")
    return makers[step["by"]](step, room)


def _times_number(step: dict[str, Any], room: StepRoom) -> Tree:
    text = step.get("number", "1")
    room.number_sign(text)
    return room.text(text)


def _branch(step: dict[str, Any], room: StepRoom) -> Made:
    """A product is 0 where a factor is, and where the others are not 0 only there."""
    of, chosen = room.relation(step["of"]), step["chosen"]
    factors = [room.text(text) for text in step["factors"]]
    if not isinstance(chosen, int) or not 0 <= chosen < len(factors):
        raise CheckError("the chosen factor is none of the factors")
    room.identity(add(of.left, negative(times(_times_number(step, room), *factors))), "the product of the factors")
    others = tuple(factor for i, factor in enumerate(factors) if i != chosen)
    refuse(any(room.has_velocities(factor) for factor in others), "another factor holds velocities")
    new = replace(of, name=step["id"], left=factors[chosen], kind=_kind(room, factors[chosen]))
    return [new], [Consequence(new.name, (of.name,), others), Consequence(of.name, (new.name,), (), others)]


def _kind(room: StepRoom, tree: Tree) -> str:
    return "velocity" if room.has_velocities(tree) else "finite"


def _squares(step: dict[str, Any], room: StepRoom) -> Made:
    """A sum of squares with coefficients of one sign is 0 where every square is."""
    of, terms = room.relation(step["of"]), step["terms"]
    parts = [room.text(text) for _, text in terms]
    refuse(len({room.number_sign(c) for c, _ in terms}) != 1, "the coefficients of a sum of squares have two signs")
    total = add(*(times(room.text(c), power(a, number(2))) for (c, _), a in zip(terms, parts, strict=True)))
    room.identity(add(of.left, negative(total)), "the sum of squares")
    new = [DerivedRelation(f"{step['id']}.{i}", _kind(room, a), a) for i, a in enumerate(parts, 1)]
    down = [Consequence(one.name, (of.name,)) for one in new]
    return new, [*down, Consequence(of.name, tuple(one.name for one in new), (), tuple(parts))]


def _factor(step: dict[str, Any], room: StepRoom) -> Made:
    """A product is 0 where the rest is; only there, where the factor is not 0."""
    of = room.relation(step["of"])
    factor, rest = room.text(step["factor"]), room.text(step["rest"])
    refuse(room.has_velocities(factor) and factor != symbol("tdot"), "a factor that is taken out holds no velocities")
    room.identity(add(of.left, negative(times(factor, rest))), "the product with the factor")
    new = DerivedRelation(step["id"], _kind(room, rest), rest)
    free = factor == symbol("tdot") or room.reason(step.get("nonzero"), factor)
    needs = () if free else (factor,)
    return [new], [Consequence(new.name, (of.name,), needs), Consequence(of.name, (new.name,), (), (factor,))]


def _square(step: dict[str, Any], room: StepRoom) -> Made:
    """A power is 0 where its base is."""
    of, base, exponent = room.relation(step["of"]), room.text(step["base"]), step["power"]
    if not isinstance(exponent, int) or isinstance(exponent, bool) or not 1 <= exponent <= 64:
        raise CheckError("a power is a whole number from 1")
    whole = times(_times_number(step, room), power(base, number(exponent)))
    room.identity(add(of.left, negative(whole)), "the power of the base")
    new = DerivedRelation(step["id"], _kind(room, base), base)
    return [new], [Consequence(new.name, (of.name,)), Consequence(of.name, (new.name,), (), (base,))]


def _combination(step: dict[str, Any], room: StepRoom) -> tuple[Tree, tuple[str, ...], tuple[Tree, ...]]:
    sources = [room.relation(name) for name in step["c"]]
    cofactors = [room.text(text) for text in step["c"].values()]
    for source in sources:
        refuse(source.kind == "inequality" or source.leaf, f"`{source.name}` is no equation to start from")
    total = add(*(times(c, one.left) for c, one in zip(cofactors, sources, strict=True)))
    return total, tuple(one.name for one in sources), tuple(cofactors)


def _implied(step: dict[str, Any], room: StepRoom) -> Made:
    """h g = sum c_i r_i: g is 0 where all r_i are and h is not."""
    known = "of" in step
    of = room.relation(step["of"]) if known else DerivedRelation(step["id"], "", room.text(step["text"]))
    total, sources, cofactors = _combination(step, room)
    h = room.text(step.get("h", "1"))
    refuse(room.has_velocities(h), "the factor of what is implied holds velocities")
    room.identity(add(times(h, of.left), negative(total)), "the cofactors")
    needs = () if room.reason(step.get("nonzero"), h) else (h,)
    new = replace(of, name=step["id"], kind=_kind(room, of.left))
    found = [Consequence(new.name, sources, needs, cofactors)]
    return [new], [*found, Consequence(of.name, sources, needs, cofactors)] if known else found


def _rate(step: dict[str, Any], room: StepRoom) -> Made:
    """What is constantly 0 has the derivative 0."""
    of = room.relation(step["of"])
    refuse(of.kind != "finite", "only a finite relation has a rate")
    new = DerivedRelation(step["id"], "velocity", total_derivative(of.left, room.variables))
    return [new], [Consequence(new.name, (of.name,))]


def _integral(step: dict[str, Any], room: StepRoom) -> Made:
    """h df/dt = sum c_i r_i: along every motion near a point where h is not 0, f keeps its value."""
    function, h = room.text(step["function"]), room.text(step.get("h", "1"))
    total, sources, cofactors = _combination(step, room)
    refuse(room.has_velocities(function) or room.has_velocities(h), "an integral holds no velocities")
    change = total_derivative(function, room.variables)
    room.identity(add(times(h, change), negative(total)), "the integral")
    needs = () if room.reason(step.get("nonzero"), h) else (h,)
    new = DerivedRelation(step["id"], "finite", function, True)
    return [new], [Consequence(new.name, sources, needs, (*cofactors, function))]
