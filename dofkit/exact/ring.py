"""Expressions lowered to rational arithmetic over independent generators.

A `Ring` turns expressions into one shared straight-line program. What is not rational arithmetic
becomes a *generator* (`Var`): sin and cos of the angles that the arguments have in common, exp, log,
roots, inverse functions, unknown functions, pi. Arguments are split over a rational basis first
(``sin(theta + 2 phi)`` is a polynomial in the sines and cosines of theta and phi), so that most
identities hold in the ring; then *zero in the ring implies zero of the function*. A relation among
generators that is missed can only make a false non-zero, which the balls find out.

The program runs over any numbers with ``+ - * /``: a `Point` supplies the generators' values.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import gcd
from typing import Any, Protocol

from dofkit import expr as ex
from dofkit.exact.terms import content, linear_terms, sorted_sum
from dofkit.expr import Expr

#: A value of whatever the program runs over: an element of GF(p), a ball, a float, a truncated series.
Scalar = Any

NUM, VAR, ADD, MUL, POW = range(5)

#: sin(n u) is a polynomial in sin u and cos u up to this n; beyond, it is a generator of its own.
MAX_MULTIPLE = 64


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


def _angle_arguments(expressions: Iterable[Expr], alias: Mapping[Expr, Expr]) -> dict[tuple[str, Expr], int]:
    """For every basic angle or exponent, the common denominator of its multiples."""
    denominators: dict[tuple[str, Expr], int] = {}
    seen: set[Expr] = set()
    for e in expressions:
        if not _has_functions(e):
            continue
        for node in ex.nodes(e):
            if node in seen or node.op not in ("fn", "pow"):
                continue
            seen.add(node)
            family = _family(node)
            if family:
                argument = node.args[1] if node.op == "fn" else node.args[1] * ex.fn("log", node.args[0])
                for rest, factor in linear_terms(ex.substitute(argument, alias)).items():
                    old = denominators.get((family, rest), 1)
                    denominators[family, rest] = old * factor.denominator // gcd(old, factor.denominator)
    return denominators


def _has_functions(e: Expr) -> bool:
    return e.op in ("fn", "pow", "call") or any(_has_functions(child) for child in ex.children(e))


def _family(node: Expr) -> str | None:
    if node.op == "pow":
        return None if node.args[1].op == "num" else "exp"
    if node.args[0] in ("sin", "cos", "tan", "cot", "sec", "csc"):
        return "cis"
    return "exp" if node.args[0] in ("exp", "sinh", "cosh", "tanh") else None


class Ring:
    """The program and its generators.

    ``expressions`` are all that will be asked for (their angles fix the basis). ``positive`` symbols are
    their own absolute value. ``alias`` replaces symbols in the arguments of functions: where a finite
    constraint says theta = w t, cos(theta) and cos(w t) are one generator.
    """

    def __init__(
        self,
        expressions: Iterable[Expr] = (),
        positive: frozenset[Expr] = frozenset(),
        alias: Mapping[Expr, Expr] | None = None,
    ) -> None:
        self.related = False
        self.positive = positive
        self.alias = alias or {}
        self.var_expr: list[Expr] = []
        self.code: list[tuple[int, Any]] = []
        self.vars: list[Var] = []
        self.var_node: list[int] = []
        self._denominators = _angle_arguments(expressions, self.alias)
        self._memo: dict[Expr, int] = {}
        self._interned: dict[tuple[int, Any], int] = {}
        self._var_of: dict[tuple[Any, ...], int] = {}
        self._building: dict[str, Callable[[Expr], int]] = {
            "num": lambda e: self.emit(NUM, e.args[0]),
            "sym": self.symbol,
            "const": self._constant,
            "add": lambda e: self.emit(ADD, tuple(self.node(t) for t in e.args)),
            "mul": lambda e: self.emit(MUL, tuple(self.node(t) for t in e.args)),
            "pow": self._power,
            "fn": self._function,
            "call": self._call,
        }

    # -- the program ------------------------------------------------------------------------

    def node(self, e: Expr) -> int:
        """The number of the instruction that computes ``e``."""
        found = self._memo.get(e)
        if found is None:
            found = self._memo[e] = self._building[e.op](e)
        return found

    def emit(self, op: int, payload: Any) -> int:
        key = (op, payload)
        found = self._interned.get(key)
        if found is None:
            found = self._interned[key] = len(self.code)
            self.code.append(key)
        return found

    def negative(self, node: int) -> int:
        """The node of minus a node."""
        return self.emit(MUL, (self.emit(NUM, Fraction(-1)), node))

    def power_node(self, node: int, exponent: int) -> int:
        """The node of an integer power of a node."""
        return self._pow(node, exponent)

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

    def _var(self, kind: str, key: Any, shown: Expr, args: tuple[int, ...] = (), degree: int = 1) -> int:
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
        return self._var("symbol", e, e)

    def var_index(self, e: Expr) -> int | None:
        """The generator of a symbol, if it occurs."""
        return self._var_of.get(("symbol", e))

    def _number(self, value: Fraction | int) -> int:
        return self.emit(NUM, Fraction(value))

    def _add(self, *parts: int) -> int:
        return self.emit(ADD, parts)

    def _mul(self, *parts: int) -> int:
        return self.emit(MUL, parts)

    def _pow(self, base: int, exponent: int) -> int:
        if exponent == 1:
            return base
        return self._number(1) if exponent == 0 else self.emit(POW, (base, exponent))

    # -- what is not rational ---------------------------------------------------------------

    def _constant(self, e: Expr) -> int:
        if e.args[0] == "E":
            return self.node(Expr("fn", ("exp", ex.ONE)))
        return self._var("pi", "pi", ex.PI)

    def _power(self, e: Expr) -> int:
        base, exponent = e.args
        if exponent.op != "num":
            return self._exp(exponent * ex.fn("log", base))
        value: Fraction = exponent.args[0]
        if value.denominator == 1:
            return self._pow(self.node(base), int(value))
        return self._pow(self._root(base, value.denominator), value.numerator)

    def _root(self, radicand: Expr, degree: int) -> int:
        """The real ``degree``-th root; of a product, the product of the roots; of an integer, over its primes."""
        if radicand.op == "mul":
            apart, rest = self.known_signs(radicand)
            if degree % 2:
                apart, rest = list(radicand.args), ex.ONE
            if rest.op != "mul" or apart:
                return self._mul(*(self._root(part, degree) for part in [*apart, *([rest] if rest != ex.ONE else [])]))
        if radicand.op == "pow" and radicand.args[1].op == "num":
            return self._root_of_power(radicand, degree)
        if radicand.op == "num":
            return self._root_of_number(radicand.args[0], degree)
        if radicand.op == "add":
            number, rest = content(radicand)
            if number != 1:
                return self._mul(self._root_of_number(number, degree), self._root(rest, degree))
        return self._new_root((sorted_sum(radicand), degree), radicand, self.node(radicand))

    def known_signs(self, product: Expr) -> tuple[list[Expr], Expr]:
        """(factors that are never negative, the product of the others): only those have roots and logs of their own."""
        apart: list[Expr] = []
        rest: list[Expr] = []
        for part in product.args:
            (apart if self._never_negative(part) else rest).append(part)
        number = next((p for p in rest if p.op == "num"), None)
        if number is not None and number.args[0] != -1:
            apart.append(ex.num(abs(number.args[0])))
            rest = [ex.MINUS_ONE if p is number else p for p in rest]
        return apart, Expr("mul", tuple(rest)) if len(rest) > 1 else rest[0] if rest else ex.ONE

    def _never_negative(self, part: Expr) -> bool:
        if part.op == "num":
            return bool(part.args[0] > 0)
        if part in self.positive or part.op == "const" or (part.op == "fn" and part.args[0] in ("exp", "abs", "cosh")):
            return True
        if part.op != "pow" or part.args[1].op != "num":
            return False
        exponent: Fraction = part.args[1].args[0]
        return exponent.denominator % 2 == 0 or exponent.numerator % 2 == 0 or self._never_negative(part.args[0])

    def _new_root(self, key: tuple[Any, int], radicand: Expr, node: int) -> int:
        degree = key[1]
        shown = Expr("pow", (radicand, ex.num(Fraction(1, degree))))
        return self._var("root", key, shown, (node,), degree)

    def _root_of_power(self, radicand: Expr, degree: int) -> int:
        base, exponent = radicand.args[0], radicand.args[1].args[0]
        whole, rest = divmod(exponent / degree, 1)
        even_inside = exponent.denominator == 1 and exponent % 2 == 0 and degree % 2 == 0
        if rest == 0:
            power = self._pow(self.node(base), int(whole))
            return self._mul(power, self._pow(self._sign(base), int(whole))) if even_inside else power
        reduced = Fraction(exponent, degree)
        if even_inside and reduced.denominator % 2 == 0 and not self._never_negative(base):
            base = ex.fn("abs", base)
        return self._pow(self._root(base, reduced.denominator), reduced.numerator)

    def _root_of_number(self, value: Fraction, degree: int) -> int:
        if value < 0:
            if degree % 2:
                return self._mul(self._number(-1), self._root_of_number(-value, degree))
            return self._new_root((ex.num(value), degree), ex.num(value), self._number(value))
        top = value.numerator * value.denominator ** (degree - 1)
        parts = [self._number(Fraction(1, value.denominator))]
        for prime, power in _factors(top):
            whole, rest = divmod(power, degree)
            parts.append(self._number(prime**whole))
            if rest:
                root = self._new_root((ex.num(prime), degree), ex.num(prime), self._number(prime))
                parts.append(self._pow(root, rest))
        return self._mul(*parts)

    def _sign(self, e: Expr) -> int:
        """The sign of ``e``, with square 1 and derivative 0."""
        if e in self.positive or (e.op == "num" and e.args[0] > 0):
            return self._number(1)
        if e.op == "mul":
            return self._mul(*(self._sign(part) for part in e.args))
        if e.op == "pow" and e.args[1].op == "num" and e.args[1].args[0].denominator == 1:
            return self._pow(self._sign(e.args[0]), abs(int(e.args[1].args[0])))
        return self._var("sign", sorted_sum(e), ex.fn("abs", e) / e if not e.is_zero else ex.ZERO, (self.node(e),))

    def _function(self, e: Expr) -> int:
        name, u = e.args[0], e.args[1]
        if name in ("sin", "cos", "tan", "cot", "sec", "csc"):
            cos, sin = self._cis(u)
            inverse = {"tan": (sin, cos), "cot": (cos, sin), "sec": (None, cos), "csc": (None, sin)}
            if name in ("sin", "cos"):
                return sin if name == "sin" else cos
            top, bottom = inverse[name]
            below = self._pow(bottom, -1)
            return below if top is None else self._mul(top, below)
        if name in ("sinh", "cosh", "tanh"):
            return self._hyperbolic(name, u)
        if name == "exp":
            return self._exp(u)
        if name == "abs":
            return self._mul(self._sign(u), self.node(u))
        return self._inverse_function(name, e)

    def _inverse_function(self, name: str, e: Expr) -> int:
        u = e.args[1]
        if name == "log":
            return self._log(u)
        if name == "acos":
            half_pi = ex.HALF * ex.PI
            return self.node(half_pi - ex.fn("asin", u))
        if name == "asin":
            root = self.node(ex.sqrt(ex.ONE - u * u))
            return self._var("asin", sorted_sum(u), e, (self.node(u), root))
        if name == "atan2":
            return self._var("atan2", (u, e.args[2]), e, (self.node(u), self.node(e.args[2])))
        return self._var(name, sorted_sum(u), e, (self.node(u),))

    def _log(self, u: Expr) -> int:
        """log of a product as the sum of logs, of a power as a multiple, of an integer over its primes."""
        if u.op == "mul":
            apart, rest = self.known_signs(u)
            if apart:
                return self._add(*(self._log(part) for part in [*apart, *([rest] if rest != ex.ONE else [])]))
        if u.op == "pow" and (self._never_negative(u.args[0]) or u.args[1].op != "num" or u.args[1].args[0] % 2):
            return self._mul(self.node(u.args[1]), self._log(u.args[0]))
        if u.op == "fn" and u.args[0] == "exp":
            return self.node(u.args[1])
        if u.op == "num" and u.args[0] > 0:
            value = u.args[0]
            powers = _factors(value.numerator) + [(p, -k) for p, k in _factors(value.denominator)]
            logs = [self._mul(self._number(k), self._log_of_prime(p)) for p, k in powers]
            return self._add(*logs) if logs else self._number(0)
        return self._var("log", sorted_sum(u), Expr("fn", ("log", u)), (self.node(u),))

    def _log_of_prime(self, prime: int) -> int:
        return self._var("log", prime, Expr("fn", ("log", ex.num(prime))), (self._number(prime),))

    def _hyperbolic(self, name: str, u: Expr) -> int:
        up, down = self._exp(u), self._exp(-u)
        minus = self._mul(self._number(-1), down)
        if name == "tanh":
            return self._mul(self._add(up, minus), self._pow(self._add(up, down), -1))
        return self._mul(self._number(Fraction(1, 2)), self._add(up, down if name == "cosh" else minus))

    def _exp(self, u: Expr) -> int:
        """exp of a sum as the product of powers of the basic exponentials; exp(r log x) = x^r."""
        u = ex.substitute(u, self.alias)
        parts = []
        for rest, factor in linear_terms(u).items():
            if rest.op == "fn" and rest.args[0] == "log":
                parts.append(self.node(ex.power(rest.args[1], ex.num(factor))))
                continue
            denominator = self._denominators.get(("exp", rest), factor.denominator)
            if abs(factor * denominator) > MAX_MULTIPLE:
                self.related = True
                size = abs(factor)
                rest, factor, denominator = Expr("mul", (ex.num(size), rest)), factor / size, 1
            basic = ex.num(Fraction(1, denominator)) * rest
            generator = self._var("exp", (rest, denominator), Expr("fn", ("exp", basic)), (self.node(basic),))
            parts.append(self._pow(generator, int(factor * denominator)))
        return self._mul(*parts) if parts else self._number(1)

    def _cis(self, u: Expr) -> tuple[int, int]:
        """(cos u, sin u) as polynomials in those of the basic angles."""
        u = ex.substitute(u, self.alias)
        one, zero = self._number(1), self._number(0)
        total = (one, zero)
        for rest, factor in linear_terms(u).items():
            cos, sin, multiple = self._basic_angle(rest, factor)
            total = self._rotate(total, self._multiple((cos, sin), multiple))
        return total

    def _basic_angle(self, rest: Expr, factor: Fraction) -> tuple[int, int, int]:
        denominator = self._denominators.get(("cis", rest), factor.denominator)
        if abs(factor * denominator) > MAX_MULTIPLE:
            self.related = True
            size = abs(factor)
            rest, factor, denominator = Expr("mul", (ex.num(size), rest)), factor / size, 1
        if denominator == 1 and rest.op == "fn" and rest.args[0] in ("asin", "atan", "atan2"):
            return (*self._cis_of_inverse(rest), int(factor))
        basic = ex.num(Fraction(1, denominator)) * rest
        argument = self.node(basic)
        cos = self._var("cos", (rest, denominator), ex.fn("cos", basic), (argument,))
        sin = self._var("sin", (rest, denominator), ex.fn("sin", basic), (argument,))
        first, second = self.code[cos][1], self.code[sin][1]
        if self.vars[first].partner < 0:
            self.vars[first] = Var(first, "cos", (rest, denominator), (argument,), second)
            self.vars[second] = Var(second, "sin", (rest, denominator), (argument,), first)
        return cos, sin, int(factor * denominator)

    def _cis_of_inverse(self, rest: Expr) -> tuple[int, int]:
        u = rest.args[1]
        if rest.args[0] == "asin":
            return self.node(ex.sqrt(ex.ONE - u * u)), self.node(u)
        x = ex.ONE if rest.args[0] == "atan" else rest.args[2]
        inverse = self._pow(self.node(ex.sqrt(x * x + u * u)), -1)
        return self._mul(self.node(x), inverse), self._mul(self.node(u), inverse)

    def _rotate(self, a: tuple[int, int], b: tuple[int, int]) -> tuple[int, int]:
        if a == (self._number(1), self._number(0)):
            return b
        minus = self._number(-1)
        return (
            self._add(self._mul(a[0], b[0]), self._mul(minus, a[1], b[1])),
            self._add(self._mul(a[0], b[1]), self._mul(a[1], b[0])),
        )

    def _multiple(self, angle: tuple[int, int], n: int) -> tuple[int, int]:
        if n < 0:
            cos, sin = self._multiple(angle, -n)
            return cos, self._mul(self._number(-1), sin)
        if n == 0:
            return self._number(1), self._number(0)
        half = self._multiple(angle, n // 2)
        total = angle if n == 1 else self._rotate(half, half)
        return self._rotate(total, angle) if n > 1 and n % 2 else total

    def _call(self, e: Expr) -> int:
        name, orders, arguments = e.args
        key = (name, orders, tuple(sorted_sum(a) for a in arguments))
        return self._var("call", key, e, tuple(self.node(a) for a in arguments))


def reachable(ring: Ring, roots: Iterable[int], through_generators: bool = True) -> list[int]:
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
        op, payload = ring.code[node]
        if op in (ADD, MUL):
            stack.extend(payload)
        elif op == POW:
            stack.append(payload[0])
        elif op == VAR and through_generators:
            stack.extend(ring.vars[payload].args)
            if ring.vars[payload].partner >= 0:
                stack.append(ring.var_node[ring.vars[payload].partner])
    return sorted(seen, reverse=True)


def _factors(value: int) -> list[tuple[int, int]]:
    """Prime powers of a positive integer; a part without small factors beyond 64 bits counts as one."""
    if value == 1:
        return []
    from flint import fmpz

    if value.bit_length() <= 128:
        return [(int(p), int(k)) for p, k in fmpz(value).factor()]
    powers, rest = [], value
    for prime in (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37):
        k = 0
        while rest % prime == 0:
            rest, k = rest // prime, k + 1
        if k:
            powers.append((prime, k))
    return [*powers, (rest, 1)] if rest > 1 else powers
