"""Points, and values in balls: every operation encloses the true one, where it is defined and smooth around."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce
from operator import add, mul
from typing import Any

from flint import arb, arb_mat, ctx, fmpq

from dofkit.checker.derivatives import Choices, derivative, folded, slope_of, substituted, symbols_in
from dofkit.checker.ring import repeated
from dofkit.checker.trees import ONE, CheckError, Effort, Tree, refuse

#: Bits of every ball.
PRECISION = 320


def excludes_zero(ball: Any) -> bool:
    """Whether 0 is certainly not in a ball."""
    return bool(ball.is_finite() and (ball > 0 or ball < 0))


def evaluated(tree: Tree, values: Mapping[str, Any], effort: Effort, functions: Choices | None = None) -> Any:
    """The ball of a tree, where every part of it, as written, has a value and is smooth around; else `CheckError`."""

    def value(node: Tree, below: tuple[Any, ...]) -> Any:
        effort.spend(1)
        if node.head == "apply":
            refuse(node.value not in (functions or {}), f"no choice for the function `{node.value}` at the point")
            arguments, text = (functions or {})[str(node.value)]
            slope = slope_of(text, arguments, node.orders)
            return evaluated(slope, dict(zip(arguments, below, strict=True)), effort)
        found = _value(node, values, below)
        refuse(not found.is_finite(), "a value is not finite at the point")
        return found

    with ctx.workprec(PRECISION):
        return folded(tree, value)


def _value(node: Tree, values: Mapping[str, Any], below: tuple[Any, ...]) -> Any:
    head = node.head
    if isinstance(node.value, Fraction):
        return arb(fmpq(node.value.numerator, node.value.denominator))
    if head == "symbol":
        refuse(node.value not in values, f"`{node.value}` has no value at the point")
        return values[str(node.value)]
    if head == "pi":
        return arb.pi()
    if head in ("sum", "product"):
        return reduce(add if head == "sum" else mul, below)
    u, other = below[0], below[-1]
    if head in ("sin", "cos", "exp") or (head == "log" and u > 0):
        return getattr(u, head)()
    if head == "atan2" and (other > 0 or excludes_zero(u)):
        return arb.atan2(u, other)
    refuse(head != "power", f"`{head}` has no smooth value at the point")
    return _raised(node, u, other)


def _raised(node: Tree, u: Any, other: Any) -> Any:
    """A power: of what is positive; a whole one, of what is not 0 where it is negative; a constant root of 0."""
    exponent = node.below[1].value
    if isinstance(exponent, Fraction) and exponent.denominator == 1:
        refuse(exponent < 0 and not excludes_zero(u), "a denominator may be 0 at the point")
        found = repeated(arb(1), u, abs(int(exponent)), mul)
        return found if exponent > 0 else 1 / found
    zero = u == 0 and other > 0 and not symbols_in(node)
    refuse(not (u > 0 or zero), "a root or a power has no smooth value at the point")
    return u if zero else u**other


def regular(rows: Sequence[Sequence[Any]], effort: Effort) -> bool:
    """Whether the determinant of a square matrix of balls is certainly not 0."""
    effort.spend(len(rows) ** 3 // 10 + 1)
    with ctx.workprec(PRECISION):
        return not rows or excludes_zero(arb_mat([list(row) for row in rows]).det())


def interval_newton(
    equations: Sequence[Tree], centre: Mapping[str, Any], radius: Any, value: Callable[[Tree, Mapping[str, Any]], Any]
) -> dict[str, Any]:
    """Balls for the only zero of as many equations as unknowns within a box around ``centre``.

    Where all matrices in F'(X) are regular and y - F'(X)^-1 F(y) lies inside X, F has exactly one zero in X, and it
    lies there (Moore 1966, Nickel 1971). ``value`` gives the ball of a tree, from those of the unknowns.
    """
    with ctx.workprec(PRECISION):
        middle = {name: ball.mid() for name, ball in centre.items()}
        box = {name: ball + arb(0, radius) for name, ball in middle.items()}
        smooth = all(value(equation, box).is_finite() for equation in equations)
        slopes = arb_mat([[value(derivative(equation, name), box) for name in centre] for equation in equations])
        values = arb_mat([[value(equation, middle)] for equation in equations])
        try:
            steps = slopes.solve(values, algorithm="precond")
        except ZeroDivisionError:
            raise CheckError("the matrix of interval Newton may be singular") from None
        found = {name: middle[name] - steps[i, 0] for i, name in enumerate(centre)}
        for name, ball in found.items():
            inside = smooth and box[name].contains_interior(ball)
            refuse(not inside, f"interval Newton does not certify a zero: `{name}` leaves its box")
        return found


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
        return substituted(substituted(tree, {}, self.functions), {"tdot": ONE, **self.exact})

    def value(self, tree: Tree) -> Any:
        """The ball of a tree at the point, every part of which has a value."""
        if id(tree) not in self.memory:
            self.memory[id(tree)] = (tree, self.value_with(tree, {}))
        return self.memory[id(tree)][1]

    def value_with(self, tree: Tree, others: Mapping[str, Any]) -> Any:
        """The ball of a tree at the point, with other balls for some symbols."""
        return evaluated(tree, {"tdot": arb(1), **self.balls, **others}, self.effort, self.functions)
