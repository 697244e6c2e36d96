"""Several expressions as one program over boxes: bounds of all values, forward and backward.

What running it forward leaves out of a box is proved to be no value there [Moore1966]. Running it backward narrows the
arguments of every step to those for which it can have its result (hull consistency).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from dofkit.exact.boxes import functions
from dofkit.exact.boxes import intervals as iv
from dofkit.exact.boxes.intervals import Interval
from dofkit.exact.errors import raising_no_value
from dofkit.expressions.tree import Expr

HALF_TURNS: Interval = (-3.1415926535897936, 3.1415926535897936)
#: Sweeps over one box, and the share of some width that a sweep has to remove for another to follow.
SWEEPS, WORTH = 12, 0.05

Box = list[Interval]


@dataclass(frozen=True)
class Node:
    """One step: ``op`` is num, var, add, mul, pow, root, fn, atan2 or any; ``args`` are earlier steps."""

    op: str
    args: tuple[int, ...] = ()
    data: Any = None


class BoxProgram:
    """A program whose roots must each lie in a given interval.

    Symbols are variables; so is every value of an unknown function, which may be anything.
    """

    @raising_no_value
    def __init__(self, wanted: Sequence[tuple[Expr, Interval]]) -> None:
        self.nodes: list[Node] = []
        self.variables: list[Expr] = []
        self._seen: dict[Any, int] = {}
        self.roots = [(self._node(e), interval) for e, interval in wanted]
        self.place = {self.nodes[i].data: i for i in range(len(self.nodes)) if self.nodes[i].op == "var"}
        self.var_nodes = [self.place[k] for k in range(len(self.variables))]
        self.work = 0

    # -- the program ----------------------------------------------------------------------------

    def _emit(self, op: str, args: tuple[int, ...] = (), data: Any = None) -> int:
        key = (op, args, data)
        if key not in self._seen:
            self._seen[key] = len(self.nodes)
            self.nodes.append(Node(op, args, data))
        return self._seen[key]

    def _variable(self, e: Expr) -> int:
        if e not in self._seen:
            self._seen[e] = self._emit("var", (), len(self.variables))
            self.variables.append(e)
        return self._seen[e]

    def _node(self, e: Expr) -> int:
        if e.op == "num":
            return self._emit("num", (), iv.number(e.args[0]))
        if e.op == "const":
            return self._emit("num", (), functions.constant(e.args[0]))
        if e.op in ("sym", "call"):
            return self._variable(e)
        if e.op in ("add", "mul"):
            return self._emit(e.op, tuple(self._node(part) for part in e.args))
        if e.op == "pow":
            return self._power(e)
        return self._function(e.args[0], [self._node(part) for part in e.args[1:]])

    def _power(self, e: Expr) -> int:
        base, exponent = e.args
        if exponent.op != "num":
            log = self._emit("fn", (self._node(base),), "log")
            return self._emit("fn", (self._emit("mul", (self._node(exponent), log)),), "exp")
        value = exponent.args[0]
        node = self._node(base)
        if value.denominator > 1:
            node = self._emit("root", (node,), value.denominator)
        if value.numerator != 1:
            node = self._emit("pow", (node,), abs(value.numerator)) if abs(value.numerator) > 1 else node
            node = self._emit("inverse", (node,)) if value < 0 else node
        return node

    def _function(self, name: str, args: list[int]) -> int:
        if name == "atan2":
            return self._emit("atan2", tuple(args))
        if name in ("cot", "sec", "csc"):
            below = self._emit("fn", (args[0],), "cos" if name == "sec" else "sin")
            inverse = self._emit("inverse", (below,))
            return self._emit("mul", (self._emit("fn", (args[0],), "cos"), inverse)) if name == "cot" else inverse
        return self._emit("fn", (args[0],), name)

    # -- hull consistency ------------------------------------------------------------------------

    def forward(self, box: Box) -> list[Interval]:
        """Return the values of all steps over the box. Raises EmptyError where one has none."""
        at: list[Interval] = []
        self.work += len(self.nodes)
        for node in self.nodes:
            at.append(self._value(node, at, box))
        return at

    def _value(self, node: Node, at: list[Interval], box: Box) -> Interval:
        op, args = node.op, node.args
        if op == "num":
            value: Interval = node.data
            return value
        if op == "var":
            known: Interval = box[node.data]
            return known
        if op in ("add", "mul"):
            combine = iv.add if op == "add" else iv.mul
            total = at[args[0]]
            for i in args[1:]:
                total = combine(total, at[i])
            return total
        return HALF_TURNS if op == "atan2" else _of_one(node, at[args[0]])

    def backward(self, at: list[Interval]) -> None:
        """Narrow ``at`` from the roots to the variables. Raises EmptyError."""
        for root, wanted in self.roots:
            at[root] = iv.meet(at[root], wanted)
        for i in range(len(self.nodes) - 1, -1, -1):
            node = self.nodes[i]
            if node.op in ("add", "mul"):
                self._backward_many(node, at, at[i])
            elif node.args and node.op != "atan2":
                (j,) = node.args
                at[j] = self._narrowed(node, at[j], at[i])

    def _narrowed(self, node: Node, x: Interval, result: Interval) -> Interval:
        """Return the part of the argument for which the step can have the result."""
        if node.op == "pow":
            if node.data % 2:
                return iv.meet(x, iv.root(result, node.data))
            return iv.solve_even(x, iv.root(iv.meet(result, iv.NON_NEGATIVE), node.data))
        if node.op == "inverse":
            return iv.solve_product(x, result, (1.0, 1.0))
        if node.op == "root":
            allowed = result if node.data % 2 else iv.meet(result, iv.NON_NEGATIVE)
            return iv.meet(x, iv.integer_power(allowed, node.data))
        return functions.solve_function(node.data, x, result)

    def _backward_many(self, node: Node, at: list[Interval], result: Interval) -> None:
        """Narrow each term or factor by the result and the others."""
        adds = node.op == "add"
        combine, neutral = (iv.add, (0.0, 0.0)) if adds else (iv.mul, (1.0, 1.0))
        after = [neutral]
        for i in reversed(node.args[1:]):
            after.append(combine(after[-1], at[i]))
        before = neutral
        for i, rest in zip(node.args, reversed(after), strict=True):
            others = combine(before, rest)
            old = at[i]
            at[i] = iv.meet(old, iv.minus(result, others)) if adds else iv.solve_product(old, others, result)
            before = combine(before, old)

    def total(self, at: list[Interval]) -> bool:
        """Return whether every step is defined for all arguments in the box."""
        return all(_defined(node, at[node.args[0]]) for node in self.nodes if len(node.args) == 1)

    @raising_no_value
    def contract(self, box: Box) -> Box:
        """Return the part of the box that running forward and backward leaves. Raises EmptyError where that is nothing.

        Every solution in the box is in what is returned, so that EmptyError is a proof that there is none.
        """
        for _ in range(SWEEPS):
            at = self.forward(box)
            self.backward(at)
            narrower = [at[i] for i in self.var_nodes]
            if not _is_worth_another(box, narrower):
                break
            box = narrower
        return narrower


def _of_one(node: Node, x: Interval) -> Interval:
    """Return all values of a step with one argument. Raises EmptyError where it has none."""
    if node.op == "pow":
        return iv.integer_power(x, node.data)
    if node.op == "inverse":
        return iv.hull(iv.inverse(x))
    return iv.root(x, node.data) if node.op == "root" else functions.function(node.data, x)


def _defined(node: Node, x: Interval) -> bool:
    if node.op == "inverse":
        return not iv.contains_zero(x)
    if node.op == "root":
        return x[0] >= 0.0 or node.data % 2 == 1
    if node.op == "fn" and node.data in ("asin", "acos"):
        return x[0] >= -1.0 and x[1] <= 1.0
    if node.op == "fn" and node.data == "tan":
        return functions.function("tan", x) != iv.WHOLE
    return node.op != "fn" or node.data != "log" or x[0] > 0.0


def _is_worth_another(old: Box, new: Box) -> bool:
    """Return whether some interval lost a share of its width, or became finite."""
    for (a, b), (c, d) in zip(old, new, strict=True):
        if (a == -math.inf and c > a) or (b == math.inf and d < b):
            return True
        if b - a < math.inf and d - c < (1 - WORTH) * (b - a):
            return True
    return False
