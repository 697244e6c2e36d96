"""Linear rows, coefficients by column, and vectors: of integers that stand for GF(p), of fractions or of floats."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

Numbers = Sequence[Any]
LinearRow = dict[int, Any]


def combined(parts: Iterable[tuple[Any, Mapping[int, Any]]]) -> LinearRow:
    """The sum of numbers times rows."""
    found: LinearRow = {}
    for factor, row in parts:
        for c, v in row.items():
            found[c] = found.get(c, 0) + factor * v
    return found


def along(direction: Numbers, rows: Sequence[LinearRow]) -> LinearRow:
    """The component along a direction of a vector of rows."""
    return combined(zip(direction, rows, strict=True))


def across(direction: Numbers, rows: Sequence[LinearRow]) -> Iterator[LinearRow]:
    """The d - 1 components across a direction of a vector of rows."""
    return (along(u, rows) for u in spanning(direction))


def less(second: Sequence[LinearRow], first: Sequence[LinearRow]) -> list[LinearRow]:
    """second - first."""
    return [combined(((1, b), (-1, a))) for a, b in zip(first, second, strict=True)]


def spanning(n: Numbers) -> list[tuple[Any, ...]]:
    """Directions across n: d - 1 of them."""
    if len(n) == 2:
        return [(-n[1], n[0])]
    pivot = next(i for i in reversed(range(len(n))) if n[i] != 0)
    found = []
    for i in range(len(n)):
        if i != pivot:
            parts = [0] * len(n)
            parts[i], parts[pivot] = n[pivot], -n[i]
            found.append(tuple(parts))
    return found


def cross(a: Numbers, b: Numbers) -> tuple[Any, ...]:
    """a x b in space."""
    return tuple(a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1)))
