"""How an integral and its factor are written: equivalent forms of a pair (integral, factor), the simplest first."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import gcd, lcm

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import content
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.potentials import Algebra, as_power

#: (integral, factor).
Pair = tuple[Expr, Expr]


_KINDS = {"parameter": 0, "coordinate": 1, "time": 2}


def _rank(factor: Expr) -> tuple[int, str]:
    """Return the sort key of a factor: numbers, parameters, coordinates, time, then what is no power of a symbol."""
    base, _ = as_power(factor)
    if base.op == "num":
        return -1, ""
    return (_KINDS.get(base.args[0], 3), base.args[1]) if base.op == "sym" else (4, to_text(base))


def _place(term: Expr) -> tuple[bool, bool, list[tuple[int, str]]]:
    """Return the sort key of a term: polynomial terms by their variables, then terms with functions, numbers last."""
    moving = sorted(_rank(s) for s in term.symbols if s.args[0] != "parameter")
    return not term.symbols, any(n.op in ("fn", "call") for n in ex.nodes(term)), moving


def arranged(e: Expr) -> Expr:
    """Return ``e`` with terms and factors sorted, a term without a minus sign first, exp(u)^k as exp(k u)."""
    operands = tuple(arranged(child) for child in ex.children(e))
    if e.op == "mul":
        return _product(operands)
    if e.op == "pow" and _is_exp(operands[0]):
        return ex.fn("exp", arranged(operands[1] * operands[0].args[1]))
    if e.op == "add":
        terms = sorted(operands, key=_place)
        positive = next((i for i, term in enumerate(terms) if not to_text(term).startswith("-")), 0)
        return Expr("add", (terms[positive], *terms[:positive], *terms[positive + 1 :]))
    return ex.rebuild(e, operands) if operands else e


def _is_exp(e: Expr) -> bool:
    return e.op == "fn" and e.args[0] == "exp"


def _product(factors: tuple[Expr, ...]) -> Expr:
    """Return the product with its factors sorted, and all exponentials combined in one at the end."""
    others = sorted((p for p in factors if not _is_exp(p)), key=_rank)
    exponents = [p.args[1] for p in factors if _is_exp(p)]
    if exponents:
        total = arranged(ex.add(*exponents)) if len(exponents) > 1 else exponents[0]
        others += [] if total.is_zero else [ex.fn("exp", total)]
    return Expr("mul", tuple(others)) if len(others) > 1 else ex.mul(*others)


def upright(e: Expr) -> Expr:
    """Return ``e`` with terms -atan(u/v) written as atan(v/u), which differs by a constant; not if v is a root."""
    if e.op == "add":
        return ex.add(*map(upright, e.args))
    if e.op != "mul" or e.args[0].op != "num" or e.args[0].args[0] > 0:
        return e
    last = e.args[-1]
    if last.op != "fn" or last.args[0] != "atan":
        return e
    inside: Expr = last.args[1]
    divided = any(as_power(f)[1] <= -1 for f in (inside.args if inside.op == "mul" else (inside,)))
    return -ex.mul(*e.args[:-1], ex.fn("atan", 1 / inside)) if divided else e


def cost(pair: Pair) -> tuple[int, int]:
    """Return the lengths of integral and factor as text; functions and denominators count extra."""
    integral, factor = pair
    return _length(integral), _length(factor)


def _length(e: Expr) -> int:
    below = sum(2 for n in ex.nodes(e) if as_power(n)[1] < 0)
    functions = sum(3 for n in ex.nodes(e) if n.op == "fn" or (n.op == "pow" and n.args[1].op != "num"))
    return len(to_text(e)) + functions + below


def shapes(work: Algebra, pair: Pair) -> list[Pair]:
    """Return ``pair`` and equivalent pairs (f replaced by a function of f, mu accordingly), the simplest first."""
    pairs = list(_scaled(work, pair))
    for simpler in list(pairs):
        for other in (_without_logs(simpler), _without_roots(simpler), _reciprocal(simpler)):
            if other is not None:
                pairs.extend(_scaled(work, other))
    for simpler in pairs[2:]:
        for other in (_without_roots(simpler), _reciprocal(simpler)):
            if other is not None:
                pairs.extend(_scaled(work, other))
    return sorted(dict.fromkeys(pairs), key=cost)


def _scaled(work: Algebra, pair: Pair) -> Iterator[Pair]:
    """Yield the pair, f divided by its constant factor and sorted: as built, with `upright`, and as one quotient."""
    integral, factor = pair
    for form in dict.fromkeys((upright(integral), integral, work.tidy(integral))):
        constant = _constant(form)
        plain = factor / constant
        yield arranged(form / constant), min((arranged(mu) for mu in (work.tidy(plain), plain)), key=_length)


def _constant(e: Expr) -> Expr:
    """Return the constant factor of a product, or the rational content of a sum (< 0 if all coefficients are)."""
    if e.op == "mul":
        return ex.mul(*(f for f in e.args if all(s.args[0] == "parameter" for s in f.symbols)))
    if e.op != "add":
        return ex.ONE
    rational = content(e)[0]
    return ex.num(-rational if all(ex.number_and_rest(t)[0] < 0 for t in e.args) else rational)


def _logs(e: Expr) -> tuple[dict[Expr, Fraction], list[Expr]]:
    """Return the terms c log(u) of a sum with rational c, as u -> c, and the other terms."""
    logs: dict[Expr, Fraction] = {}
    terms = []
    for term in e.args if e.op == "add" else (e,):
        number, other = ex.number_and_rest(term)
        if other.op == "fn" and other.args[0] == "log":
            logs[other.args[1]] = logs.get(other.args[1], Fraction(0)) + number
        else:
            terms.append(term)
    return logs, terms


def _without_logs(pair: Pair) -> Pair | None:
    """Return the pair for exp(k f), with k such that c log(u) becomes u^(k c); None without such terms in f."""
    integral, factor = pair
    logs, terms = _logs(integral)
    if not logs:
        return None
    k = Fraction(lcm(*(c.denominator for c in logs.values())), gcd(*(c.numerator for c in logs.values())) or 1)
    powers = [ex.power(u, ex.num(c * k)) for u, c in logs.items()]
    if any(n.op in ("fn", "call") or as_power(n)[1] < 0 for term in terms for n in ex.nodes(term)):
        return None
    exponential_of_f = ex.mul(*powers, ex.fn("exp", ex.add(*terms) * k)) if terms else ex.mul(*powers)
    return exponential_of_f, exponential_of_f * factor * k


def _without_roots(pair: Pair) -> Pair | None:
    """Return the pair for f^k if f is a product of powers with fractional exponents and k clears them, else None."""
    integral, factor = pair
    powers = integral.args if integral.op == "mul" else (integral,)
    k = lcm(*(as_power(part)[1].denominator for part in powers))
    if k == 1 or k > 6:
        return None
    power = ex.mul(*(ex.power(base, ex.num(e * k)) for base, e in map(as_power, powers)))
    return power, factor * k * integral ** (k - 1)


def _reciprocal(pair: Pair) -> Pair | None:
    """Return the pair for 1/f; None if f is 0, a sum, or too large."""
    integral, factor = pair
    if integral.is_zero or integral.op == "add" or ex.size(integral) > 60:
        return None
    return 1 / integral, -factor / integral**2
