"""A case's chart put into its equations, with 60 digits. Nothing of dofkit is used."""

from __future__ import annotations

import ast
import operator
import random
import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from mpmath import mp, mpf

from dofkit.benchmark.trials.construction import KnownScene

from .draws import texts, words

#: Digits, and what counts as 0 where a value is no fraction.
DIGITS, ZERO = 60, mpf(10) ** -30
DECIMAL = re.compile(r"(\d+)\.(\d+)")
#: An mpf, of which mpmath has no types.
Number = Any
OPERATORS: Mapping[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}


#: Functions by name; h and f stand for unknown ones.
FUNCTIONS: Mapping[str, Callable[[Number], Number]] = {
    **{
        name: getattr(mp, name)
        for name in ["sin", "cos", "tan", "exp", "log", "sqrt", "atan", "asin", "acos", "sinh", "cosh", "tanh"]
    },
    "abs": abs,
    "h": lambda v: mp.sin(v) + v**2 / 3 + v,
    "f": lambda v: mp.cos(2 * v) + v**3 / 5 - v,
}
#: The step of difference quotients: their error is far below `ZERO`.
STEP = mpf(10) ** -20


def evaluated(text: str, known: Mapping[str, Number]) -> Number:
    """Return the value of a text in names, numbers, + - * / ^ and calls of `FUNCTIONS`."""

    def value(node: ast.expr) -> Number:
        if isinstance(node, ast.BinOp):
            return OPERATORS[type(node.op)](value(node.left), value(node.right))
        if isinstance(node, ast.UnaryOp):
            return -value(node.operand)
        if isinstance(node, ast.Constant):
            return mpf(int(str(node.value)))
        if isinstance(node, ast.Name):
            return +mp.pi if node.id == "pi" else known[node.id]
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            return FUNCTIONS[node.func.id](value(node.args[0]))
        raise ValueError(f"not read: {ast.dump(node)}")

    exact = DECIMAL.sub(lambda found: f"({int(found[1] + found[2])}/1{'0' * len(found[2])})", text)
    return value(ast.parse(exact.replace("^", "**").strip(), mode="eval").body)


def slopes(
    function: Callable[[Mapping[str, Number]], Number], at: Mapping[str, Number], by: Sequence[str]
) -> list[Number]:
    """Return the partial derivatives of a function by some names, as difference quotients."""
    ends = [[function({**at, name: at[name] + step}) for step in (STEP, -STEP)] for name in by]
    return [(above - below) / (2 * STEP) for above, below in ends]


def sides(text: str) -> str:
    """Left less right of an equation."""
    left, equal, right = text.partition("=")
    return f"({left.strip()}) - ({right.strip()})" if equal else left.strip()


def rank(rows: Sequence[Sequence[Number]]) -> int:
    """By elimination with the largest pivots."""
    left, found = [list(row) for row in rows if row], 0
    while left:
        best, c = max(
            ((i, c) for i, row in enumerate(left) for c in range(len(row))), key=lambda p: abs(left[p[0]][p[1]])
        )
        pivot = left.pop(best)
        if abs(pivot[c]) <= ZERO:
            return found
        left = [[v - row[c] / pivot[c] * q for v, q in zip(row, pivot, strict=True)] for row in left]
        found += 1
    return found


class Confirmation(NamedTuple):
    """``residue``: the largest value of a finite relation on the chart; ``dimension``: the rank of the chart;
    ``velocities``: what the forms leave of its directions; ``regular``: coordinates less the rank of the finite
    relations there, never less than the dimension of the set."""

    residue: Number
    dimension: int
    velocities: int
    regular: int

    @property
    def holds(self) -> bool:
        """Are the relations 0 on the chart, to half of the digits?"""
        return bool(self.residue < ZERO)


def confirmed(case: KnownScene, seed: int = 1) -> Confirmation:
    """The chart at a random point."""
    with mp.workdps(DIGITS):
        return _confirmed(case, random.Random(seed))


def _confirmed(case: KnownScene, rng: random.Random) -> Confirmation:
    assert case.chart is not None
    chart, names = case.chart, list(case.scene["coordinates"])
    many = max((int(k) + 1 for text in chart.values() for k in re.findall(r"\bp(\d+)\b", text)), default=0)
    parameters = [f"p{k}" for k in range(many)]
    symbols = (*parameters, "t", *case.scene.get("parameters", ()))
    chosen = {name: mpf(rng.randint(20, 60)) / rng.randint(31, 67) for name in symbols}

    def placed(values: Mapping[str, Number]) -> dict[str, Number]:
        known = dict(values)
        for name, text in chart.items():
            known[name] = evaluated(text, known)
        return known

    known = placed(chosen)
    finite, forms = _split(case)
    residue = max((abs(evaluated(sides(text), known)) for text in finite), default=0)
    regular = len(names) - rank([slopes(partial(evaluated, sides(text)), known, names) for text in finite])
    directions = {c: slopes(lambda values, c=c: placed(values)[c], chosen, parameters) for c in names}
    dimension = rank(list(directions.values()))
    pulled = [[_along(text, known, directions, k) for k in range(many)] for text in forms]
    return Confirmation(residue, dimension, dimension - rank(pulled), regular)


def _split(case: KnownScene) -> tuple[list[str], list[str]]:
    """Finite relations and forms."""
    moving = {word for c in case.scene["coordinates"] for word in (f"d{c}", f"{c}dot")}
    written = texts(case.scene)
    return [text for text in written if not words(text) & moving], [text for text in written if words(text) & moving]


def _along(text: str, known: Mapping[str, Number], directions: Mapping[str, Sequence[Number]], k: int) -> Number:
    """A form's value on the chart's k-th direction."""
    speeds = {word: row[k] for c, row in directions.items() for word in (f"d{c}", f"{c}dot")}
    return evaluated(sides(text), {**known, **speeds})
