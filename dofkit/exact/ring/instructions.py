"""A straight-line program of rational arithmetic over generators: its instructions, and how they are emitted.

The program runs over any numbers with ``+ - * /``: a `Point` supplies the generators' values.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from hashlib import sha256
from typing import Any, Protocol

from dofkit.expressions.tree import Expr

#: A value of whatever the program runs over: an element of GF(p), a ball, a float, a truncated series.
Scalar = Any
#: The operations.
NUM, VAR, ADD, MUL, POW = range(5)


@dataclass(frozen=True)
class Var:
    """A generator.

    ``kind``: symbol, cos, sin, exp, log, root (``degree``-th), asin, atan, atan2, sign, call or pi;
    ``key`` identifies it; ``args`` are the nodes of its arguments; ``partner`` is the cos of a sin and
    the sin of a cos.
    """

    index: int
    kind: str
    key: Any
    args: tuple[int, ...] = ()
    partner: int = -1
    degree: int = 1


class Point(Protocol):
    """Supplies the values of generators, each asked for once its arguments are known."""

    def number(self, value: Fraction) -> Scalar: ...
    def generator(self, var: Var, args: Sequence[Scalar]) -> Scalar: ...


class Instructions:
    """A program and its generators: ``code`` holds (operation, payload), each written once.

    ``vars`` are the generators, ``var_expr`` what they are as expressions, ``var_node`` their instructions.
    """

    def __init__(self) -> None:
        self.code: list[tuple[int, Any]] = []
        self.vars: list[Var] = []
        self.var_expr: list[Expr] = []
        self.var_node: list[int] = []
        self._orders: dict[tuple[int, ...], list[int]] = {}
        self._interned: dict[tuple[int, Any], int] = {}
        self._var_of: dict[tuple[Any, ...], int] = {}

    @cached_property
    def digest(self) -> str:
        """A hash of the program when it was first asked for: what is drawn by it is the same wherever it runs."""
        return sha256(repr(self.code).encode()).hexdigest()

    def emit(self, op: int, payload: Any) -> int:
        """The number of an instruction."""
        key = (op, payload)
        found = self._interned.get(key)
        if found is None:
            found = self._interned[key] = len(self.code)
            self.code.append(key)
        return found

    def order(self, roots: tuple[int, ...]) -> list[int]:
        """Every instruction that the roots depend on, the last first: worked out once, for gradients at many points."""
        found = self._orders.get(roots)
        if found is None:
            found = self._orders[roots] = reachable(self, roots)
        return found

    def negative(self, node: int) -> int:
        """The node of minus a node."""
        return self.emit(MUL, (self.emit(NUM, Fraction(-1)), node))

    def replaced(self, node: int, mapping: Mapping[int, int]) -> int:
        """A node with generators (by index) replaced by nodes; arguments of other generators are left."""
        new: dict[int, int] = {}
        for i in reversed(reachable(self, [node], through_generators=False)):
            op, payload = self.code[i]
            if op in (ADD, MUL):
                new[i] = self.emit(op, tuple(new[j] for j in payload))
            elif op == POW:
                new[i] = self.emit(POW, (new[payload[0]], payload[1]))
            else:
                new[i] = mapping.get(payload, i) if op == VAR else i
        return new[node]

    def generator(self, kind: str, key: Any, shown: Expr, args: tuple[int, ...] = (), degree: int = 1) -> int:
        """The node of a generator, made at first use; ``shown`` is it as an expression."""
        found = self._var_of.get((kind, key))
        if found is None:
            found = len(self.vars)
            self._var_of[kind, key] = found
            self.vars.append(Var(found, kind, key, args, -1, degree))
            self.var_expr.append(shown)
            self.var_node.append(self.emit(VAR, found))
        return self.var_node[found]

    def symbol(self, e: Expr) -> int:
        """The node of a symbol."""
        return self.generator("symbol", e, e)

    def var_index(self, e: Expr) -> int | None:
        """The generator of a symbol, if it occurs."""
        return self._var_of.get(("symbol", e))

    def number(self, value: Fraction | int) -> int:
        return self.emit(NUM, Fraction(value))

    def total(self, *parts: int) -> int:
        return self.emit(ADD, parts)

    def product(self, *parts: int) -> int:
        return self.emit(MUL, parts)

    def power_node(self, base: int, exponent: int) -> int:
        """The node of an integer power of a node."""
        if exponent == 1:
            return base
        return self.number(1) if exponent == 0 else self.emit(POW, (base, exponent))


def reachable(program: Instructions, roots: Iterable[int], through_generators: bool = True) -> list[int]:
    """Every instruction that the roots depend on, the last first.

    Without ``through_generators`` the walk stops at generators: what they depend on is left out.
    """
    seen: set[int] = set()
    stack = list(roots)
    while stack:
        node = stack.pop()
        if node in seen:
            continue
        seen.add(node)
        op, payload = program.code[node]
        if op in (ADD, MUL):
            stack.extend(payload)
        elif op == POW:
            stack.append(payload[0])
        elif op == VAR and through_generators:
            stack.extend(program.vars[payload].args)
            if program.vars[payload].partner >= 0:
                stack.append(program.var_node[program.vars[payload].partner])
    return sorted(seen, reverse=True)


class Builder(Protocol):
    """What the rules for roots, logarithms and angles use of the ring; `dofkit.exact.ring.ring.Ring` is one."""

    positive: frozenset[Expr]
    alias: Mapping[Expr, Expr]

    def node(self, e: Expr) -> int: ...
    def number(self, value: Fraction | int) -> int: ...
    def total(self, *parts: int) -> int: ...
    def product(self, *parts: int) -> int: ...
    def power_node(self, node: int, exponent: int) -> int: ...
    def generator(self, kind: str, key: Any, shown: Expr, args: tuple[int, ...] = (), degree: int = 1) -> int: ...
