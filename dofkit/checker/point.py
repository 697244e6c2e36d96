"""Values in balls, and points that were checked: exact, or balls around the only zero of equations in a box.

Every operation on balls encloses the true one, where it is defined and smooth around.
"""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce
from typing import Any

from flint import arb, arb_mat, ctx, fmpq

from dofkit.checker.trees import ONE, Choices, Effort, Tree, derivative, folded, refuse, repeated, substituted

#: Bits of every ball.
PRECISION = 320


def not_zero(ball: Any) -> bool:
    """Whether 0 is certainly not in a ball."""
    return bool(ball.is_finite() and (ball > 0 or ball < 0))


def evaluated(tree: Tree, values: Mapping[str, Any], effort: Effort) -> Any:
    """The ball of a tree, where every part of it, as written, has a value and is smooth around; else `CheckError`."""

    def value(node: Tree, below: tuple[Any, ...]) -> Any:
        effort.spend(1)
        ball = _value(node, values, below)
        refuse(not ball.is_finite(), "a value is not finite at the point")
        return ball

    with ctx.workprec(PRECISION):
        return folded(tree, value)


def _value(node: Tree, values: Mapping[str, Any], below: tuple[Any, ...]) -> Any:
    """Return the ball of a node from the values of the nodes below it; refuse where it may have no smooth value."""
    head = node.head
    if isinstance(node.value, Fraction):
        return arb(fmpq(node.value.numerator, node.value.denominator))
    if head == "symbol":
        refuse(node.value not in values, f"`{node.value}` has no value at the point")
        return values[str(node.value)]
    if head == "pi":
        return arb.pi()
    if head in ("sum", "product"):
        return reduce(operator.add if head == "sum" else operator.mul, below)
    u, other = below[0], below[-1]
    if head in ("sin", "cos", "exp") or (head == "log" and u > 0):
        return getattr(u, head)()
    if head == "atan2" and (other > 0 or not_zero(u)):
        return arb.atan2(u, other)
    # a power: of what is positive; a whole one, of what is not 0 where it is negative; a constant root of 0
    exponent = node.below[1].value if head == "power" else Fraction(1, 2)
    if isinstance(exponent, Fraction) and exponent.denominator == 1 and (exponent > 0 or not_zero(u)):
        ball = repeated(arb(1), u, abs(int(exponent)), operator.mul)
        return ball if exponent > 0 else 1 / ball
    zero = u == 0 and other > 0 and not node.symbols
    refuse(head != "power" or not (u > 0 or zero), f"a {head} has no smooth value at the point, or may have none")
    return u if zero else u**other


@dataclass
class CheckedPoint:
    """A point that was checked: ``exact`` values, ``functions`` chosen, and ``balls`` for all symbols.

    It satisfies the relations ``rows`` by interval Newton.
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
        chosen = substituted(tree, {}, self.functions) if tree.applied else tree
        return evaluated(chosen, {"tdot": arb(1), **self.balls, **others}, self.effort)

    def is_regular(self, matrix: Sequence[Sequence[Tree]]) -> None:
        """`CheckError` unless a square matrix is regular at the point."""
        self.effort.spend(len(matrix) ** 3 // 10 + 1)
        rows = [[self.value(tree) for tree in row] for row in matrix]
        with ctx.workprec(PRECISION):
            refuse(rows and not not_zero(arb_mat(rows).det()), "the minor may be 0")

    def settle(self, equations: Sequence[Tree], columns: Sequence[str], radius: Any) -> None:
        """The balls of columns become those of the only zero of as many equations in a box around them.

        Where all matrices in F'(X) are regular and y - F'(X)^-1 F(y) lies inside X, F has exactly one zero in X, and it
        lies there (Moore 1966, Nickel 1971).
        """
        refuse(not radius > 0, "the radius of a box is positive")
        with ctx.workprec(PRECISION):
            middle = {name: self.balls[name].mid() for name in columns}
            box = {name: ball + arb(0, radius.mid()) for name, ball in middle.items()}
            smooth = all(self.value_with(equation, box).is_finite() for equation in equations)
            slopes = [[self.value_with(derivative(equation, name), box) for name in columns] for equation in equations]
            values = arb_mat([[self.value_with(equation, middle)] for equation in equations])
            steps = arb_mat(slopes).solve(values, nonstop=True, algorithm="precond")
            for i, name in enumerate(columns):
                self.balls[name] = middle[name] - steps[i, 0]
                inside = smooth and box[name].contains_interior(self.balls[name])
                refuse(not inside, f"interval Newton does not certify a zero: `{name}` leaves its box")
