"""Points, and values in balls: every operation encloses the true one, where it is defined and smooth around."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from operator import mul
from typing import Any

from flint import arb, arb_mat, ctx, fmpq

from dofkit.checker.derivatives import derivative, rebuilt, substituted, symbols_in
from dofkit.checker.ring import repeated
from dofkit.checker.trees import ONE, CheckError, Effort, Tree, refuse

#: Bits of every ball.
PRECISION = 320
_SMOOTH = frozenset(("sin", "cos", "tan", "cot", "sec", "csc", "atan", "sinh", "cosh", "tanh", "exp"))
#: A choice for a declared function: its arguments, and a text of them.
Choices = Mapping[str, tuple[tuple[str, ...], Tree]]


def excludes_zero(ball: Any) -> bool:
    """Whether 0 is certainly not in a ball."""
    return bool(ball.is_finite() and (ball > 0 or ball < 0))


def evaluated(tree: Tree, values: Mapping[str, Any], effort: Effort, functions: Choices | None = None) -> Any:
    """The ball of a tree, where every part of it, as written, has a value and is smooth around; else `CheckError`."""
    done: dict[int, Any] = {}

    def value(node: Tree) -> Any:
        if id(node) not in done:
            effort.spend(1)
            below = [value(part) for part in node.below]
            if node.head == "apply":
                refuse(node.value not in (functions or {}), f"no choice for the function `{node.value}` at the point")
                arguments, text = (functions or {})[str(node.value)]
                given = dict(zip(arguments, below, strict=True))
                found = evaluated(slope_of(text, arguments, node.orders), given, effort)
            else:
                found = _value(node, values, below)
            refuse(not found.is_finite(), "a value is not finite at the point")
            done[id(node)] = found
        return done[id(node)]

    with ctx.workprec(PRECISION):
        return value(tree)


def slope_of(text: Tree, arguments: Sequence[str], orders: Sequence[int]) -> Tree:
    """A text differentiated so often by each of its arguments."""
    for argument, order in zip(arguments, orders, strict=True):
        for _ in range(order):
            text = derivative(text, argument)
    return text


def _value(node: Tree, values: Mapping[str, Any], below: list[Any]) -> Any:
    if isinstance(node.value, Fraction):
        return arb(fmpq(node.value.numerator, node.value.denominator))
    if node.head == "symbol":
        refuse(node.value not in values, f"`{node.value}` has no value at the point")
        return values[str(node.value)]
    if node.head == "pi":
        return arb.pi()
    if node.head in ("sum", "product"):
        found = arb(0 if node.head == "sum" else 1)
        for part in below:
            found = found + part if node.head == "sum" else found * part
        return found
    if node.head in _SMOOTH:
        return getattr(below[0], node.head)()
    return _guarded(node, below[0], below[-1])


def _guarded(node: Tree, u: Any, other: Any) -> Any:
    head, exponent = node.head, node.below[-1].value
    if head == "power" and isinstance(exponent, Fraction) and exponent.denominator == 1:
        refuse(exponent < 0 and not excludes_zero(u), "a denominator may be 0 at the point")
        found = repeated(arb(1), u, abs(int(exponent)), mul)
        return found if exponent > 0 else 1 / found
    if head == "power" and u > 0:
        return u**other
    if head == "sqrt" and (u > 0 or (u == 0 and not symbols_in(node))):
        return u.sqrt()
    if head == "log" and u > 0:
        return u.log()
    if head in ("asin", "acos") and u > -1 and u < 1:
        return u.asin() if head == "asin" else u.acos()
    if head == "abs" and excludes_zero(u):
        return abs(u)
    if head == "atan2" and (other > 0 or excludes_zero(u)):
        return arb.atan2(u, other)
    raise CheckError(f"`{head}` has no smooth value at the point")


def regular(rows: Sequence[Sequence[Any]], effort: Effort) -> bool:
    """Whether the determinant of a square matrix of balls is certainly not 0."""
    effort.spend(len(rows) ** 3 // 10 + 1)
    with ctx.workprec(PRECISION):
        return not rows or excludes_zero(arb_mat([list(row) for row in rows]).det())


def krawczyk(
    equations: Sequence[Tree], centre: Mapping[str, Any], radius: Any, value: Callable[[Tree, Mapping[str, Any]], Any]
) -> dict[str, Any]:
    """Balls for the only zero of as many equations as unknowns within a box around ``centre``.

    Krawczyk 1969, Moore 1977: where K = y - C F(y) + (1 - C F'(X)) (X - y) lies inside X, F has exactly one zero in X,
    and it lies in K. ``value`` gives the ball of a tree, from those of the unknowns.
    """
    size = len(centre)
    with ctx.workprec(PRECISION):
        spread = arb(0, radius)
        middle = {name: ball.mid() for name, ball in centre.items()}
        box = {name: ball + spread for name, ball in middle.items()}
        slopes = [[derivative(equation, name) for name in centre] for equation in equations]
        at_box = arb_mat([[value(slope, box) for slope in row] for row in slopes])
        try:
            inverse = arb_mat([[value(slope, middle).mid() for slope in row] for row in slopes]).inv()
        except ZeroDivisionError:
            raise CheckError("the matrix of interval Newton is singular") from None
        multiplier = arb_mat([[inverse[i, j].mid() for j in range(size)] for i in range(size)])
        values = arb_mat([[value(equation, middle)] for equation in equations])
        rest = arb_mat([[arb(i == j) for j in range(size)] for i in range(size)]) - multiplier * at_box
        start = arb_mat([[middle[name]] for name in centre])
        image = start - multiplier * values + rest * arb_mat([[spread] for _ in centre])
        for i, name in enumerate(centre):
            inside = box[name].contains_interior(image[i, 0])
            refuse(not inside, f"interval Newton does not certify a zero: `{name}` leaves its box")
        return {name: image[i, 0] for i, name in enumerate(centre)}


@dataclass
class CheckedPoint:
    """A point that was checked: ``exact`` values, ``functions`` chosen, and ``balls`` for all symbols.

    The relations ``rows`` hold at it by interval Newton.
    """

    name: str
    exact: dict[str, Tree]
    functions: Choices
    effort: Effort
    balls: dict[str, Any] = field(default_factory=dict)
    rows: frozenset[str] = frozenset()
    memory: dict[int, tuple[Tree, Any]] = field(default_factory=dict)

    def prepared(self, tree: Tree) -> Tree:
        """A tree with the exact values and the chosen functions put in; velocities are by ``t``."""
        return substituted(with_functions(tree, self.functions), {"tdot": ONE, **self.exact})

    def value(self, tree: Tree) -> Any:
        """The ball of a tree at the point, every part of which has a value."""
        if id(tree) not in self.memory:
            self.memory[id(tree)] = (tree, self.value_with(tree, {}))
        return self.memory[id(tree)][1]

    def value_with(self, tree: Tree, others: Mapping[str, Any]) -> Any:
        """The ball of a tree at the point, with other balls for some symbols."""
        return evaluated(tree, {"tdot": arb(1), **self.balls, **others}, self.effort, self.functions)


def with_functions(tree: Tree, functions: Choices) -> Tree:
    """A tree with texts in the place of declared functions, derivatives carried out."""
    done: dict[int, Tree] = {}

    def read(node: Tree) -> Tree:
        if node.below and id(node) not in done:
            below = tuple(read(part) for part in node.below)
            if node.head == "apply" and node.value in functions:
                arguments, text = functions[str(node.value)]
                slope = slope_of(text, arguments, node.orders)
                done[id(node)] = substituted(slope, dict(zip(arguments, below, strict=True)))
            else:
                done[id(node)] = rebuilt(node, below)
        return done.get(id(node), node)

    return read(tree) if functions else tree
