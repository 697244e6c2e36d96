"""Expressions in floating point on arrays, their derivatives and null spaces; for pictures only.

An unknown function is drawn as an example: a rising wave for each argument.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from dofkit.expressions.tree import PI, ZERO, Expr, children, fn, nodes, num, rebuild
from dofkit.pictures.shapes import Array
from dofkit.system import System

Values = Mapping[Expr, Array | float]

_FUNCTIONS: Mapping[str, Callable[..., Array]] = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh, "exp": np.exp, "log": np.log, "abs": np.abs,
    "cot": lambda u: 1.0 / np.tan(u), "sec": lambda u: 1.0 / np.cos(u), "csc": lambda u: 1.0 / np.sin(u),
    "atan2": np.arctan2,
}  # fmt: skip
#: Values of kinds of symbols that are not given; all other kinds are 0.
_DEFAULT = {"parameter": 1.0}
#: The step of difference quotients, and the largest singular value (of rows of length 1) that counts as 0.
STEP, SMALL = 1e-6, 1e-5


def evaluated(e: Expr, values: Values, memo: dict[Expr, Array] | None = None) -> Array:
    """Return the values of an expression as an array, ``nan`` where it has none; ``memo`` keeps those of its nodes."""
    memo = {} if memo is None else memo
    if e not in memo:
        with np.errstate(all="ignore"):
            memo[e] = np.asarray(_value(e, values, memo), dtype=float)
    return memo[e]


def _value(e: Expr, values: Values, memo: dict[Expr, Array]) -> Array | float:
    """Return the value of an expression from those of its operands; an unknown function is replaced by an example."""
    if e.op == "num":
        return float(e.args[0])
    if e.op == "const":
        return math.pi if e.args[0] == "pi" else math.e
    if e.op == "sym":
        return values.get(e, _DEFAULT.get(e.args[0], 0.0))
    if e.op == "call":
        return evaluated(example_of(e), values, memo)
    operands = [evaluated(operand, values, memo) for operand in e.args if isinstance(operand, Expr)]
    if e.op == "add":
        return np.asarray(sum(operands))
    if e.op == "mul":
        return np.asarray(math.prod(operands))
    if e.op == "pow":
        return np.asarray(operands[0] ** operands[1])
    return np.asarray(_FUNCTIONS[e.args[0]](*operands))


def example_of(call: Expr) -> Expr:
    """Return the example for an unknown function: the sum of u/2 + 0.4 sin(w u + p) over its arguments u.

    A derivative of the function gives that of the example; the phase p comes from the name.
    """
    name, orders, arguments = call.args
    phase = num(Fraction(7 * (sum(map(ord, name)) % 9), 10))
    terms = []
    for k, (order, u) in enumerate(zip(orders, arguments, strict=True)):
        wave = num(Fraction(11 + 3 * k, 10))
        if sum(orders) == order:
            sine = fn("sin", wave * u + phase + num(Fraction(order, 2)) * PI)
            terms.append(num(Fraction(2, 5)) * wave**order * sine)
            terms.append(num(Fraction(1, 2)) * (u if order == 0 else num(int(order == 1))))
    return sum(terms, ZERO)


def with_examples(e: Expr) -> Expr:
    """Return an expression with examples instead of its unknown functions."""
    memo: dict[Expr, Expr] = {}
    for node in nodes(e):
        new = rebuild(node, tuple(memo[child] for child in children(node)))
        memo[node] = example_of(new) if new.op == "call" else new
    return memo[e]


def exemplified(system: System) -> System:
    """Return a system with examples instead of its unknown functions."""
    if not system.functions:
        return system
    constraints = tuple(
        c._replace(relations=[r._replace(expr=with_examples(r.expr), domain=()) for r in c.relations])
        for c in system.constraints
    )
    return replace(system, constraints=constraints, functions={})


def values_at(exprs: Sequence[Expr], values: Values) -> Array:
    """Return the values of expressions, one row for each."""
    memo: dict[Expr, Array] = {}
    rows = [evaluated(e, values, memo) for e in exprs]
    shape = np.broadcast_shapes(*(row.shape for row in rows)) if rows else ()
    return np.array([np.broadcast_to(row, shape) for row in rows]).reshape(len(exprs), *shape)


def derivatives(exprs: Sequence[Expr], by: Sequence[Expr], values: Values) -> Array:
    """Return the derivatives of expressions by the symbols ``by``, one row for each, by central differences."""
    half = len(by)
    if not exprs or not by:
        return np.zeros((len(exprs), half))
    shifts = STEP * np.hstack([np.eye(half), -np.eye(half)])
    moved = {s: float(values.get(s, _DEFAULT.get(s.args[0], 0.0))) + shifts[k] for k, s in enumerate(by)}
    rows = values_at(exprs, {**values, **moved})
    if rows.ndim == 1:
        return np.zeros((len(exprs), half))
    return np.nan_to_num((rows[:, :half] - rows[:, half:]) / (2 * STEP))


def with_unit_rows(rows: Array) -> Array:
    """Return rows of length 1, except for those that are 0."""
    size = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.asarray(rows / np.where(size > SMALL, size, 1.0))


def kernel(rows: Array, columns: int, dimension: int | None = None) -> Array:
    """Return a basis of the null space as rows; ``dimension``: its dimension, if it is known."""
    if not rows.size:
        return np.eye(columns)
    _, singular, right = np.linalg.svd(with_unit_rows(rows))
    rank = int(np.sum(singular > SMALL)) if dimension is None else max(0, columns - dimension)
    return np.asarray(right[rank:])
