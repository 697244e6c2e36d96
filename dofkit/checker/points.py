"""Points: exact values and balls for all of them; some may be the only zero of rows in a box."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from flint import arb

from dofkit.checker.balls import Choices, evaluated, slope_of
from dofkit.checker.derivatives import rebuilt, substituted
from dofkit.checker.effort import Effort
from dofkit.checker.trees import ONE, Tree


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
