"""What the rules for roots, logarithms and angles ask of the ring that they write into."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, Protocol

from dofkit.expressions.tree import Expr


class Builder(Protocol):
    """Instructions are numbered; see `dofkit.exact.ring.ring.Ring`."""

    positive: frozenset[Expr]
    alias: Mapping[Expr, Expr]

    def node(self, e: Expr) -> int: ...
    def number(self, value: Fraction | int) -> int: ...
    def total(self, *parts: int) -> int: ...
    def product(self, *parts: int) -> int: ...
    def power_node(self, node: int, exponent: int) -> int: ...
    def generator(self, kind: str, key: Any, shown: Expr, args: tuple[int, ...] = (), degree: int = 1) -> int: ...
