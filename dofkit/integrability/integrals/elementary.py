"""Antiderivatives that a table gives: of one function or power of what is linear, and of products of waves."""

from __future__ import annotations

from fractions import Fraction

from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.algebra import Algebra
from dofkit.integrability.integrals.rational import linear, root_of_quadratic
from dofkit.integrability.integrals.trigonometry import powers, sin_cos


def as_power(e: Expr) -> tuple[Expr, Fraction]:
    """(base, exponent) for a numeric exponent."""
    if e.op == "pow" and e.args[1].op == "num":
        return e.args[0], e.args[1].args[0]
    return e, Fraction(1)


def collected_powers(term: Expr, x: Expr) -> tuple[Expr, list[Expr]]:
    """The factors free of x, and the others with the powers of equal bases collected."""
    constants, bases = [], dict[Expr, Fraction]()
    for factor in term.args if term.op == "mul" else (term,):
        if x in factor.symbols:
            base, exponent = as_power(factor)
            bases[base] = bases.get(base, Fraction(0)) + exponent
        else:
            constants.append(factor)
    return ex.mul(*constants), [ex.power(base, ex.num(k)) for base, k in bases.items() if k]


def of_function(name: str, u: Expr) -> Expr | None:
    """The antiderivative of a function by its argument."""
    if name == "exp":
        return ex.fn("exp", u)
    if name in ("sinh", "cosh"):
        return ex.fn("cosh" if name == "sinh" else "sinh", u)
    if name == "tanh":
        return ex.fn("log", ex.fn("cosh", u))
    if name == "abs":
        return u * ex.fn("abs", u) / 2
    if name == "log":
        return u * ex.fn("log", u) - u
    if name == "atan":
        return u * ex.fn("atan", u) - ex.fn("log", 1 + u * u) / 2
    if name in ("asin", "acos"):
        root = ex.sqrt(1 - u * u)
        return u * ex.fn(name, u) + (root if name == "asin" else -root)
    found = powers([ex.fn(name, u)])
    return None if found is None else sin_cos(*found[u], u)


def of_power(work: Algebra, e: Expr, x: Expr) -> Expr | None:
    """The antiderivative of a power: of or by what is linear, of waves, of the root of a quadratic polynomial."""
    base: Expr = e.args[0]
    exponent: Expr = e.args[1]
    if x in exponent.symbols:
        straight = linear(exponent, x)
        return None if x in base.symbols or straight is None else e / (straight[0] * ex.fn("log", base))
    straight = linear(base, x)
    if straight is not None:
        if exponent == ex.MINUS_ONE:
            return ex.fn("log", base) / straight[0]
        return ex.power(base, exponent + 1) / ((exponent + 1) * straight[0])
    if exponent.op != "num":
        return None
    trig = powers([e])
    if trig is not None:
        return of_waves(trig, x)
    return root_of_quadratic(work, base, exponent.args[0], x)


def of_call(e: Expr, x: Expr) -> Expr | None:
    """An unknown function differentiated by the argument that holds x."""
    name, orders, arguments = e.args
    places = [i for i, u in enumerate(arguments) if x in u.symbols]
    straight = linear(arguments[places[0]], x)
    if len(places) > 1 or straight is None or not orders[places[0]]:
        return None
    lower = tuple(k - (i == places[0]) for i, k in enumerate(orders))
    return ex.call(name, arguments, lower) / straight[0]


def of_waves(trig: dict[Expr, tuple[int, int]], x: Expr) -> Expr | None:
    """The antiderivative of sin(u)^m cos(u)^n for one linear u, given as {u: (m, n)}."""
    if len(trig) != 1:
        return None
    ((u, (m, n)),) = trig.items()
    straight = linear(u, x)
    found = None if straight is None else sin_cos(m, n, u)
    return None if found is None or straight is None else found / straight[0]


def of_exponential_wave(factors: list[Expr], x: Expr) -> Expr | None:
    """exp(u) sin(v) and exp(u) cos(v) for linear u, v."""
    named = {f.args[0]: f.args[1] for f in factors if f.op == "fn"}
    wave = next((name for name in ("sin", "cos") if name in named), None)
    if len(factors) != 2 or len(named) != 2 or "exp" not in named or wave is None:
        return None
    u, v = named["exp"], named[wave]
    first, second = linear(u, x), linear(v, x)
    if first is None or second is None:
        return None
    a, b = first[0], second[0]
    sin, cos = ex.fn("sin", v), ex.fn("cos", v)
    inside = a * sin - b * cos if wave == "sin" else a * cos + b * sin
    return ex.fn("exp", u) * inside / (a * a + b * b)
