"""Running a ring's program: values at a point, and gradients by reverse accumulation."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import reduce
from math import prod
from operator import add, mul

from flint import arb

from dofkit.base.deadline import check
from dofkit.exact.errors import raising_no_value
from dofkit.exact.ring.instructions import ADD, MUL, NUM, POW, VAR, Point, Scalar, Var, reachable
from dofkit.exact.ring.ring import Ring


@raising_no_value
def value_of(ring: Ring, point: Point, node: int) -> Scalar:
    """The value of one instruction, from those only that it needs; raises PoleError at a pole."""
    out: dict[int, Scalar] = {}
    for i in reversed(reachable(ring, [node])):
        op, payload = ring.code[i]
        if op == MUL:
            out[i] = prod(out[j] for j in payload)
        elif op == ADD:
            out[i] = sum(out[j] for j in payload)
        elif op == VAR:
            var = ring.vars[payload]
            out[i] = point.generator(var, [out[j] for j in var.args])
        elif op == NUM:
            out[i] = point.number(payload)
        else:
            base, n = payload
            out[i] = integer_power(out[base], n) if n > 0 else 1 / integer_power(out[base], -n)
    return out[node]


@raising_no_value
def values(ring: Ring, point: Point, upto: int | None = None) -> list[Scalar]:
    """The value of every instruction at ``point``; raises PoleError at a pole.

    ``upto`` stops after that many instructions.
    """
    check()
    out: list[Scalar] = []
    push = out.append
    for op, payload in ring.code[:upto]:
        if op == MUL:
            total = out[payload[0]] * out[payload[1]] if len(payload) == 2 else _folded(mul, payload, out)
            push(total)
        elif op == ADD:
            total = out[payload[0]] + out[payload[1]] if len(payload) == 2 else _folded(add, payload, out)
            push(total)
        elif op == VAR:
            var = ring.vars[payload]
            push(point.generator(var, [out[i] for i in var.args]))
        elif op == NUM:
            push(point.number(payload))
        else:
            base, exponent = payload
            push(integer_power(out[base], exponent) if exponent > 0 else 1 / integer_power(out[base], -exponent))
    return out


def _folded(operation: Callable[[Scalar, Scalar], Scalar], payload: Sequence[int], out: Sequence[Scalar]) -> Scalar:
    """The values of some instructions put together, from the first to the last."""
    return reduce(operation, [out[i] for i in payload])


def integer_power(value: Scalar, n: int) -> Scalar:
    """value^n for n > 0; a ball's own power goes through its logarithm and is no number where it contains 0."""
    if not isinstance(value, arb):
        return value**n
    total = value
    for bit in bin(n)[3:]:
        total = total * total
        if bit == "1":
            total = total * value
    return total


def partials(ring: Ring, var: Var, at: Sequence[Scalar], point: Point) -> list[tuple[int, Scalar]]:
    """d(generator)/d(argument node) for each argument it depends on."""
    kind = var.kind
    if kind == "cos":
        return [(var.args[0], -at[ring.var_node[var.partner]])]
    if kind == "sin":
        return [(var.args[0], at[ring.var_node[var.partner]])]
    if kind == "exp":
        return [(var.args[0], at[ring.var_node[var.index]])]
    if kind == "log":
        return [(var.args[0], 1 / at[var.args[0]])]
    if kind == "root":
        return [(var.args[0], at[ring.var_node[var.index]] / (var.degree * at[var.args[0]]))]
    if kind == "asin":
        return [(var.args[0], 1 / at[var.args[1]])]
    if kind == "atan":
        return [(var.args[0], 1 / (1 + at[var.args[0]] * at[var.args[0]]))]
    if kind == "atan2":
        y, x = at[var.args[0]], at[var.args[1]]
        below = 1 / (x * x + y * y)
        return [(var.args[0], x * below), (var.args[1], -y * below)]
    if kind == "call":
        return [(node, _derivative(ring, var, i, at, point)) for i, node in enumerate(var.args)]
    return []


def _derivative(ring: Ring, var: Var, i: int, at: Sequence[Scalar], point: Point) -> Scalar:
    """The value of the unknown function differentiated once more by its i-th argument."""
    name, orders, key = var.key
    raised = tuple(o + (i == j) for j, o in enumerate(orders))
    other = Var(-1, "call", (name, raised, key), var.args)
    return point.generator(other, [at[j] for j in var.args])


@raising_no_value
def gradient(ring: Ring, at: Sequence[Scalar], point: Point, seeds: Iterable[tuple[int, Scalar]]) -> dict[int, Scalar]:
    """The gradient of ``sum seed * value(node)`` by every symbol: ``{generator index: value}``."""
    check()
    adjoint: dict[int, Scalar] = {}
    for node, seed in seeds:
        adjoint[node] = adjoint[node] + seed if node in adjoint else seed
    found: dict[int, Scalar] = {}
    for node in ring.order(tuple(adjoint)):
        bar = adjoint.pop(node, None)
        if bar is None:
            continue
        op, payload = ring.code[node]
        if op == ADD:
            for i in payload:
                adjoint[i] = adjoint[i] + bar if i in adjoint else bar
        elif op == MUL:
            _product_rule(payload, at, bar, adjoint)
        elif op == POW:
            base, n = payload
            part = bar * n * (integer_power(at[base], n - 1) if n > 1 else at[node] / at[base])
            adjoint[base] = adjoint[base] + part if base in adjoint else part
        elif op == VAR:
            var = ring.vars[payload]
            if var.kind == "symbol":
                found[payload] = bar
            for i, factor in partials(ring, var, at, point):
                part = bar * factor
                adjoint[i] = adjoint[i] + part if i in adjoint else part
    return found


def _product_rule(payload: tuple[int, ...], at: Sequence[Scalar], bar: Scalar, adjoint: dict[int, Scalar]) -> None:
    for place, i in enumerate(payload):
        part = bar
        for other, j in enumerate(payload):
            if other != place:
                part = part * at[j]
        adjoint[i] = adjoint[i] + part if i in adjoint else part


def polynomial_nodes(ring: Ring) -> bool:
    """True where the program divides by nothing."""
    return all(op != POW or payload[1] > 0 for op, payload in ring.code)


__all__ = ["gradient", "integer_power", "partials", "polynomial_nodes", "reachable", "value_of", "values"]
