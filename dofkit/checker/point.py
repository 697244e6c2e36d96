"""Points that were checked: exact values, or balls around the only zero of equations in a box."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from flint import arb, arb_mat, ctx

from dofkit.checker.trees import (
    ONE,
    PRECISION,
    Choices,
    Effort,
    Tree,
    derivative,
    evaluated,
    not_zero,
    refuse,
    substituted,
)


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
