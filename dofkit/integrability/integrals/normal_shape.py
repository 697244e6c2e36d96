"""The most readable form of an integral: logarithms, roots and reciprocals removed, factors in a fixed order."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import gcd, lcm

from dofkit.expressions import tree as ex
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.algebra import Algebra, size
from dofkit.integrability.integrals.potentials import as_power

#: (integral, factor).
Pair = tuple[Expr, Expr]

_KINDS = {"parameter": 0, "coordinate": 1, "time": 2}


def _rank(factor: Expr) -> tuple[int, str]:
    """Return the place of a factor: numbers, parameters, coordinates, time, then what is no power of a symbol."""
    base, _ = as_power(factor)
    if base.op == "num":
        return -1, ""
    return (_KINDS.get(base.args[0], 3), base.args[1]) if base.op == "sym" else (4, to_text(base))


def _place(term: Expr) -> tuple[bool, bool, list[tuple[int, str]]]:
    """Return the place of a term: polynomial terms by their variables, then functions, numbers last."""
    moving = sorted(_rank(s) for s in term.symbols if s.args[0] != "parameter")
    return not term.symbols, any(n.op in ("fn", "call") for n in ex.nodes(term)), moving


def arranged(e: Expr) -> Expr:
    """Return ``e`` with terms and factors sorted, a term without a minus sign first, exp(u)^k as exp(k u)."""
    parts = tuple(arranged(child) for child in ex.children(e))
    if e.op == "mul":
        return _product(parts)
    if e.op == "pow" and _is_exp(parts[0]):
        return ex.fn("exp", arranged(parts[1] * parts[0].args[1]))
    if e.op == "add":
        terms = sorted(parts, key=_place)
        first = next((i for i, term in enumerate(terms) if not to_text(term).startswith("-")), 0)
        return Expr("add", (terms[first], *terms[:first], *terms[first + 1 :]))
    return ex.rebuild(e, parts) if parts else e


def _is_exp(e: Expr) -> bool:
    return e.op == "fn" and e.args[0] == "exp"


def _product(parts: tuple[Expr, ...]) -> Expr:
    others = sorted((p for p in parts if not _is_exp(p)), key=_rank)
    exponents = [p.args[1] for p in parts if _is_exp(p)]
    if exponents:
        total = arranged(ex.add(*exponents)) if len(exponents) > 1 else exponents[0]
        others += [] if total.is_zero else [ex.fn("exp", total)]
    return Expr("mul", tuple(others)) if len(others) > 1 else ex.mul(*others)


def upright(e: Expr) -> Expr:
    """Return -atan(u/v) as atan(v/u), which differs from it by a constant."""
    if e.op == "add":
        return ex.add(*map(upright, e.args))
    if e.op != "mul" or e.args[0].op != "num" or e.args[0].args[0] > 0:
        return e
    last = e.args[-1]
    if last.op != "fn" or last.args[0] != "atan":
        return e
    inside: Expr = last.args[1]
    divided = any(as_power(f)[1] < 0 for f in (inside.args if inside.op == "mul" else (inside,)))
    return -ex.mul(*e.args[:-1], ex.fn("atan", 1 / inside)) if divided else e


def cost(pair: Pair) -> tuple[int, int]:
    """Return the lengths of integral and factor; functions and denominators count extra."""
    integral, factor = pair
    return _reading(integral), _reading(factor)


def _reading(e: Expr) -> int:
    below = sum(2 for n in ex.nodes(e) if as_power(n)[1] < 0)
    functions = sum(3 for n in ex.nodes(e) if n.op == "fn" or (n.op == "pow" and n.args[1].op != "num"))
    return len(to_text(e)) + functions + below


def shapes(work: Algebra, pair: Pair) -> list[Pair]:
    """Return ``pair`` and its equivalent forms, the simplest first."""
    found = list(_scaled(work, pair))
    for first in list(found):
        for other in (_without_logs(first), _without_roots(first), _reciprocal(first)):
            if other is not None:
                found.extend(_scaled(work, other))
    for first in found[2:]:
        for other in (_without_roots(first), _reciprocal(first)):
            if other is not None:
                found.extend(_scaled(work, other))
    return sorted(dict.fromkeys(found), key=cost)


def _scaled(work: Algebra, pair: Pair) -> Iterator[Pair]:
    """Yield the pair as built and as one quotient, constant factors taken out."""
    integral, factor = pair
    for shown in dict.fromkeys((upright(integral), integral, work.tidy(integral))):
        constant = _constant(shown)
        plain = factor / constant
        yield arranged(shown / constant), min((arranged(mu) for mu in (work.tidy(plain), plain)), key=_reading)


def _constant(e: Expr) -> Expr:
    """Return the factor of ``e`` free of coordinates and time; of a sum, its rational content with the first sign."""
    if e.op == "mul":
        return ex.mul(*(f for f in e.args if all(s.args[0] == "parameter" for s in f.symbols)))
    if e.op != "add":
        return ex.ONE
    numbers = [t.args[0].args[0] if t.op == "mul" and t.args[0].op == "num" else Fraction(1) for t in e.args]
    content = Fraction(gcd(*(n.numerator for n in numbers)), lcm(*(n.denominator for n in numbers)))
    return ex.num(-content if all(n < 0 for n in numbers) else content)


def _logs(e: Expr) -> tuple[dict[Expr, Fraction], list[Expr]]:
    """Return the terms c log(u) of a sum with rational c, as u -> c, and the other terms."""
    logs: dict[Expr, Fraction] = {}
    rest = []
    for term in e.args if e.op == "add" else (e,):
        factors = term.args if term.op == "mul" else (term,)
        number = factors[0].args[0] if factors[0].op == "num" else Fraction(1)
        last = factors[-1]
        if last.op == "fn" and last.args[0] == "log" and len(factors) - (factors[0].op == "num") == 1:
            logs[last.args[1]] = logs.get(last.args[1], Fraction(0)) + number
        else:
            rest.append(term)
    return logs, rest


def _without_logs(pair: Pair) -> Pair | None:
    """Return exp(k f) where f holds logarithms with rational coefficients."""
    integral, factor = pair
    logs, rest = _logs(integral)
    if not logs:
        return None
    k = Fraction(lcm(*(c.denominator for c in logs.values())), gcd(*(c.numerator for c in logs.values())) or 1)
    powers = [ex.power(u, ex.num(c * k)) for u, c in logs.items()]
    if any(n.op in ("fn", "call") or as_power(n)[1] < 0 for term in rest for n in ex.nodes(term)):
        return None
    whole = ex.mul(*powers, ex.fn("exp", ex.add(*rest) * k)) if rest else ex.mul(*powers)
    return whole, whole * factor * k


def _without_roots(pair: Pair) -> Pair | None:
    """Return f^k for a product of powers with fractions in the exponents."""
    integral, factor = pair
    parts = integral.args if integral.op == "mul" else (integral,)
    k = lcm(*(as_power(part)[1].denominator for part in parts))
    if k == 1 or k > 6:
        return None
    whole = ex.mul(*(ex.power(base, ex.num(e * k)) for base, e in map(as_power, parts)))
    return whole, factor * k * integral ** (k - 1)


def _reciprocal(pair: Pair) -> Pair | None:
    """Return 1/f for a product f."""
    integral, factor = pair
    if integral.is_zero or integral.op == "add" or size(integral) > 60:
        return None
    return 1 / integral, -factor / integral**2
