"""Values and gradients of trees in floats: good for looking, never for deciding."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction

from dofkit.checker.trees import Tree

Gradient = dict[str, float]
Estimate = tuple[float, Gradient]


class NoEstimateError(Exception):
    """A tree has no value in floats here."""


class Values:
    """Values alone at one point."""

    def __init__(self, values: Mapping[str, float]) -> None:
        self.values = values
        self._done: dict[int, tuple[Tree, float]] = {}

    def value(self, tree: Tree) -> float:
        """The value; `NoEstimateError` where there is none."""
        known = self._done.get(id(tree))
        if known is None:
            try:
                known = self._done[id(tree)] = tree, self._read(tree)
            except (ValueError, OverflowError, ZeroDivisionError, KeyError):
                raise NoEstimateError(tree.head) from None
        return known[1]

    def _read(self, tree: Tree) -> float:
        head = tree.head
        if isinstance(tree.value, Fraction):
            return float(tree.value)
        if head == "symbol":
            return self.values[str(tree.value)]
        if head == "pi":
            return math.pi
        below = [self.value(part) for part in tree.below]
        if head == "sum":
            return sum(below)
        if head == "product":
            return math.prod(below)
        if head == "atan2":
            return math.atan2(below[0], below[1])
        if head != "power":
            return _elementary(head, below[0])[0]
        found = below[0] ** below[1]
        if isinstance(found, complex):
            raise NoEstimateError("power")
        return float(found)


class Estimates:
    """Values and gradients at one point, by every symbol."""

    def __init__(self, values: Mapping[str, float]) -> None:
        self.values = values
        self._done: dict[int, tuple[Tree, Estimate]] = {}

    def value(self, tree: Tree) -> float:
        """The value; `NoEstimateError` where there is none."""
        return self.value_and_gradient(tree)[0]

    def gradient(self, tree: Tree) -> Gradient:
        """The derivatives by the symbols that occur."""
        return self.value_and_gradient(tree)[1]

    def value_and_gradient(self, tree: Tree) -> Estimate:
        """Value and gradient."""
        known = self._done.get(id(tree))
        if known is None:
            try:
                known = self._done[id(tree)] = tree, self._read(tree)
            except (ValueError, OverflowError, ZeroDivisionError, KeyError):
                raise NoEstimateError(tree.head) from None
        return known[1]

    def _read(self, tree: Tree) -> Estimate:
        head = tree.head
        if isinstance(tree.value, Fraction):
            return float(tree.value), {}
        if head == "symbol":
            name = str(tree.value)
            return self.values[name], {name: 1.0}
        if head == "pi":
            return math.pi, {}
        below = [self.value_and_gradient(part) for part in tree.below]
        if head == "sum":
            return sum(value for value, _ in below), combined([(1.0, slope) for _, slope in below])
        if head == "product":
            return _product(below)
        if head == "power":
            return _power(below[0], below[1])
        if head == "atan2":
            (y, dy), (x, dx) = below
            size = x * x + y * y
            return math.atan2(y, x), combined([(x / size, dy), (-y / size, dx)])
        value, slope = _elementary(head, below[0][0])
        return value, combined([(slope, below[0][1])])


def combined(parts: list[tuple[float, Gradient]]) -> Gradient:
    """A linear combination of gradients."""
    found: Gradient = {}
    for factor, slope in parts:
        for name, part in slope.items():
            found[name] = found.get(name, 0.0) + factor * part
    return found


def _product(below: list[Estimate]) -> Estimate:
    value, slope = below[0]
    for other, change in below[1:]:
        slope = combined([(other, slope), (value, change)]) if change else {n: other * s for n, s in slope.items()}
        value *= other
    return value, slope


def _power(base: Estimate, exponent: Estimate) -> Estimate:
    (b, db), (e, de) = base, exponent
    value = b**e
    if isinstance(value, complex):
        raise NoEstimateError("power")
    parts = [(e * b ** (e - 1) if e else 0.0, db)]
    if de:
        parts.append((value * math.log(b), de))
    return value, combined(parts)


def _elementary(head: str, u: float) -> tuple[float, float]:
    if head in ("sin", "cos"):
        sine, cosine = math.sin(u), math.cos(u)
        return (sine, cosine) if head == "sin" else (cosine, -sine)
    if head in ("sinh", "cosh", "exp"):
        value: float = getattr(math, head)(u)
        return value, {"sinh": math.cosh, "cosh": math.sinh, "exp": math.exp}[head](u)
    if head in ("tan", "tanh"):
        value = math.tan(u) if head == "tan" else math.tanh(u)
        return value, 1 + value * value if head == "tan" else 1 - value * value
    if head in ("cot", "sec", "csc"):
        sine, cosine = math.sin(u), math.cos(u)
        if head == "cot":
            return cosine / sine, -1 / sine**2
        return (1 / cosine, sine / cosine**2) if head == "sec" else (1 / sine, -cosine / sine**2)
    if head == "sqrt":
        return math.sqrt(u), 0.5 / math.sqrt(u) if u else 0.0
    if head == "abs":
        return abs(u), math.copysign(1.0, u)
    if head == "log":
        return math.log(u), 1 / u
    if head == "atan":
        return math.atan(u), 1 / (1 + u * u)
    if head in ("asin", "acos"):
        slope = 1 / math.sqrt(1 - u * u)
        return (math.asin(u), slope) if head == "asin" else (math.acos(u), -slope)
    raise NoEstimateError(head)
