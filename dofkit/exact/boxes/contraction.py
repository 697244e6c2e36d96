"""Relations over boxes: what no point of a box satisfies is cut away, with a proof.

`BoxProgram` is one shared program of several expressions. `contract` narrows a box by running it forward and backward
(hull consistency) and by interval Newton steps on combinations of the relations that are nearly solved for a variable.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dofkit.exact.boxes import intervals as iv
from dofkit.exact.boxes.intervals import EmptyError, Interval
from dofkit.expressions.tree import Expr

#: Sweeps over one box, and the part of some width that a sweep has to cut away for another to follow.
SWEEPS, WORTH = 12, 0.05
#: Jacobian entries smaller than this are no pivots.
TINY = 1e-9

HALF_TURNS: Interval = (-3.1415926535897936, 3.1415926535897936)

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

    def __init__(self, wanted: Sequence[tuple[Expr, Interval]]) -> None:
        self.nodes: list[Node] = []
        self.variables: list[Expr] = []
        self._seen: dict[Any, int] = {}
        self.roots = [(self._node(e), interval) for e, interval in wanted]
        self.place = {self.nodes[i].data: i for i in range(len(self.nodes)) if self.nodes[i].op == "var"}
        self.var_nodes = [self.place[k] for k in range(len(self.variables))]
        self.equations = [node for node, interval in self.roots if interval == (0.0, 0.0)]
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
            return self._emit("num", (), iv.constant(e.args[0]))
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
        """The values of all steps over the box. Raises EmptyError where one has none."""
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
        """Narrow ``at`` from the roots down. Raises EmptyError."""
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
        """The part of the one argument for which the step can have the result."""
        if node.op == "pow":
            if node.data % 2:
                return iv.meet(x, iv.root(result, node.data))
            return iv.solve_even(x, iv.root(iv.meet(result, iv.NON_NEGATIVE), node.data))
        if node.op == "inverse":
            return iv.solve_product(x, result, (1.0, 1.0))
        if node.op == "root":
            allowed = result if node.data % 2 else iv.meet(result, iv.NON_NEGATIVE)
            return iv.meet(x, iv.integer_power(allowed, node.data))
        return iv.solve_function(node.data, x, result)

    def _backward_many(self, node: Node, at: list[Interval], result: Interval) -> None:
        """Each term or factor from the result and the others."""
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
        """Is every step defined for all arguments in the box?"""
        return all(_defined(node, at[node.args[0]]) for node in self.nodes if len(node.args) == 1)

    # -- derivatives ----------------------------------------------------------------------------------

    def gradient(self, root: int, at: list[Interval]) -> list[Interval]:
        """Bounds of the derivatives of one root by every variable over the box."""
        bars: dict[int, Interval] = {root: (1.0, 1.0)}
        found: list[Interval] = [(0.0, 0.0)] * len(self.variables)
        for i in range(root, -1, -1):
            bar = bars.pop(i, None)
            if bar is None:
                continue
            node = self.nodes[i]
            if node.op == "var":
                found[node.data] = bar
            for j, slope in self._slopes(node, at, i):
                part = iv.mul(bar, slope)
                bars[j] = iv.add(bars[j], part) if j in bars else part
        return found

    def _slopes(self, node: Node, at: list[Interval], i: int) -> list[tuple[int, Interval]]:
        op, args = node.op, node.args
        if op == "add":
            return [(j, (1.0, 1.0)) for j in args]
        if op == "mul":
            found = []
            for k, j in enumerate(args):
                others: Interval = (1.0, 1.0)
                for other, m in enumerate(args):
                    if other != k:
                        others = iv.mul(others, at[m])
                found.append((j, others))
            return found
        if op == "atan2":
            return [(j, iv.WHOLE) for j in args]
        return [(args[0], _slope(node, at[args[0]], at[i]))] if args else []


def _of_one(node: Node, x: Interval) -> Interval:
    """All values of a step with one argument. Raises EmptyError where it has none."""
    if node.op == "pow":
        return iv.integer_power(x, node.data)
    if node.op == "inverse":
        return iv.hull(iv.inverse(x))
    return iv.root(x, node.data) if node.op == "root" else iv.function(node.data, x)


def _defined(node: Node, x: Interval) -> bool:
    if node.op == "inverse":
        return not iv.contains_zero(x)
    if node.op == "root":
        return x[0] >= 0.0 or node.data % 2 == 1
    if node.op == "fn" and node.data in ("asin", "acos"):
        return x[0] >= -1.0 and x[1] <= 1.0
    if node.op == "fn" and node.data == "tan":
        return iv.function("tan", x) != iv.WHOLE
    return node.op != "fn" or node.data != "log" or x[0] > 0.0


def _slope(node: Node, x: Interval, value: Interval) -> Interval:
    """Bounds of the derivative of a step with one argument."""
    if node.op == "pow":
        power = iv.integer_power(x, node.data - 1) if node.data > 1 else (1.0, 1.0)
        return iv.mul((float(node.data), float(node.data)), power)
    if node.op == "inverse":
        return iv.negative(iv.integer_power(value, 2))
    if node.op == "root":
        below = iv.mul((float(node.data), float(node.data)), iv.integer_power(value, node.data - 1))
        return _inverse(below)
    return _function_slope(node.data, x, value)


def _inverse(a: Interval) -> Interval:
    parts = iv.inverse(a)
    return iv.hull(parts) if parts and not a[0] < 0.0 < a[1] else iv.WHOLE


def _function_slope(name: str, x: Interval, value: Interval) -> Interval:
    square = iv.integer_power(x, 2)
    if name == "exp":
        return value
    if name in ("sin", "cos"):
        other = iv.function("cos" if name == "sin" else "sin", x)
        return other if name == "sin" else iv.negative(other)
    if name in ("sinh", "cosh"):
        return iv.function("cosh" if name == "sinh" else "sinh", x)
    if name == "tan":
        return iv.add((1.0, 1.0), iv.integer_power(value, 2))
    if name == "tanh":
        return iv.meet(iv.minus((1.0, 1.0), iv.integer_power(value, 2)), (0.0, 1.0))
    if name == "log":
        return _inverse(x)
    if name == "atan":
        return _inverse(iv.add((1.0, 1.0), square))
    if name in ("asin", "acos"):
        inside = iv.minus((1.0, 1.0), square)
        slope = _inverse(iv.root((max(inside[0], 0.0), max(inside[1], 0.0)), 2))
        return slope if name == "asin" else iv.negative(slope)
    return ((1.0, 1.0) if x[0] > 0 else (-1.0, -1.0) if x[1] < 0 else (-1.0, 1.0)) if name == "abs" else iv.WHOLE


def contract(relations: BoxProgram, box: Box) -> Box:
    """The box less what no solution is in. Raises EmptyError where nothing is left: proved."""
    for _ in range(SWEEPS):
        at = relations.forward(box)
        relations.backward(at)
        narrower = [at[i] for i in relations.var_nodes]
        if not _worth(box, narrower):
            break
        box = narrower
    return _by_slopes(relations, narrower)


def _by_slopes(relations: BoxProgram, box: Box) -> Box:
    """What derivatives exclude, where everything is defined on the whole box (else no mean value theorem holds)."""
    over = relations.forward(box)
    if not relations.equations or not relations.total(over):
        return box
    slopes = [relations.gradient(e, over) for e in relations.equations]
    relations.work += len(slopes) * len(relations.nodes)
    for e, slope in zip(relations.equations, slopes, strict=True):
        _monotone(relations, e, slope, box)
    if any(math.isinf(v) for x in box for v in x):
        return box
    return _newton(relations, box, slopes)


def _monotone(relations: BoxProgram, equation: int, slope: list[Interval], box: Box) -> None:
    """Raise EmptyError where a bound at the ends of monotone variables has a sign."""
    signs = [0 if s == (0.0, 0.0) else 1 if s[0] >= 0.0 else -1 if s[1] <= 0.0 else 0 for s in slope]
    if not any(signs):
        return
    for low in (True, False):
        corner = [
            x if not s else (x[0], x[0]) if (s > 0) == low else (x[1], x[1]) for s, x in zip(signs, box, strict=True)
        ]
        if any(math.isinf(a) and a == b for a, b in corner):
            continue
        found = relations.forward(corner)[equation]
        if found[0] > 0.0 if low else found[1] < 0.0:
            raise EmptyError


def _worth(old: Box, new: Box) -> bool:
    """Did some interval lose a share of its width, or become finite?"""
    for (a, b), (c, d) in zip(old, new, strict=True):
        if (a == -math.inf and c > a) or (b == math.inf and d < b):
            return True
        if b - a < math.inf and d - c < (1 - WORTH) * (b - a):
            return True
    return False


def _newton(relations: BoxProgram, box: Box, slopes: list[list[Interval]]) -> Box:
    """f(c) + f'(box) (box - c) holds 0 [Moore1966], the equations combined to be nearly solved for a variable each."""
    center = [(m, m) for m in map(iv.middle, box)]
    at = relations.forward(center)
    values = [at[e] for e in relations.equations]
    for weights in _combinations(relations, at):
        value, slope = _weighted(weights, values), [_weighted(weights, column) for column in zip(*slopes, strict=True)]
        box = _linear_step(value, slope, box, center)
    return box


def _weighted(weights: Sequence[float], parts: Sequence[Interval]) -> Interval:
    total: Interval = (0.0, 0.0)
    for w, part in zip(weights, parts, strict=True):
        if w:
            total = iv.add(total, iv.mul((w, w), part))
    return total


def _combinations(relations: BoxProgram, at: list[Interval]) -> list[list[float]]:
    """Each equation itself, and combinations that Gauss's elimination of the midpoint Jacobian takes."""
    count = len(relations.equations)
    alone = [[float(i == j) for j in range(count)] for i in range(count)]
    if count == 1:
        return alone
    rows = [[(a + b) / 2 for a, b in relations.gradient(e, at)] for e in relations.equations]
    work = np.array([row + one for row, one in zip(rows, alone, strict=True)])
    if not np.isfinite(work).all():
        return alone
    n = len(rows[0])
    for r in range(min(count, n)):
        sizes = np.abs(work[r:, :n])
        i, c = divmod(int(np.argmax(sizes)), n)
        if sizes[i, c] < TINY:
            break
        work[[r, r + i]] = work[[r + i, r]]
        work[r] /= work[r, c]
        for k in range(count):
            if k != r:
                work[k] -= work[k, c] * work[r]
    return alone + [[float(v) for v in row[n:]] for row in work]


def _linear_step(value: Interval, slope: list[Interval], box: Box, center: Box) -> Box:
    """Every variable from value + slope (x - c) = 0 and the bounds of the others."""
    if any(math.isinf(v) for s in slope for v in s):
        return box
    parts = [iv.mul(s, iv.minus(x, c)) for s, x, c in zip(slope, box, center, strict=True)]
    after = [(0.0, 0.0)]
    for p in reversed(parts):
        after.append(iv.add(after[-1], p))
    iv.meet(iv.add(value, after[-1]), (0.0, 0.0))
    before, narrowed = value, []
    for k, (s, x) in enumerate(zip(slope, box, strict=True)):
        others = iv.add(before, after[len(parts) - 1 - k])
        if iv.contains_zero(s):
            narrowed.append(x)
        else:
            moved = iv.mul(iv.negative(others), iv.inverse(s)[0])
            narrowed.append(iv.meet(x, iv.add(center[k], moved)))
        before = iv.add(before, parts[k])
    return narrowed
