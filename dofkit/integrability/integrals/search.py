"""Integrals of one Pfaffian form omega: f and mu with df = mu omega, proposed by rules and proved by differentiation.

A result is returned only if df = mu omega is an identity, component by component, and mu is proved non-zero at some
point; a form for which no rule applies gives None. The work is bounded by a number of steps, that of SymPy by time.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain, combinations, count

from dofkit.exact.ring.canonical import Canon, Monomial
from dofkit.exact.ring.program import raising_no_value
from dofkit.exact.ring.quotients import Poly, solve
from dofkit.exact.zero import certainly_nonzero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, exterior_derivative
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.potentials import Algebra, Form, GivenUpError, potential
from dofkit.integrability.integrals.writing import Pair, arranged, cost, shapes, upright
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


def integrate(
    form: Pfaffian, positive: frozenset[Expr], reference: Mapping[Expr, Expr] | None = None
) -> Integral | None:
    """Return f = C and mu with a proof of df = mu omega in (q, t), or None where no rule applies.

    Logarithms in f have values at the ``reference`` configuration.
    """
    work = Algebra(positive, reference)
    try:
        return _integrate(work, form)
    except (GivenUpError, RecursionError, ArithmeticError):
        return None


@raising_no_value
def _integrate(work: Algebra, form: Pfaffian) -> Integral | None:
    omega = {s: ex.ZERO if work.vanishes(a) else a for s, a in form.components.items()}
    sizes = [ex.size(a) for a in omega.values() if not a.is_zero]
    if not sizes or sum(sizes) > MAX_FORM:
        return None
    if work.closed(omega):
        f = potential(work, omega)
        if f is not None:
            for integral in dict.fromkeys((arranged(upright(f)), arranged(f), f)):
                if _proved(work, omega, (integral, ex.ONE)):
                    return Integral(None, _equation(work, integral, omega))
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
    return None if best is None else Integral(to_text(best[1]), _equation(work, best[0], form))


def _equation(work: Algebra, integral: Expr, form: Form) -> str:
    """Return ``f = C`` as text; the constant is named C1, C2, ... if C occurs in the form."""
    names = {s.args[1] for s in form} | {s.args[1] for a in form.values() for s in a.symbols}
    constant = next(name for name in chain(("C",), (f"C{i}" for i in count(1))) if name not in names)
    return f"{to_text(work.with_values(integral))} = {constant}"


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
    if sum(map(ex.size, scaled.values())) > 2 * MAX_FORM or not work.closed(scaled):
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
        system.extend(_coefficient_rows([canon.reduce(top * (below / bottom)) for top, bottom in row], fixed, canon))
    solution = solve(system, canon.unit)
    return None if solution is None else [canon.to_expr(a) / canon.to_expr(b) for a, b in solution]


def _coefficient_rows(polys: list[Poly], fixed: frozenset[int], canon: Canon) -> list[list[Poly]]:
    """Return a row of coefficients, one for each of ``polys``, for every monomial in the generators not ``fixed``.

    The ``fixed`` generators stay in the coefficients.
    """
    moving = set(range(len(canon.ring.vars))) - fixed
    by_monomial: dict[Monomial, list[Poly]] = {}
    for column, poly in enumerate(polys):
        for monomial, coefficient in canon.collected(poly, moving).items():
            by_monomial.setdefault(monomial, [canon.unit * 0] * len(polys))[column] = coefficient
    return list(by_monomial.values())
