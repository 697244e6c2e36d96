"""Expressions lowered to rational arithmetic over independent generators.

A `Ring` turns expressions into one shared straight-line program. Functions become *generators* (`Var`): sin and cos of
the angles that the arguments have in common, exp, log, roots, inverse functions, unknown functions, pi. Arguments are
split over a rational basis first (``sin(theta + 2 phi)`` is a polynomial in the sines and cosines of theta and phi), so
that most identities are true in the ring. *An expression that is zero in the ring is zero as a function.* If a relation
among generators is missed, an expression may wrongly seem not to be zero, which balls can show.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from functools import partial, reduce
from math import lcm

from dofkit.base.errors import NoValueError
from dofkit.exact.ring.program import ADD, MUL, NUM, Instructions, Var
from dofkit.exact.ring.radicals import inverse_function, log, over_primes, root, sign
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import linear_terms, sorted_sum, substitute
from dofkit.expressions.tree import Expr

#: sin(n u) is expanded to a polynomial in sin u and cos u up to this n; otherwise it is a new generator.
MAX_MULTIPLE = 64

#: The nodes of the cosine and the sine of an angle.
Turn = tuple[int, int]


def rotated(ring: Instructions, a: Turn, b: Turn) -> Turn:
    """Return cos and sin of the sum of two angles."""
    minus = ring.number(-1)
    return (
        ring.total(ring.product(a[0], b[0]), ring.product(minus, a[1], b[1])),
        ring.total(ring.product(a[0], b[1]), ring.product(a[1], b[0])),
    )


def multiple(ring: Instructions, angle: Turn, n: int) -> Turn:
    """Return cos and sin of n times an angle, n not 0."""
    if n < 0:
        cos, sin = multiple(ring, angle, -n)
        return cos, ring.product(ring.number(-1), sin)
    if n == 1:
        return angle
    half = multiple(ring, angle, n // 2)
    total = rotated(ring, half, half)
    return rotated(ring, total, angle) if n % 2 else total


def of_inverse(ring: Instructions, angle: Expr) -> Turn:
    """Return cos and sin of an angle that is written as asin u, acos u, atan u or atan2(y, x)."""
    u = angle.args[1]
    if angle.args[0] in ("asin", "acos"):
        other = ring.node(ex.sqrt(ex.ONE - u * u))
        return (other, ring.node(u)) if angle.args[0] == "asin" else (ring.node(u), other)
    x = ex.ONE if angle.args[0] == "atan" else angle.args[2]
    inverse = ring.power_node(ring.node(ex.sqrt(x * x + u * u)), -1)
    return ring.product(ring.node(x), inverse), ring.product(ring.node(u), inverse)


def _in_twelfths(factor: Fraction) -> bool:
    return bool((12 * factor).denominator == 1)


def _cosine_of_twelfths(k: int) -> Expr:
    """Return cos(k pi/12) with square roots."""
    return _COSINES[min(k % 24, -k % 24)]


_QUADRANT = tuple(
    ex.num(Fraction(1, 4)) * e
    for e in (
        ex.num(4),
        ex.sqrt(ex.num(6)) + ex.sqrt(ex.TWO),
        ex.TWO * ex.sqrt(ex.num(3)),
        ex.TWO * ex.sqrt(ex.TWO),
        ex.TWO,
        ex.sqrt(ex.num(6)) - ex.sqrt(ex.TWO),
        ex.ZERO,
    )
)
_COSINES = (*_QUADRANT, *(-e for e in _QUADRANT[-2::-1]))


def _angle_arguments(expressions: Iterable[Expr], alias: Mapping[Expr, Expr]) -> dict[tuple[str, Expr], int]:
    """Return {(family, basic angle or exponent): common denominator of its multiples}; families are "cis" and "exp"."""
    denominators: dict[tuple[str, Expr], int] = {}
    for node in _with_functions(expressions):
        family = _family(node) if node.op in ("fn", "pow") else None
        if family:
            argument = node.args[1] if node.op == "fn" else node.args[1] * ex.fn("log", node.args[0])
            argument = substitute(argument, alias)
            argument = over_primes(argument) if "log" in argument.functions else argument
            for term, factor in linear_terms(argument).items():
                if term == ex.PI and family == "cis" and _in_twelfths(factor):
                    continue
                denominators[family, term] = lcm(denominators.get((family, term), 1), factor.denominator)
    return denominators


def _with_functions(expressions: Iterable[Expr]) -> set[Expr]:
    """Return every subexpression that contains a function."""
    nodes: set[Expr] = set()
    pending = [e for e in expressions if e.functions]
    while pending:
        node = pending.pop()
        if node not in nodes:
            nodes.add(node)
            pending.extend(child for child in ex.children(node) if child.functions)
    return nodes


def _family(node: Expr) -> str | None:
    if node.op == "pow":
        return None if node.args[1].op == "num" else "exp"
    if node.args[0] in ("sin", "cos", "tan", "cot", "sec", "csc"):
        return "cis"
    return "exp" if node.args[0] in ("exp", "sinh", "cosh", "tanh") else None


class Ring(Instructions):
    """The program and its generators.

    ``expressions`` are all that will be evaluated: their angles determine the basic angles. ``positive`` symbols are
    equal to their absolute value. ``alias`` replaces symbols in the arguments of functions: with a geometric constraint
    theta = w t, cos(theta) and cos(w t) are one generator.
    """

    def __init__(
        self,
        expressions: Iterable[Expr] = (),
        positive: frozenset[Expr] = frozenset(),
        alias: Mapping[Expr, Expr] | None = None,
    ) -> None:
        super().__init__(positive)
        self._bases: dict[Expr, Expr] = {}
        self.alias = alias or {}
        with_functions = [e for e in expressions if e.functions]
        self._denominators = _angle_arguments(with_functions, self.alias)
        self._memo: dict[Expr, int] = {}
        self._turns: dict[Expr, tuple[int, int]] = {}

    def another(self, expressions: Iterable[Expr]) -> Ring:
        """Return an empty ring for other expressions, with basic angles so fine that its points are points of this."""
        ring = Ring(expressions, self.positive, self.alias)
        for key, denominator in self._denominators.items():
            ring._denominators[key] = lcm(ring._denominators.get(key, denominator), denominator)
        return ring

    def _denominator(self, family: str, argument: Expr, factor: Fraction) -> int:
        """Return the denominator of a basic argument; raises NoValueError if ``factor`` is not a multiple of 1/it."""
        denominator = self._denominators.setdefault((family, argument), factor.denominator)
        if denominator % factor.denominator:
            raise NoValueError("an argument occurs in smaller parts than the ring was made for")
        return denominator

    def node(self, e: Expr) -> int:
        """Return the number of the instruction that computes ``e``; raises PoleError where it divides by 0."""
        number = self._memo.get(e)
        if number is None:
            op = e.op
            if op == "add" or op == "mul":
                number = self.emit(ADD if op == "add" else MUL, self._nodes(e.args))
            else:
                number = _BUILDING[op](self, e)
            self._memo[e] = number
        return number

    def _number(self, e: Expr) -> int:
        return self.emit(NUM, e.args[0])

    def _nodes(self, children: Iterable[Expr]) -> tuple[int, ...]:
        memo = self._memo
        return tuple([memo[e] if e in memo else self.node(e) for e in children])

    def _constant(self, e: Expr) -> int:
        if e.args[0] == "E":
            return self.node(Expr("fn", ("exp", ex.ONE)))
        return self.generator("pi", "pi", ex.PI)

    def _power(self, e: Expr) -> int:
        base, exponent = e.args
        if exponent.op != "num":
            return self._exp(exponent * ex.fn("log", base))
        value: Fraction = exponent.args[0]
        if value.denominator == 1:
            return self.power_node(self.node(base), int(value))
        return self.power_node(root(self, base, value.denominator), value.numerator)

    def _function(self, e: Expr) -> int:
        name, u = e.args[0], e.args[1]
        if name in ("sin", "cos", "tan", "cot", "sec", "csc"):
            cos, sin = self._cis(u)
            quotients = {"tan": (sin, cos), "cot": (cos, sin), "sec": (None, cos), "csc": (None, sin)}
            if name in ("sin", "cos"):
                return sin if name == "sin" else cos
            top, bottom = quotients[name]
            below = self.power_node(bottom, -1)
            return below if top is None else self.product(top, below)
        if name in ("sinh", "cosh", "tanh"):
            return self._hyperbolic(name, u)
        if name == "exp":
            return self._exp(u)
        if name == "abs":
            return self.product(sign(self, u), self.node(u))
        return log(self, u) if name == "log" else inverse_function(self, name, e)

    def _hyperbolic(self, name: str, u: Expr) -> int:
        up, down = self._exp(u), self._exp(-u)
        minus = self.product(self.number(-1), down)
        if name == "tanh":
            return self.product(self.total(up, minus), self.power_node(self.total(up, down), -1))
        return self.product(self.number(Fraction(1, 2)), self.total(up, down if name == "cosh" else minus))

    @property
    def related(self) -> bool:
        """Whether a function of an argument and of a large multiple of it (`MAX_MULTIPLE`) are separate generators."""
        arguments = {(v.kind, v.key[0]) for v in self.vars if v.kind in ("exp", "cos")}
        bases = [(kind, self._bases.get(argument, argument)) for kind, argument in arguments]
        return len(set(bases)) < len(bases)

    @property
    def signs(self) -> int:
        """The number of signs that vary: random points over GF(p) show some of their choices only."""
        return sum(v.kind == "sign" and bool(self.var_expr[v.index].symbols) for v in self.vars)

    def _large_multiple(self, argument: Expr, size: Fraction) -> Expr:
        """Return a multiple of an argument as a new basic argument, recorded for `related`."""
        multiple = Expr("mul", (ex.num(size), argument))
        self._bases[multiple] = argument
        return multiple

    def _exp(self, u: Expr) -> int:
        """Return the node of exp u, a product of powers of basic exponentials; exp(r log x) becomes x^r."""
        u = over_primes(substitute(u, self.alias))
        factors = []
        for term, factor in linear_terms(u).items():
            if term.op == "fn" and term.args[0] == "log":
                factors.append(self.node(ex.power(term.args[1], ex.num(factor))))
                continue
            denominator = self._denominator("exp", term, factor)
            if abs(factor * denominator) > MAX_MULTIPLE:
                term, factor, denominator = self._large_multiple(term, abs(factor)), factor / abs(factor), 1
            basic = ex.num(Fraction(1, denominator)) * term
            generator = self.generator("exp", (term, denominator), Expr("fn", ("exp", basic)), (self.node(basic),))
            factors.append(self.power_node(generator, int(factor * denominator)))
        return self.product(*factors) if factors else self.number(1)

    def _cis(self, u: Expr) -> tuple[int, int]:
        """Return (cos u, sin u) as polynomials in the cosines and sines of basic angles."""
        turn = self._turns.get(u)
        if turn is None:
            turn = self._turns[u] = self._turn(u)
        return turn

    def _turn(self, u: Expr) -> tuple[int, int]:
        """Return (cos u, sin u) by the addition theorem over the terms of u."""
        u = substitute(u, self.alias)
        turns = []
        for angle, factor in linear_terms(u).items():
            if angle == ex.PI and _in_twelfths(factor):
                k = int(12 * factor)
                turns.append((self.node(_cosine_of_twelfths(k)), self.node(_cosine_of_twelfths(k - 6))))
            else:
                cos, sin, n = self._basic_angle(angle, factor)
                turns.append(multiple(self, (cos, sin), n))
        return reduce(partial(rotated, self), turns) if turns else (self.number(1), self.number(0))

    def _basic_angle(self, angle: Expr, factor: Fraction) -> tuple[int, int, int]:
        """Return (cos b, sin b, n) for a basic angle b with factor * angle = n b."""
        denominator = self._denominator("cis", angle, factor)
        if abs(factor * denominator) > MAX_MULTIPLE:
            angle, factor, denominator = self._large_multiple(angle, abs(factor)), factor / abs(factor), 1
        if denominator == 1 and angle.op == "fn" and angle.args[0] in ("asin", "acos", "atan", "atan2"):
            return (*of_inverse(self, angle), int(factor))
        basic = ex.num(Fraction(1, denominator)) * angle
        argument = self.node(basic)
        cos = self.generator("cos", (angle, denominator), ex.fn("cos", basic), (argument,))
        sin = self.generator("sin", (angle, denominator), ex.fn("sin", basic), (argument,))
        first, second = self.code[cos][1], self.code[sin][1]
        self.vars[first] = Var(first, "cos", (angle, denominator), (argument,), second)
        self.vars[second] = Var(second, "sin", (angle, denominator), (argument,), first)
        return cos, sin, int(factor * denominator)

    def _call(self, e: Expr) -> int:
        name, orders, arguments = e.args
        key = (name, orders, tuple(sorted_sum(a) for a in arguments))
        return self.generator("call", key, e, tuple(self.node(a) for a in arguments))


#: The methods that build the nodes of expressions other than sums and products, by operation.
_BUILDING: dict[str, Callable[[Ring, Expr], int]] = {
    "num": Ring._number,
    "sym": Ring.symbol,
    "const": Ring._constant,
    "pow": Ring._power,
    "fn": Ring._function,
    "call": Ring._call,
}
