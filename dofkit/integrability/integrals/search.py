"""Integrals of one Pfaffian form omega: f and mu with df = mu omega, proposed by rules and proved by differentiation.

A result is returned only if df = mu omega is an identity, component by component, and mu is proved non-zero at some
point; a form for which no rule applies gives None. The work is bounded by a number of steps, that of SymPy by time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, combinations, count
from math import gcd, lcm

from dofkit.exact.ring.canonical import Canon, Monomial
from dofkit.exact.ring.program import raising_no_value
from dofkit.exact.ring.quotients import Poly, solve
from dofkit.exact.zero import certainly_nonzero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import content, diff, exterior_derivative
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.potentials import (
    Algebra,
    Form,
    GivenUpError,
    as_power,
    potential,
    size,
)
from dofkit.relations.normal.pieces import Pfaffian

__all__ = ["Integral", "integrate"]

#: The largest form that is integrated, in nodes.
MAX_FORM = 300
#: With more variables only the integrating factors of `simple` are tried.
MAX_VARIABLES = 5
#: An integral and a factor whose lengths (see `cost`) are at most these end the search.
EASY = 16
LONG = 60


@dataclass(frozen=True)
class Integral:
    """The geometric equation of which a form omega is a consequence, as text.

    ``factor``: the integrating factor mu, e.g. ``1/x^2``; None if the form is closed as written.
    ``integral``: ``f = C``, e.g. ``y/x = C``, with df = mu omega.
    """

    factor: str | None
    integral: str


def integrate(form: Pfaffian, positive: frozenset[Expr]) -> Integral | None:
    """Return f = C and mu with a proof of df = mu omega in (q, t), or None where no rule applies."""
    work = Algebra(positive)
    try:
        return _integrate(work, form)
    except (GivenUpError, RecursionError, ArithmeticError):
        return None


@raising_no_value
def _integrate(work: Algebra, form: Pfaffian) -> Integral | None:
    omega = {s: ex.ZERO if work.vanishes(a) else a for s, a in form.components.items()}
    sizes = [size(a) for a in omega.values() if not a.is_zero]
    if not sizes or sum(sizes) > MAX_FORM:
        return None
    if work.closed(omega):
        f = potential(work, omega)
        if f is not None:
            for integral in dict.fromkeys((arranged(upright(f)), arranged(f), f)):
                if _proved(work, omega, (integral, ex.ONE)):
                    return Integral(None, _equation(integral, omega))
    return _with_factor(work, omega)


def _with_factor(work: Algebra, form: Form) -> Integral | None:
    """Return the simplest integral that `_pairs` yields before the budget is exhausted, or None."""
    best: Pair | None = None
    try:
        for pair in _pairs(work, form):
            if best is None or cost(pair) < cost(best):
                best = pair
            if all(length <= limit for length, limit in zip(cost(best), (EASY, LONG), strict=True)):
                break
    except GivenUpError:
        pass
    return None if best is None else Integral(to_text(best[1]), _equation(best[0], form))


def _equation(integral: Expr, form: Form) -> str:
    """Return ``f = C`` as text; the constant is named C1, C2, ... if C occurs in the form."""
    names = {s.args[1] for s in form} | {s.args[1] for a in form.values() for s in a.symbols}
    constant = next(name for name in chain(("C",), (f"C{i}" for i in count(1))) if name not in names)
    return f"{to_text(integral)} = {constant}"


def _pairs(work: Algebra, form: Form) -> Iterator[Pair]:
    """Yield (integral, factor) for the candidates of the first family of factors that gives any."""
    successful = False
    for family in (simple, of_powers) if len(form) <= MAX_VARIABLES else (simple,):
        for mu in family(work, form):
            pair = _integral(work, form, mu)
            if pair is not None:
                successful = True
                yield pair
        if successful:
            return


def _integral(work: Algebra, form: Form, mu: Expr) -> Pair | None:
    """Return (f, mu) in its simplest proved form if mu omega is closed and its potential is found, else None."""
    scaled = {s: a if a.is_zero else work.tidy(mu * a) for s, a in form.items()}
    if sum(map(size, scaled.values())) > 2 * MAX_FORM or not work.closed(scaled):
        return None
    f = potential(work, scaled)
    if f is None:
        return None
    return next((pair for pair in shapes(work, (f, mu)) if _proved(work, form, pair)), None)


def _proved(work: Algebra, form: Form, pair: Pair) -> bool:
    """Return whether df = mu omega identically and mu is not zero."""
    integral, mu = pair
    is_integral = all(work.vanishes(diff(integral, s) - mu * a) for s, a in form.items())
    return is_integral and certainly_nonzero(mu, work.positive)


# candidates for integrating factors mu; `_integral` tests d(mu omega) = 0


def exponential(e: Expr) -> Expr:
    """Return exp(e), with exp(c log u) written as u^c."""
    factors_of_exp = []
    for term in e.args if e.op == "add" else (e,):
        factors = term.args if term.op == "mul" else (term,)
        log = next((f for f in factors if f.op == "fn" and f.args[0] == "log"), None)
        if log is None or any(s.args[0] != "parameter" for f in factors if f is not log for s in f.symbols):
            factors_of_exp.append(ex.fn("exp", term))
        else:
            factors_of_exp.append(ex.power(log.args[1], ex.mul(*(f for f in factors if f is not log))))
    return ex.mul(*factors_of_exp)


def simple(work: Algebra, form: Form) -> Iterator[Expr]:
    """Yield 1/g for the greatest common divisor g of the coefficients, then for each coefficient g."""
    divisors: list[Expr] = []
    for divisor in (_content(work, form), *form.values()):
        if not divisor.is_zero and divisor not in divisors and divisor.op != "num":
            divisors.append(divisor)
            yield 1 / divisor


def _content(work: Algebra, form: Form) -> Expr:
    """Return the greatest common divisor of the numerators divided by that of the denominators; 1 if undefined."""
    coefficients = [a for a in form.values() if not a.is_zero]
    content = work.attempt(lambda: _common(work, coefficients))
    return ex.ONE if content is None else content


def _common(work: Algebra, coefficients: list[Expr]) -> Expr:
    """Return what `_content` returns, or raise an exception where it is undefined."""
    canon, quotients = work.lowered(coefficients)
    top, bottom = quotients[0]
    for above, below in quotients[1:]:
        top, bottom = top.gcd(above), bottom.gcd(below)
    return canon.to_expr(top) / canon.to_expr(bottom)


def of_powers(work: Algebra, form: Form) -> Iterator[Expr]:
    """Yield mu = prod g_k^c_k with constants c_k, if one exists [Darboux1878]; for the g_k see `_candidates`."""
    logs = _candidates(work, form)
    if not logs:
        return
    exponents = work.attempt(lambda: _constants(work, form, logs))
    if exponents:
        yield exponential(ex.add(*(c * g for c, g in zip(exponents, logs, strict=True))))


def _candidates(work: Algebra, form: Form) -> list[Expr]:
    """Return log g_k for the possible factors g_k: variables, factors of coefficients, x^2 + y^2, exp x, exp(x^2/2)."""
    variables, bases = list(form), dict.fromkeys(form)
    for coefficient in form.values():
        tidy = work.tidy(coefficient)
        for factor in tidy.args if tidy.op == "mul" else (tidy,):
            base = factor.args[0] if factor.op == "pow" else factor
            if any(s in base.symbols for s in form):
                bases[base] = None
    if len(variables) == 2:
        bases[variables[0] ** 2 + variables[1] ** 2] = None
    return [ex.fn("log", b) for b in list(bases)[:10]] + variables + [s * s / 2 for s in variables]


def _constants(work: Algebra, form: Form, logs: list[Expr]) -> list[Expr] | None:
    """Return c with sum c_k (d log g_k ^ omega) + d(omega) = 0, by comparing coefficients; None without a solution.

    ``logs``: the log g_k. The form prod g_k^c_k omega is then closed.
    """
    rows: list[list[Expr]] = []
    curls = exterior_derivative(form)
    for (i, s), (j, u) in combinations(enumerate(form), 2):
        wedges = [diff(g, s) * form[u] - diff(g, u) * form[s] for g in logs]
        rows.append([*wedges, -curls.get((i, j), ex.ZERO)])
    flat = [e for row in rows for e in row]
    canon, quotients = work.lowered(flat)
    fixed = frozenset(i for i, e in enumerate(canon.ring.var_expr) if e.symbols.isdisjoint(form))
    system: list[list[Poly]] = []
    width = len(logs) + 1
    for start in range(0, len(quotients), width):
        row = quotients[start : start + width]
        below = canon.unit
        for _, bottom in row:
            below = below * (bottom / below.gcd(bottom))
        system.extend(_compared([canon.reduce(top * (below / bottom)) for top, bottom in row], fixed, canon))
    solution = solve(system, canon.unit)
    return None if solution is None else [canon.to_expr(a) / canon.to_expr(b) for a, b in solution]


def _compared(polys: list[Poly], fixed: frozenset[int], canon: Canon) -> list[list[Poly]]:
    """Return a row of coefficients, one for each of ``polys``, for every monomial in the generators not ``fixed``."""
    moving = set(range(len(canon.ring.vars))) - fixed
    by_monomial: dict[Monomial, list[Poly]] = {}
    for column, poly in enumerate(polys):
        for monomial, coefficient in canon.collected(poly, moving).items():
            by_monomial.setdefault(monomial, [canon.unit * 0] * len(polys))[column] = coefficient
    return list(by_monomial.values())


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
        factors = term.args if term.op == "mul" else (term,)
        number = factors[0].args[0] if factors[0].op == "num" else Fraction(1)
        last = factors[-1]
        if last.op == "fn" and last.args[0] == "log" and len(factors) - (factors[0].op == "num") == 1:
            logs[last.args[1]] = logs.get(last.args[1], Fraction(0)) + number
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
    if integral.is_zero or integral.op == "add" or size(integral) > 60:
        return None
    return 1 / integral, -factor / integral**2
