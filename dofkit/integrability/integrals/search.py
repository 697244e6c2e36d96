"""Integrals of Pfaffian forms: f and mu with df = mu omega, proposed by rules and proved by differentiating.

A result is returned only where df = mu omega holds identically in the canonical ring, component by component, and mu
is proved not to vanish at a point; a form for which no rule applies gives None. The work is bounded by a count of
steps, and that of SymPy by time.
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
#: Past so many variables only the cheap factors are tried.
MAX_VARIABLES = 5
#: A result this easy to read, with a factor no longer than that, ends the search.
EASY = 16
LONG = 60


@dataclass(frozen=True)
class Integral:
    """The configuration-level equation that a form integrates to, as text.

    ``factor``: the integrating factor mu, e.g. ``1/x^2``; None where the form is closed as written.
    ``integral``: ``f = C``, e.g. ``y/x = C``; d f = mu omega.
    """

    factor: str | None
    integral: str


def integrate(form: Pfaffian, positive: frozenset[Expr]) -> Integral | None:
    """Return f = C and mu with df = mu omega in (q, t), proved, or None where no rule applies."""
    work = Algebra(positive)
    try:
        return _integrate(work, form)
    except (GivenUpError, RecursionError, ArithmeticError):
        return None


@raising_no_value
def _integrate(work: Algebra, form: Pfaffian) -> Integral | None:
    whole = {s: ex.ZERO if work.vanishes(a) else a for s, a in form.components.items()}
    sizes = [size(a) for a in whole.values() if not a.is_zero]
    if not sizes or sum(sizes) > MAX_FORM:
        return None
    if work.closed(whole):
        closed = potential(work, whole)
        if closed is not None:
            for integral in dict.fromkeys((arranged(upright(closed)), arranged(closed), closed)):
                if _proved(work, whole, (integral, ex.ONE)):
                    return Integral(None, _equation(integral, whole))
    return _with_factor(work, whole)


def _with_factor(work: Algebra, form: Form) -> Integral | None:
    """Return the simplest of the integrals that the first successful family of factors gives."""
    best: Pair | None = None
    try:
        for pair in _pairs(work, form):
            if best is None or cost(pair) < cost(best):
                best = pair
            if all(here <= there for here, there in zip(cost(best), (EASY, LONG), strict=True)):
                break
    except GivenUpError:
        pass
    return None if best is None else Integral(to_text(best[1]), _equation(best[0], form))


def _equation(integral: Expr, form: Form) -> str:
    """Return ``f = C`` as text, with C1, C2, ... where the form itself has a C."""
    taken = {s.args[1] for s in form} | {s.args[1] for a in form.values() for s in a.symbols}
    constant = next(name for name in chain(("C",), (f"C{i}" for i in count(1))) if name not in taken)
    return f"{to_text(integral)} = {constant}"


def _pairs(work: Algebra, form: Form) -> Iterator[Pair]:
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
    """Return the integral that belongs to a factor, in its simplest proved form, with that factor."""
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
    holds = all(work.vanishes(diff(integral, s) - mu * a) for s, a in form.items())
    return holds and certainly_nonzero(mu, work.positive)


# integrating factors: mu with d(mu omega) = 0, each used only once that is proved


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
    """Yield one over the common divisor of the coefficients, then one over each coefficient."""
    seen: list[Expr] = []
    for divisor in (_content(work, form), *form.values()):
        if not divisor.is_zero and divisor not in seen and divisor.op != "num":
            seen.append(divisor)
            yield 1 / divisor


def _content(work: Algebra, form: Form) -> Expr:
    """Return the common divisor of the numerators over that of the denominators."""
    present = [a for a in form.values() if not a.is_zero]
    content = work.attempt(lambda: _common(work, present))
    return ex.ONE if content is None else content


def _common(work: Algebra, present: list[Expr]) -> Expr:
    canon, quotients = work.lowered(present)
    top, bottom = quotients[0]
    for above, below in quotients[1:]:
        top, bottom = top.gcd(above), bottom.gcd(below)
    return canon.to_expr(top) / canon.to_expr(bottom)


def of_powers(work: Algebra, form: Form) -> Iterator[Expr]:
    """Yield mu = prod g_k^c_k with constants c_k [Darboux1878].

    The g_k are variables, factors of the coefficients, and exponentials.
    """
    logs = _candidates(work, form)
    if not logs:
        return
    exponents = work.attempt(lambda: _constants(work, form, logs))
    if exponents:
        yield exponential(ex.add(*(c * g for c, g in zip(exponents, logs, strict=True))))


def _candidates(work: Algebra, form: Form) -> list[Expr]:
    """Return the logarithms of possible factors, and the exponents x and x^2/2."""
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
    """Return c with sum c_k (dg_k ^ omega) + d(omega) = 0, by comparing coefficients."""
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
    """Return one equation for every monomial in the generators that are not ``fixed``."""
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
    operands = tuple(arranged(child) for child in ex.children(e))
    if e.op == "mul":
        return _product(operands)
    if e.op == "pow" and _is_exp(operands[0]):
        return ex.fn("exp", arranged(operands[1] * operands[0].args[1]))
    if e.op == "add":
        terms = sorted(operands, key=_place)
        first = next((i for i, term in enumerate(terms) if not to_text(term).startswith("-")), 0)
        return Expr("add", (terms[first], *terms[:first], *terms[first + 1 :]))
    return ex.rebuild(e, operands) if operands else e


def _is_exp(e: Expr) -> bool:
    return e.op == "fn" and e.args[0] == "exp"


def _product(factors: tuple[Expr, ...]) -> Expr:
    others = sorted((p for p in factors if not _is_exp(p)), key=_rank)
    exponents = [p.args[1] for p in factors if _is_exp(p)]
    if exponents:
        total = arranged(ex.add(*exponents)) if len(exponents) > 1 else exponents[0]
        others += [] if total.is_zero else [ex.fn("exp", total)]
    return Expr("mul", tuple(others)) if len(others) > 1 else ex.mul(*others)


def upright(e: Expr) -> Expr:
    """Return -atan(u/v) as atan(v/u), which differs from it by a constant; not for a root v: u may be 0 there."""
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
    """Return the lengths of integral and factor; functions and denominators count extra."""
    integral, factor = pair
    return _reading(integral), _reading(factor)


def _reading(e: Expr) -> int:
    below = sum(2 for n in ex.nodes(e) if as_power(n)[1] < 0)
    functions = sum(3 for n in ex.nodes(e) if n.op == "fn" or (n.op == "pow" and n.args[1].op != "num"))
    return len(to_text(e)) + functions + below


def shapes(work: Algebra, pair: Pair) -> list[Pair]:
    """Return ``pair`` and its equivalent forms, the simplest first."""
    pairs = list(_scaled(work, pair))
    for first in list(pairs):
        for other in (_without_logs(first), _without_roots(first), _reciprocal(first)):
            if other is not None:
                pairs.extend(_scaled(work, other))
    for first in pairs[2:]:
        for other in (_without_roots(first), _reciprocal(first)):
            if other is not None:
                pairs.extend(_scaled(work, other))
    return sorted(dict.fromkeys(pairs), key=cost)


def _scaled(work: Algebra, pair: Pair) -> Iterator[Pair]:
    """Yield the pair as built and as one quotient, constant factors taken out."""
    integral, factor = pair
    for form in dict.fromkeys((upright(integral), integral, work.tidy(integral))):
        constant = _constant(form)
        plain = factor / constant
        yield arranged(form / constant), min((arranged(mu) for mu in (work.tidy(plain), plain)), key=_reading)


def _constant(e: Expr) -> Expr:
    """Return a constant factor of ``e``: the factors of a product that hold parameters only, or the rational content of
    a sum, negative where the coefficients of all its terms are. An integral is written without it."""
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
    """Return exp(k f) where f holds logarithms with rational coefficients."""
    integral, factor = pair
    logs, terms = _logs(integral)
    if not logs:
        return None
    k = Fraction(lcm(*(c.denominator for c in logs.values())), gcd(*(c.numerator for c in logs.values())) or 1)
    powers = [ex.power(u, ex.num(c * k)) for u, c in logs.items()]
    if any(n.op in ("fn", "call") or as_power(n)[1] < 0 for term in terms for n in ex.nodes(term)):
        return None
    whole = ex.mul(*powers, ex.fn("exp", ex.add(*terms) * k)) if terms else ex.mul(*powers)
    return whole, whole * factor * k


def _without_roots(pair: Pair) -> Pair | None:
    """Return f^k for a product of powers with fractions in the exponents."""
    integral, factor = pair
    powers = integral.args if integral.op == "mul" else (integral,)
    k = lcm(*(as_power(part)[1].denominator for part in powers))
    if k == 1 or k > 6:
        return None
    whole = ex.mul(*(ex.power(base, ex.num(e * k)) for base, e in map(as_power, powers)))
    return whole, factor * k * integral ** (k - 1)


def _reciprocal(pair: Pair) -> Pair | None:
    """Return 1/f for a product f."""
    integral, factor = pair
    if integral.is_zero or integral.op == "add" or size(integral) > 60:
        return None
    return 1 / integral, -factor / integral**2
