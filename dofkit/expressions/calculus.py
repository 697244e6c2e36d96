"""Substitution in expressions, and their partial derivatives."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import partial

from dofkit.expressions.tree import MINUS_ONE, ONE, ZERO, Expr, add, call, children, fn, mul, num, power, rebuild


def substitute(e: Expr, mapping: Mapping[Expr, Expr]) -> Expr:
    """``e`` with symbols replaced by expressions, all at once."""
    return _substituted(e, mapping, {})


def _substituted(node: Expr, mapping: Mapping[Expr, Expr], memo: dict[Expr, Expr]) -> Expr:
    if mapping.keys().isdisjoint(node.symbols):
        return node
    if node.op == "sym":
        return mapping[node]
    found = memo.get(node)
    if found is None:
        found = memo[node] = rebuild(node, tuple([_substituted(child, mapping, memo) for child in children(node)]))
    return found


def replace_nodes(e: Expr, mapping: Mapping[Expr, Expr]) -> Expr:
    """``e`` with nodes of any kind, such as sin(x) or 3/2, replaced by expressions, the outermost first."""
    return _replaced(e, dict(mapping))


def _replaced(node: Expr, memo: dict[Expr, Expr]) -> Expr:
    found = memo.get(node)
    if found is None:
        found = memo[node] = rebuild(node, tuple([_replaced(child, memo) for child in children(node)]))
    return found


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
    """The partial derivative by one symbol, all other symbols held."""
    return _diff(e, symbol, {})


def _diff(node: Expr, symbol: Expr, memo: dict[Expr, Expr]) -> Expr:
    if node is symbol or node == symbol:
        return ONE
    if symbol not in node.symbols:
        return ZERO
    found = memo.get(node)
    if found is None:
        found = memo[node] = _diff_node(node, partial(_diff, symbol=symbol, memo=memo))
    return found


def _diff_node(node: Expr, go: Callable[[Expr], Expr]) -> Expr:
    if node.op == "add":
        return add(*(go(term) for term in node.args))
    if node.op == "mul":
        parts = node.args
        return add(*(mul(go(part), *parts[:i], *parts[i + 1 :]) for i, part in enumerate(parts)))
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
