"""Values of expressions in floats, of the checker's trees and of the engines' alike: for tests only."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from dofkit.checker.trees import Tree, derivative
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr

Values = Mapping[Any, float]

ELEMENTARY: dict[str, Callable[..., float]] = {
    **{name: getattr(math, name) for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2")},
    **{name: getattr(math, name) for name in ("sinh", "cosh", "tanh", "exp", "log", "sqrt")},
    "abs": abs,
    "cot": lambda x: 1 / math.tan(x),
    "sec": lambda x: 1 / math.cos(x),
    "csc": lambda x: 1 / math.sin(x),
}


def unknown(name: str, orders: Sequence[int], arguments: Sequence[float]) -> float:
    """One smooth function for each name, with its derivatives: exp(sum c_i x_i) + the first argument cubed."""
    rates = [0.3 + 0.05 * ((ord(name[0]) + 3 * i) % 5) for i in range(len(arguments))]
    found = math.prod(rate**order for rate, order in zip(rates, orders, strict=True))
    found *= math.exp(sum(rate * x for rate, x in zip(rates, arguments, strict=True)))
    if any(orders[1:]) or orders[0] > 3:
        return found
    x = arguments[0]
    return found + (x**3, 3 * x**2, 6 * x, 6.0)[orders[0]]


def of_tree(tree: Tree, values: Values) -> float:
    """The value of a tree of the checker, symbols by name."""
    if tree.head == "symbol":
        return values[tree.value]
    if tree.head == "number":
        return float(tree.value)
    if tree.head == "pi":
        return math.pi
    below = [of_tree(part, values) for part in tree.below]
    if tree.head == "sum":
        return math.fsum(below)
    if tree.head == "product":
        return math.prod(below)
    if tree.head == "power":
        return real_power(*below)
    if tree.head == "apply":
        return unknown(str(tree.value), tree.orders, below)
    return ELEMENTARY[tree.head](*below)


def of_engine(e: Expr, values: Values) -> float:
    """The value of an expression of the engines, symbols by kind and name."""
    if e.op == "sym":
        return values[e.args]
    if e.op == "num":
        return float(e.args[0])
    if e.op == "const":
        return math.pi if e.args[0] == "pi" else math.e
    if e.op == "call":
        name, orders, arguments = e.args
        return unknown(name, orders, [of_engine(part, values) for part in arguments])
    if e.op == "fn":
        return ELEMENTARY[e.args[0]](*(of_engine(part, values) for part in e.args[1:]))
    below = [of_engine(part, values) for part in e.args]
    if e.op == "pow":
        return real_power(*below)
    return math.fsum(below) if e.op == "add" else math.prod(below)


def real_power(base: float, exponent: float) -> float:
    """A real power, or ValueError."""
    found = base**exponent
    if isinstance(found, complex):
        raise ValueError("not real")
    return found


def rows_of_trees(trees: Sequence[Tree], columns: Sequence[str], values: Values) -> np.ndarray[Any, Any]:
    """The Jacobian of trees."""
    return np.array([[of_tree(derivative(tree, q), values) for q in columns] for tree in trees])


def rows_of_engine(es: Sequence[Expr], columns: Sequence[Expr], values: Values) -> np.ndarray[Any, Any]:
    """The Jacobian of the engines' expressions."""
    return np.array([[of_engine(diff(e, q), values) for q in columns] for e in es])
