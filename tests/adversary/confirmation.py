"""A case's chart put into its equations, with 60 digits. Nothing of dofkit is used."""

from __future__ import annotations

import ast
import operator
import random
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Dual:
    """A value with its derivatives."""

    value: Number
    slope: tuple[Number, ...]

    def __add__(self, other: Dual) -> Dual:
        return Dual(self.value + other.value, tuple(map(operator.add, self.slope, other.slope)))

    def __neg__(self) -> Dual:
        return Dual(-self.value, tuple(-s for s in self.slope))

    def __sub__(self, other: Dual) -> Dual:
        return self + (-other)

    def __mul__(self, other: Dual) -> Dual:
        pairs = zip(self.slope, other.slope, strict=True)
        return Dual(self.value * other.value, tuple(a * other.value + self.value * b for a, b in pairs))

    def __truediv__(self, other: Dual) -> Dual:
        pairs = zip(self.slope, other.slope, strict=True)
        square = other.value * other.value
        return Dual(self.value / other.value, tuple((a * other.value - self.value * b) / square for a, b in pairs))

    def __pow__(self, other: Dual) -> Dual:
        if any(other.slope):
            raise ValueError("no power with a variable exponent")
        if other.value == int(other.value):
            n = int(other.value)
            inner = n * self.value ** (n - 1) if n else self.value * 0
            return Dual(self.value**n, tuple(inner * s for s in self.slope))
        return self.through(lambda v: v**other.value, lambda v: other.value * v ** (other.value - 1))

    def through(self, f: Callable[[Number], Number], slope: Callable[[Number], Number]) -> Dual:
        """f of it, by the chain rule."""
        inner = slope(self.value)
        return Dual(f(self.value), tuple(inner * s for s in self.slope))


Pair = tuple[Callable[[Number], Number], Callable[[Number], Number]]
#: Functions with their derivatives; h stands for an unknown one.
FUNCTIONS: Mapping[str, Pair] = {
    "sin": (mp.sin, mp.cos),
    "cos": (mp.cos, lambda v: -mp.sin(v)),
    "tan": (mp.tan, lambda v: 1 / mp.cos(v) ** 2),
    "exp": (mp.exp, mp.exp),
    "log": (mp.log, lambda v: 1 / v),
    "sqrt": (mp.sqrt, lambda v: 1 / (2 * mp.sqrt(v))),
    "atan": (mp.atan, lambda v: 1 / (1 + v * v)),
    "asin": (mp.asin, lambda v: 1 / mp.sqrt(1 - v * v)),
    "acos": (mp.acos, lambda v: -1 / mp.sqrt(1 - v * v)),
    "sinh": (mp.sinh, mp.cosh),
    "cosh": (mp.cosh, mp.sinh),
    "tanh": (mp.tanh, lambda v: 1 / mp.cosh(v) ** 2),
    "abs": (abs, mp.sign),
    "h": (lambda v: mp.sin(v) + v**2 / 3 + v, lambda v: mp.cos(v) + 2 * v / 3 + 1),
    "f": (lambda v: mp.cos(2 * v) + v**3 / 5 - v, lambda v: -2 * mp.sin(2 * v) + 3 * v**2 / 5 - 1),
}


def evaluated(text: str, known: Mapping[str, Dual]) -> Dual:
    """A text in names, numbers, + - * / ^ and calls of `FUNCTIONS`."""
    none = tuple(0 * s for s in next(iter(known.values())).slope)

    def value(node: ast.expr) -> Dual:
        if isinstance(node, ast.BinOp):
            found: Dual = OPERATORS[type(node.op)](value(node.left), value(node.right))
            return found
        if isinstance(node, ast.UnaryOp):
            return -value(node.operand)
        if isinstance(node, ast.Constant):
            return Dual(mpf(int(str(node.value))), none)
        if isinstance(node, ast.Name) and node.id == "pi":
            return Dual(+mp.pi, none)
        if isinstance(node, ast.Name):
            return known[node.id]
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            return value(node.args[0]).through(*FUNCTIONS[node.func.id])
        raise ValueError(f"not read: {ast.dump(node)}")

    exact = DECIMAL.sub(lambda found: f"({int(found[1] + found[2])}/1{'0' * len(found[2])})", text)
    return value(ast.parse(exact.replace("^", "**").strip(), mode="eval").body)


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

    def drawn(slope: Sequence[int]) -> Dual:
        return Dual(mpf(rng.randint(20, 60)) / rng.randint(31, 67), tuple(map(mpf, slope)))

    known = {f"p{k}": drawn([int(i == k) for i in range(many)]) for k in range(many)}
    known |= {name: drawn([0] * many) for name in ("t", *case.scene.get("parameters", ()))}
    for name, text in chart.items():
        known[name] = evaluated(text, known)
    finite, forms = _split(case)
    residue = max((abs(evaluated(sides(text), known).value) for text in finite), default=0)
    values = {name: Dual(dual.value, (mpf(0),) * len(names)) for name, dual in known.items()}
    units = {c: tuple(mpf(c == other) for other in names) for c in names}
    values |= {c: Dual(known[c].value, units[c]) for c in names}
    regular = len(names) - rank([evaluated(sides(text), values).slope for text in finite])
    dimension = rank([known[c].slope for c in names])
    pulled = [[_along(text, known, names, k) for k in range(many)] for text in forms]
    return Confirmation(residue, dimension, dimension - rank(pulled), regular)


def _split(case: KnownScene) -> tuple[list[str], list[str]]:
    """Finite relations and forms."""
    moving = {word for c in case.scene["coordinates"] for word in (f"d{c}", f"{c}dot")}
    written = texts(case.scene)
    return [text for text in written if not words(text) & moving], [text for text in written if words(text) & moving]


def _along(text: str, known: Mapping[str, Dual], names: Sequence[str], k: int) -> Number:
    """A form's value on the chart's k-th direction."""
    speeds = {word: Dual(known[c].slope[k], known[c].slope) for c in names for word in (f"d{c}", f"{c}dot")}
    return evaluated(sides(text), {**known, **speeds}).value
