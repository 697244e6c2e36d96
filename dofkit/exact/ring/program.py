"""A straight-line program of rational arithmetic over generators: its instructions, its values and gradients.

The program runs over any numbers with ``+ - * /``: a `Point` supplies the generators' values.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, reduce, wraps
from hashlib import sha256
from operator import add, mul
from typing import Any, ParamSpec, Protocol, TypeVar

from flint import arb
from flint.utils.flint_exceptions import DomainError

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError, PoleError
from dofkit.expressions.tree import Expr

#: A value of whatever the program runs over: an element of GF(p), a ball, a float, a truncated series.
Scalar = Any
#: The operations.
NUM, VAR, ADD, MUL, POW = range(5)


# Exceptions of exact arithmetic: an expression has no value

P = ParamSpec("P")
T = TypeVar("T")
D = TypeVar("D")


class TooLargeError(NoValueError):
    """The canonical form exceeds its bound."""

    reason = "a canonical form grew past its bound"


class OutsideDomainError(NoValueError):
    """A function has no real value at the point."""

    reason = "a function has no real value at the point"


class NoPointError(NoValueError):
    """A random point has no value here (a radicand is no square, a division by zero); another may have one."""

    reason = "no point was found"


def raising_no_value(work: Callable[P, T]) -> Callable[P, T]:
    """Return ``work`` raising PoleError for a division by zero, and NoValueError for FLINT's DomainError."""

    @wraps(work)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> T:
        try:
            return work(*args, **kwargs)
        except NoValueError:
            raise
        except ZeroDivisionError as error:
            raise PoleError(str(error)) from error
        except DomainError as error:
            raise NoValueError(str(error)) from error

    return wrapper


def default_without_value(default: D) -> Callable[[Callable[P, T]], Callable[P, T | D]]:
    """Return a decorator of functions: the result is ``default`` where the function would raise NoValueError."""

    def decorated(function: Callable[P, T]) -> Callable[P, T | D]:
        @wraps(function)
        def result(*args: P.args, **kwargs: P.kwargs) -> T | D:
            try:
                return function(*args, **kwargs)
            except NoValueError:
                return default

        return result

    return decorated


#: Decorators: the result is False ("not proved"), or None, where the function would raise NoValueError.
false_without_value = default_without_value(False)
none_without_value = default_without_value(None)


@dataclass(frozen=True)
class Var:
    """A generator.

    ``kind``: symbol, cos, sin, exp, log, root (``degree``-th), asin, atan, atan2, sign, call or pi; ``key`` identifies
    it; ``args``: the nodes of its arguments; ``partner``: the index of the cos of a sin, or the sin of a cos.
    """

    index: int
    kind: str
    key: Any
    args: tuple[int, ...] = ()
    partner: int = -1
    degree: int = 1


class Point(Protocol):
    """Supplies the numbers of a program and the values of its generators, given those of their arguments."""

    def number(self, value: Fraction) -> Scalar: ...
    def generator(self, var: Var, args: Sequence[Scalar]) -> Scalar: ...


class Instructions(ABC):
    """A program and its generators: ``code`` is a list of distinct (operation, payload), called nodes.

    A payload is a number (NUM), a generator index (VAR), the numbers of nodes (ADD, MUL) or (node, exponent) (POW).
    ``vars`` are the generators, ``var_expr`` their expressions, ``var_node`` their nodes. ``varies``: whether a node
    depends on a symbol. ``positive`` symbols are equal to their absolute value.
    """

    def __init__(self, positive: frozenset[Expr] = frozenset()) -> None:
        self.positive = positive
        self.code: list[tuple[int, Any]] = []
        self.varies: list[bool] = []
        self.vars: list[Var] = []
        self.var_expr: list[Expr] = []
        self.var_node: list[int] = []
        self._orders: dict[tuple[int, ...], list[int]] = {}
        self._interned: dict[tuple[int, Any], int] = {}
        self._var_of: dict[tuple[Any, ...], int] = {}

    @abstractmethod
    def node(self, e: Expr) -> int:
        """Return the number of the instruction that computes ``e``."""

    @cached_property
    def digest(self) -> str:
        """A hash of the program at the first call, the seed of random choices: they are the same on every machine."""
        return sha256(repr(self.code).encode()).hexdigest()

    def emit(self, op: int, payload: Any) -> int:
        """Return the number of the node with this operation and payload, which is added if it is new."""
        key = (op, payload)
        number = self._interned.get(key)
        if number is None:
            number = self._interned[key] = len(self.code)
            self.code.append(key)
            self.varies.append(self._varies(op, payload))
        return number

    def _varies(self, op: int, payload: Any) -> bool:
        if op == VAR:
            return self.vars[payload].kind == "symbol" or any(self.varies[i] for i in self.vars[payload].args)
        return op != NUM and any(self.varies[i] for i in (payload[:1] if op == POW else payload))

    def order(self, roots: tuple[int, ...]) -> list[int]:
        """Return every node that the roots depend on, the last first; remembered, for gradients at many points."""
        instructions = self._orders.get(roots)
        if instructions is None:
            instructions = self._orders[roots] = reachable(self, roots)
        return instructions

    def negative(self, node: int) -> int:
        """Return the node of minus a node."""
        return self.emit(MUL, (self.emit(NUM, Fraction(-1)), node))

    def generator(self, kind: str, key: Any, expression: Expr, args: tuple[int, ...] = (), degree: int = 1) -> int:
        """Return the node of the generator of this kind and key, added at first use with its ``expression``."""
        index = self._var_of.get((kind, key))
        if index is None:
            index = len(self.vars)
            self._var_of[kind, key] = index
            self.vars.append(Var(index, kind, key, args, -1, degree))
            self.var_expr.append(expression)
            self.var_node.append(self.emit(VAR, index))
        return self.var_node[index]

    def symbol(self, e: Expr) -> int:
        """Return the node of a symbol."""
        return self.generator("symbol", e, e)

    def var_index(self, e: Expr) -> int | None:
        """Return the generator index of a symbol; None if it does not occur."""
        return self._var_of.get(("symbol", e))

    def number(self, value: Fraction | int) -> int:
        return self.emit(NUM, Fraction(value))

    def total(self, *terms: int) -> int:
        return self.emit(ADD, terms)

    def product(self, *factors: int) -> int:
        return self.emit(MUL, factors)

    def power_node(self, base: int, exponent: int) -> int:
        """Return the node of an integer power of a node."""
        return base if exponent == 1 else self.emit(POW, (base, exponent))


def reachable(program: Instructions, roots: Iterable[int], through_generators: bool = True) -> list[int]:
    """Return every node that the roots depend on (``through_generators``: also by their arguments), the last first."""
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


@raising_no_value
def value_of(ring: Instructions, point: Point, node: int, through_generators: bool = True) -> Scalar:
    """Return the value of one node, computing only the nodes that it needs; raises PoleError at a pole.

    Without ``through_generators`` the point supplies generators without the values of their arguments.
    """
    out: dict[int, Scalar] = {}
    for i in reversed(reachable(ring, [node], through_generators)):
        op, payload = ring.code[i]
        if op == NUM:
            out[i] = point.number(payload)
        elif op == VAR:
            var = ring.vars[payload]
            out[i] = point.generator(var, [out[j] for j in var.args] if through_generators else ())
        elif op == POW:
            base, n = payload
            out[i] = _power(out[base], n)
        else:
            out[i] = reduce(mul if op == MUL else add, [out[j] for j in payload])
    return out[node]


@false_without_value
def vanish(ring: Instructions, point: Point, nodes: Sequence[int]) -> bool:
    """Return whether all ``nodes`` are 0 at a point; False if the program has no value there."""
    at = values(ring, point)
    return all(at[n] == 0 for n in nodes)


@raising_no_value
def values(ring: Instructions, point: Point, upto: int | None = None) -> list[Scalar]:
    """Return the values of all nodes (or the first ``upto``) at a point; raises PoleError at a pole."""
    check()
    out: list[Scalar] = []
    push = out.append
    for op, payload in ring.code[:upto]:
        if op == MUL:
            push(out[payload[0]] * out[payload[1]] if len(payload) == 2 else reduce(mul, [out[i] for i in payload]))
        elif op == ADD:
            push(out[payload[0]] + out[payload[1]] if len(payload) == 2 else reduce(add, [out[i] for i in payload]))
        elif op == VAR:
            var = ring.vars[payload]
            push(point.generator(var, [out[i] for i in var.args]))
        elif op == NUM:
            push(point.number(payload))
        else:
            base, exponent = payload
            push(_power(out[base], exponent))
    return out


def _power(value: Scalar, n: int) -> Scalar:
    """Return value^n for n != 0; raises PoleError if the value is 0, or a ball that contains 0, and n < 0."""
    if n > 0:
        return integer_power(value, n)
    inverse = 1 / integer_power(value, -n)
    if isinstance(inverse, arb) and not inverse.is_finite():
        raise PoleError
    return inverse


def integer_power(value: Scalar, n: int) -> Scalar:
    """Return value^n for n > 0; balls are multiplied, because FLINT's power is NaN for a ball that contains 0."""
    if not isinstance(value, arb):
        return value**n
    total = value
    for bit in bin(n)[3:]:
        total = total * total
        if bit == "1":
            total = total * value
    return total


def partials(ring: Instructions, var: Var, at: Sequence[Scalar], point: Point) -> list[tuple[int, Scalar]]:
    """Return (argument node, d(generator)/d(argument)) for each argument that the generator depends on."""
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
        return [(node, _derivative(var, i, at, point)) for i, node in enumerate(var.args)]
    return []


def _derivative(var: Var, i: int, at: Sequence[Scalar], point: Point) -> Scalar:
    """Return the value of the unknown function differentiated once more by its i-th argument."""
    name, orders, key = var.key
    raised = tuple(o + (i == j) for j, o in enumerate(orders))
    other = Var(-1, "call", (name, raised, key), var.args)
    return point.generator(other, [at[j] for j in var.args])


@raising_no_value
def gradient(
    ring: Instructions, at: Sequence[Scalar], point: Point, seeds: Iterable[tuple[int, Scalar]]
) -> dict[int, Scalar]:
    """Return the gradient of the sum of seed * node over ``seeds``, as {generator index of a symbol: value}."""
    check()
    adjoint: dict[int, Scalar] = {}
    varies = ring.varies
    for node, seed in seeds:
        adjoint[node] = adjoint[node] + seed if node in adjoint else seed
    slopes: dict[int, Scalar] = {}
    for node in ring.order(tuple(adjoint)):
        bar = adjoint.pop(node, None)
        if bar is None:
            continue
        op, payload = ring.code[node]
        if op == ADD:
            for i in payload:
                if varies[i]:
                    adjoint[i] = adjoint[i] + bar if i in adjoint else bar
        elif op == MUL:
            _product_rule(payload, at, bar, adjoint, varies)
        elif op == POW:
            base, n = payload
            part = bar * n * (integer_power(at[base], n - 1) if n > 1 else at[node] / at[base])
            adjoint[base] = adjoint[base] + part if base in adjoint else part
        elif op == VAR:
            var = ring.vars[payload]
            if var.kind == "symbol":
                slopes[payload] = bar
            for i, factor in partials(ring, var, at, point):
                part = bar * factor
                adjoint[i] = adjoint[i] + part if i in adjoint else part
    return slopes


def _product_rule(
    payload: tuple[int, ...], at: Sequence[Scalar], bar: Scalar, adjoint: dict[int, Scalar], varies: Sequence[bool]
) -> None:
    """Add to ``adjoint`` the derivatives of a product whose own adjoint is ``bar``."""
    for place, i in enumerate(payload):
        if varies[i]:
            part = bar
            for other, j in enumerate(payload):
                if other != place:
                    part = part * at[j]
            adjoint[i] = adjoint[i] + part if i in adjoint else part
