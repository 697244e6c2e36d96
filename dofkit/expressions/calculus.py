"""Substitution, sums as combinations of their terms, derivatives, and differentials.

Velocities replace differentials by dq = qdot dt: a relation homogeneous of degree k in (dq, dt) is divided by dt^k; a
sum of differentials and terms without differentials is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from functools import partial
from itertools import combinations
from math import gcd

from dofkit.base.errors import TextError
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import MINUS_ONE, ONE, ZERO, Expr, add, call, children, fn, mul, num, power, rebuild


def substitute(e: Expr, mapping: Mapping[Expr, Expr]) -> Expr:
    """Return ``e`` with its symbols replaced by the expressions of ``mapping``, all simultaneously."""
    return _substituted(e, mapping, {})


def _substituted(node: Expr, mapping: Mapping[Expr, Expr], memo: dict[Expr, Expr]) -> Expr:
    if mapping.keys().isdisjoint(node.symbols):
        return node
    if node.op == "sym":
        return mapping[node]
    substituted = memo.get(node)
    if substituted is None:
        operands = tuple([_substituted(child, mapping, memo) for child in children(node)])
        substituted = memo[node] = rebuild(node, operands)
    return substituted


def replace_nodes(e: Expr, mapping: Mapping[Expr, Expr]) -> Expr:
    """Return ``e`` with nodes of any kind, such as sin(x) or 3/2, replaced by expressions, the outermost first."""
    return _replaced(e, dict(mapping))


def _replaced(node: Expr, memo: dict[Expr, Expr]) -> Expr:
    replaced = memo.get(node)
    if replaced is None:
        replaced = memo[node] = rebuild(node, tuple([_replaced(child, memo) for child in children(node)]))
    return replaced


#: A product of sums that would have more terms than this is not multiplied out.
EXPAND_TERMS = 64


def expand(e: Expr) -> Expr:
    """Return ``e`` with products and small powers of sums multiplied out, if they have `EXPAND_TERMS` terms at most."""
    if e.op == "add":
        return add(*(expand(term) for term in e.args))
    if e.op == "mul":
        total: list[Expr] = [ONE]
        for factor in (expand(f) for f in e.args):
            terms = factor.args if factor.op == "add" else (factor,)
            if len(total) * len(terms) > EXPAND_TERMS:
                return e
            total = [mul(a, b) for a in total for b in terms]
        return add(*total)
    if e.op == "pow" and e.args[1].op == "num" and e.args[0].op == "add":
        exponent = e.args[1].args[0]
        if exponent.denominator == 1 and 2 <= exponent <= 4:
            return expand(Expr("mul", (e.args[0],) * int(exponent)))
    return e


def linear_terms(e: Expr) -> dict[Expr, Fraction]:
    """Return ``e`` as {term: nonzero rational coefficient}; the key of the constant term is `ONE`."""
    if e.op == "sym":
        return {e: Fraction(1)}
    total = expand(e)
    terms: dict[Expr, Fraction] = {}
    cancels = False
    for term in total.args if total.op == "add" else (total,):
        factor, base = ex.number_and_rest(term)
        if factor:
            base = Expr("mul", tuple(sorted(base.args, key=repr))) if base.op == "mul" else base  # in a canonical order
            if base in terms:
                factor += terms[base]
                cancels = cancels or not factor
            terms[base] = factor
    return {base: factor for base, factor in terms.items() if factor} if cancels else terms


def sorted_sum(e: Expr) -> tuple[tuple[str, Fraction], ...]:
    """Return the (term as text, coefficient) of ``e``, sorted: a key that does not depend on the order of terms."""
    return tuple(sorted((repr(base), factor) for base, factor in linear_terms(e).items()))


def content(e: Expr) -> tuple[Fraction, Expr]:
    """Return (c, p) with the sum ``e`` = c p, c > 0 rational, and coprime integers as coefficients of p."""
    factors = [ex.number_and_rest(t)[0] for t in e.args]
    top = gcd(*(abs(f.numerator) for f in factors))
    bottom = 1
    for f in factors:
        bottom = bottom * f.denominator // gcd(bottom, f.denominator)
    content = Fraction(top, bottom)
    return content, mul(num(1 / content), e)


def longest_number(expressions: Iterable[Expr]) -> int:
    """Return the bits of the longest numerator or denominator in ``expressions``, 0 without numbers."""
    seen: set[Expr] = set()
    stack, longest = list(expressions), 0
    while stack:
        node = stack.pop()
        if node.op == "num":
            value: Fraction = node.args[0]
            longest = max(longest, value.numerator.bit_length(), value.denominator.bit_length())
        elif node.op != "sym" and node not in seen:
            seen.add(node)
            stack.extend(children(node))
    return longest


_DERIVATIVES: dict[str, Callable[[Expr], Expr]] = {
    "sin": lambda u: fn("cos", u),
    "cos": lambda u: -fn("sin", u),
    "tan": lambda u: power(fn("cos", u), num(-2)),
    "cot": lambda u: -power(fn("sin", u), num(-2)),
    "sec": lambda u: fn("sin", u) * power(fn("cos", u), num(-2)),
    "csc": lambda u: -fn("cos", u) * power(fn("sin", u), num(-2)),
    "asin": lambda u: power(ONE - u * u, num(Fraction(-1, 2))),
    "acos": lambda u: -power(ONE - u * u, num(Fraction(-1, 2))),
    "atan": lambda u: power(ONE + u * u, MINUS_ONE),
    "sinh": lambda u: fn("cosh", u),
    "cosh": lambda u: fn("sinh", u),
    "tanh": lambda u: power(fn("cosh", u), num(-2)),
    "exp": lambda u: fn("exp", u),
    "log": lambda u: power(u, MINUS_ONE),
    "abs": lambda u: u / fn("abs", u),
}


def diff(e: Expr, symbol: Expr) -> Expr:
    """Return the partial derivative of ``e`` by ``symbol``, with all other symbols held constant."""
    return _diff(e, symbol, {})


def _diff(node: Expr, symbol: Expr, memo: dict[Expr, Expr]) -> Expr:
    if node is symbol or node == symbol:
        return ONE
    if symbol not in node.symbols:
        return ZERO
    derivative = memo.get(node)
    if derivative is None:
        derivative = memo[node] = _diff_node(node, partial(_diff, symbol=symbol, memo=memo))
    return derivative


def _diff_node(node: Expr, go: Callable[[Expr], Expr]) -> Expr:
    """Return the derivative of ``node`` by the rule for its ``op``; ``go`` differentiates the arguments."""
    if node.op == "add":
        return add(*(go(term) for term in node.args))
    if node.op == "mul":
        factors = node.args
        return add(*(mul(go(part), *factors[:i], *factors[i + 1 :]) for i, part in enumerate(factors)))
    if node.op == "pow":
        base, exponent = node.args
        if exponent.op == "num":
            return mul(exponent, power(base, exponent - 1), go(base))
        by_base = ZERO if (slope := go(base)).is_zero else exponent * slope / base
        return mul(node, go(exponent) * fn("log", base) + by_base)
    if node.op == "call":
        name, orders, arguments = node.args
        raised = (tuple(o + (i == j) for j, o in enumerate(orders)) for i in range(len(orders)))
        return add(*(mul(call(name, arguments, up), go(a)) for up, a in zip(raised, arguments, strict=True)))
    if node.args[0] == "atan2":
        y: Expr
        x: Expr
        y, x = node.args[1:]
        return (x * go(y) - y * go(x)) / (x * x + y * y)
    argument: Expr = node.args[1]
    return mul(_DERIVATIVES[node.args[0]](argument), go(argument))


#: Functions that accept differentials: abs has the degree of its argument, atan2 depends only on the ratio of its two.
HOMOGENEOUS = ("abs", "atan2")


def differential_degree(e: Expr) -> int | None:
    """Return the degree of ``e`` in (dq, dt), None for the number 0. Raises TextError if ``e`` is not homogeneous."""
    if e.is_zero:
        return None
    if not any(map(is_differential, e.symbols)):
        return 0
    if e.op == "sym":
        return 1
    if e.op == "add":
        degrees = {differential_degree(term) for term in e.args} - {None}
        if len(degrees) > 1:
            raise TextError(
                "differentials and finite terms are added together",
                hint="divide every term by dt (write qdot), or multiply every term by a differential",
            )
        return degrees.pop() if degrees else None
    if e.op == "mul":
        return sum(differential_degree(factor) or 0 for factor in e.args)
    if e.op == "pow" and e.args[1].op == "num":
        degree = (differential_degree(e.args[0]) or 0) * e.args[1].args[0]
        if degree.denominator == 1:
            return int(degree)
    if e.op == "fn":
        inside = {differential_degree(u) or 0 for u in e.args[1:]}
        if inside == {0} or (len(inside) == 1 and e.args[0] in HOMOGENEOUS):
            return inside.pop() if e.args[0] == "abs" else 0
    raise TextError("a differential stands inside a function", hint="differentials are only added, multiplied, divided")


def in_velocities(e: Expr) -> tuple[Expr, bool]:
    """Return ``e`` divided by dt^degree, in velocities instead of differentials, and whether the degree was not 0."""
    degree = differential_degree(e)
    if not degree and not any(map(is_differential, e.symbols)):
        return e, False
    mapping = {s: ex.velocity(s.args[1]) for s in e.symbols if s.args[0] == "differential"}
    mapping |= {s: ex.ONE for s in e.symbols if s.args[0] == "dt"}
    return substitute(e, mapping), bool(degree)


def cleared(e: Expr) -> Expr:
    """Return ``e`` times the velocity denominators of its terms, so that dy/dx = f becomes dy - f dx = 0."""
    if e.op == "mul":
        return ex.mul(*map(cleared, e.args))
    if _is_velocity_denominator(e):
        return ex.ONE
    if e.op != "add":
        return e
    powers: dict[Expr, Fraction] = {}
    for term in e.args:
        for factor in filter(_is_velocity_denominator, term.args if term.op == "mul" else (term,)):
            base, exponent = factor.args[0], factor.args[1].args[0]
            powers[base] = min(exponent, powers.get(base, exponent))
    denominator = ex.mul(*(ex.power(base, ex.num(-exponent)) for base, exponent in powers.items()))
    return ex.add(*(ex.mul(denominator, term) for term in e.args)) if powers else e


def _is_velocity_denominator(factor: Expr) -> bool:
    """Return whether a factor is a negative power of an expression in velocities."""
    negative = factor.op == "pow" and factor.args[1].op == "num" and factor.args[1].args[0] < 0
    return negative and any(s.args[0] == "velocity" for s in factor.symbols)


def refuse_accelerations(e: Expr) -> None:
    """Raise TextError for an expression in which second derivatives occur."""
    if any(s.args[0] == "acceleration" for s in e.symbols):
        raise TextError(
            "a relation with a second derivative is not a constraint on positions or velocities",
            hint="integrate it by hand and write the result, or leave it to the equations of motion",
        )


_RATES: dict[str, Callable[[str], Expr]] = {
    "coordinate": ex.velocity, "velocity": partial(ex.sym, "acceleration"), "time": lambda _: ex.ONE,
}  # fmt: skip
_DIFFERENTIALS: dict[str, Callable[[str], Expr]] = {"coordinate": ex.differential, "time": lambda _: ex.DT}


def by_time(e: Expr) -> Expr | None:
    """Return the total derivative of ``e`` by time, or None if an acceleration or a differential occurs in it."""
    return _by_the_chain_rule(e, _RATES)


def total_differential(e: Expr) -> Expr | None:
    """Return the differential of ``e``, or None if a velocity, an acceleration or a differential occurs in it."""
    return _by_the_chain_rule(e, _DIFFERENTIALS)


def _by_the_chain_rule(e: Expr, rates: Mapping[str, Callable[[str], Expr]]) -> Expr | None:
    """Return the sum over the symbols s of ``e`` of d e/d s times the rate of s, or None if some s has no rate.

    Parameters are constant.
    """
    terms = []
    for symbol in sorted(e.symbols, key=lambda s: s.args):
        kind, name = symbol.args
        if kind in rates:
            terms.append(ex.mul(diff(e, symbol), rates[kind](name)))
        elif kind != "parameter":
            return None
    return ex.add(*terms)


def over_dt(e: Expr) -> Expr | None:
    """Return ``e`` divided by dt if it is dt, dq (which gives qdot) or linear in differentials, else None."""
    if e.op == "sym":
        if e == ex.DT:
            return ex.ONE
        return ex.velocity(e.args[1]) if e.args[0] == "differential" else None
    if e.op == "add":
        terms = [over_dt(term) for term in e.args]
        divided = [term for term in terms if term is not None]
        return ex.add(*divided) if len(divided) == len(terms) else None
    if e.op == "mul":
        moving = [i for i, part in enumerate(e.args) if any(is_differential(s) for s in part.symbols)]
        if len(moving) == 1 and (rate := over_dt(e.args[moving[0]])) is not None:
            return ex.mul(*e.args[: moving[0]], rate, *e.args[moving[0] + 1 :])
    return None


def is_differential(e: Expr) -> bool:
    """Return whether ``e`` is dq or dt."""
    return e.op == "sym" and e.args[0] in ("differential", "dt")


def exterior_derivative(form: Mapping[Expr, Expr]) -> dict[tuple[int, int], Expr]:
    """Return d(omega) of the 1-form {x_i: a_i} as {(i, j): d a_j/d x_i - d a_i/d x_j}, i < j, without zeros."""
    pairs = combinations(enumerate(form.items()), 2)
    curls = {(i, j): diff(b, s) - diff(a, u) for (i, (s, a)), (j, (u, b)) in pairs}
    return {pair: curl for pair, curl in curls.items() if not curl.is_zero}
