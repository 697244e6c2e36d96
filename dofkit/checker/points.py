"""Points: exact values, or a box in which interval Newton certifies the only zero of some rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from dofkit.checker.balls import evaluated
from dofkit.checker.derivatives import derivative, rebuilt, substituted, symbols_in
from dofkit.checker.effort import Effort
from dofkit.checker.errors import CheckError
from dofkit.checker.trees import ONE, Tree


@dataclass
class CheckedPoint:
    """A point that was checked: ``exact`` values, ``functions`` chosen, and ``balls`` for the columns of a box.

    The relations ``rows`` hold at it by interval Newton.
    """

    name: str
    exact: dict[str, Tree]
    functions: Mapping[str, tuple[tuple[str, ...], Tree]]
    effort: Effort
    balls: dict[str, Any] = field(default_factory=dict)
    rows: frozenset[str] = frozenset()
    memory: dict[int, tuple[Tree, Any]] = field(default_factory=dict)

    def prepared(self, tree: Tree) -> Tree:
        """A tree with the exact values and the chosen functions put in; velocities are by ``t``."""
        chosen = with_functions(tree, self.functions) if self.functions else tree
        return substituted(chosen, {"tdot": ONE, **self.exact})

    def value(self, tree: Tree) -> Any:
        """The ball of a tree at the point."""
        if id(tree) not in self.memory:
            self.memory[id(tree)] = (tree, evaluated(self.prepared(tree), self.balls, self.effort))
        return self.memory[id(tree)][1]

    def value_with(self, tree: Tree, velocities: Mapping[str, Tree]) -> Any:
        """The ball of a tree at the point, with expressions in the place of velocities."""
        ahead = {name: value for name, value in self.exact.items() if name not in velocities}
        put_in = {name: self.prepared(value) for name, value in velocities.items()}
        chosen = with_functions(tree, self.functions) if self.functions else tree
        return evaluated(substituted(chosen, {**ahead, **put_in}), self.balls, self.effort)

    def has(self, name: str) -> bool:
        """Whether a symbol has a value here."""
        return name in self.exact or name in self.balls


def with_functions(tree: Tree, functions: Mapping[str, tuple[tuple[str, ...], Tree]]) -> Tree:
    """A tree with texts in the place of declared functions, derivatives carried out."""
    done: dict[int, Tree] = {}

    def read(node: Tree) -> Tree:
        if node.below and id(node) not in done:
            below = tuple(read(part) for part in node.below)
            if node.head == "apply" and node.value in functions:
                done[id(node)] = _applied(functions[str(node.value)], node.orders, below)
            else:
                done[id(node)] = rebuilt(node, below)
        return done.get(id(node), node)

    return read(tree)


def _applied(function: tuple[tuple[str, ...], Tree], orders: Sequence[int], below: tuple[Tree, ...]) -> Tree:
    arguments, text = function
    for argument, order in zip(arguments, orders, strict=True):
        for _ in range(order):
            text = derivative(text, argument)
    return substituted(text, dict(zip(arguments, below, strict=True)))


def in_turn(values: Mapping[str, Tree]) -> dict[str, Tree]:
    """Values with those before them put in; what is left over is no number."""
    found: dict[str, Tree] = {}
    for name, tree in values.items():
        found[name] = substituted(tree, found)
        if left := symbols_in(found[name]):
            raise CheckError(f"the value of `{name}` at a point mentions `{min(left)}`")
    return found
