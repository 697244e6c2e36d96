"""Integrating factors: mu with d(mu omega) = 0.

Every family below proposes factors; one is used only once mu omega is proved to be closed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import combinations
from typing import Any

from dofkit.exact.ring.canonical import Canon
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.algebra import Algebra, Poly, Quotient, size, solve
from dofkit.integrability.integrals.antiderivative import Form, antiderivative

#: Past so many variables only the cheap factors are tried.
MAX_VARIABLES = 5
#: The largest d log mu/dw looked at, in nodes.
MAX_SIZE = 120
_W = ex.sym("parameter", "new combination")


def exponential(e: Expr) -> Expr:
    """Return exp(e), with exp(c log u) written as u^c."""
    parts = []
    for term in e.args if e.op == "add" else (e,):
        factors = term.args if term.op == "mul" else (term,)
        log = next((f for f in factors if f.op == "fn" and f.args[0] == "log"), None)
        if log is None or any(s.args[0] != "parameter" for f in factors if f is not log for s in f.symbols):
            parts.append(ex.fn("exp", term))
        else:
            parts.append(ex.power(log.args[1], ex.mul(*(f for f in factors if f is not log))))
    return ex.mul(*parts)


def exterior_derivative(form: Form) -> dict[tuple[Expr, Expr], Expr]:
    """Return d(omega) by pairs of variables: d a_j / d x_i - d a_i / d x_j."""
    return {(s, u): diff(b, s) - diff(a, u) for (s, a), (u, b) in combinations(form.items(), 2)}


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
    found = work.attempt(lambda: _common(work, present))
    return ex.ONE if found is None else found


def _common(work: Algebra, present: list[Expr]) -> Expr:
    canon, quotients = work.lowered(present)
    top, bottom = quotients[0]
    for above, below in quotients[1:]:
        top, bottom = top.gcd(above), bottom.gcd(below)
    return canon.to_expr(top) / canon.to_expr(bottom)


# -- factors that depend on one combination of variables -------------------------------------------


def combinations_of(form: Form) -> Iterator[tuple[Expr, dict[Expr, Expr]]]:
    """Yield combinations w of the variables, each with a curve on which w is the variable ``_W``."""
    for s in form:
        yield s, {s: _W}
    variables = [s for s, a in form.items() if not a.is_zero]
    if len(variables) > 2:
        yield ex.add(*(s * s for s in variables)), dict.fromkeys(variables[1:], ex.ZERO) | {variables[0]: ex.sqrt(_W)}
        yield ex.add(*variables), dict.fromkeys(variables[1:], ex.ZERO) | {variables[0]: _W}
    for s, u in combinations(variables, 2):
        yield s * u, {s: _W, u: ex.ONE}
        yield s / u, {s: _W, u: ex.ONE}
        yield s * s + u * u, {s: ex.sqrt(_W), u: ex.ZERO}
        yield s + u, {s: _W, u: ex.ZERO}
        yield s - u, {s: _W, u: ex.ZERO}
        yield s * s - u * u, {s: ex.sqrt(_W), u: ex.ZERO}


def of_combination(work: Algebra, form: Form) -> Iterator[Expr]:
    """Yield mu(w) with d log mu = p(w) dw, where p = -d(omega)/(dw ^ omega) has to depend on w alone."""
    curls = exterior_derivative(form)
    for w, curve in combinations_of(form):
        slope = _slope(work, form, curls, w)
        if slope is None:
            continue
        mu = _integrated(work, slope, w, curve)
        if mu is not None:
            yield mu


def _slope(work: Algebra, form: Form, curls: dict[tuple[Expr, Expr], Expr], w: Expr) -> Expr | None:
    """Return p from the first pair of variables that determines it, or None where it does not depend on w alone."""
    for (s, u), curl in curls.items():
        wedge = diff(w, s) * form[u] - diff(w, u) * form[s]
        if wedge.is_zero:
            if not work.vanishes(curl):
                return None
            continue
        if work.vanishes(wedge):
            continue
        slope = work.tidy(-curl / wedge)
        return slope if size(slope) <= MAX_SIZE and _depends_on(work, slope, w, list(form)) else None
    return None


def _depends_on(work: Algebra, e: Expr, w: Expr, variables: list[Expr]) -> bool:
    """Return whether de ^ dw = 0, so that ``e`` is a function of w."""
    if w.op == "sym":
        return all(s == w or s not in e.symbols for s in variables)
    pairs = combinations(variables, 2)
    return all(work.vanishes(diff(e, s) * diff(w, u) - diff(e, u) * diff(w, s)) for s, u in pairs)


def _integrated(work: Algebra, slope: Expr, w: Expr, curve: dict[Expr, Expr]) -> Expr | None:
    """Return exp of the antiderivative of p, at w."""
    if slope.is_zero:
        return None
    restricted = work.attempt(lambda: work.tidy(substitute(slope, curve)))
    log = None if restricted is None else antiderivative(work, restricted, _W)
    return None if log is None else substitute(exponential(log), {_W: w})


# -- products of powers of the factors that occur ---------------------------------------------------


def of_powers(work: Algebra, form: Form) -> Iterator[Expr]:
    """Yield mu = prod g_k^c_k with constants c_k [Darboux1878].

    The g_k are variables, factors of the coefficients, and exponentials.
    """
    logs = _candidates(work, form)
    if not logs:
        return
    found = work.attempt(lambda: _constants(work, form, logs))
    if found:
        yield exponential(ex.add(*(c * g for c, g in zip(found, logs, strict=True))))


def _candidates(work: Algebra, form: Form) -> list[Expr]:
    """Return the logarithms of possible factors, and the exponents x and x^2/2."""
    bases: dict[Expr, None] = dict.fromkeys(form)
    for coefficient in form.values():
        tidy = work.tidy(coefficient)
        for factor in tidy.args if tidy.op == "mul" else (tidy,):
            base = factor.args[0] if factor.op == "pow" else factor
            if any(s in base.symbols for s in form):
                bases[base] = None
    variables = list(form)
    return [ex.fn("log", b) for b in list(bases)[:10]] + variables + [s * s / 2 for s in variables]


def _constants(work: Algebra, form: Form, logs: list[Expr]) -> list[Expr] | None:
    """Return c with sum c_k (dg_k ^ omega) + d(omega) = 0, by comparing coefficients."""
    rows: list[list[Expr]] = []
    for (s, u), curl in exterior_derivative(form).items():
        wedges = [diff(g, s) * form[u] - diff(g, u) * form[s] for g in logs]
        rows.append([*wedges, -curl])
    flat = [e for row in rows for e in row]
    canon, quotients = work.lowered(flat)
    fixed = frozenset(i for i, e in enumerate(canon.ring.var_expr) if e.symbols.isdisjoint(form))
    system: list[list[Quotient]] = []
    width = len(logs) + 1
    for start in range(0, len(quotients), width):
        row = quotients[start : start + width]
        below = canon.one
        for _, bottom in row:
            below = below * (bottom / below.gcd(bottom))
        system.extend(_compared([canon.reduce(top * (below / bottom)) for top, bottom in row], fixed, canon))
    found = solve(system, canon.one)
    return None if found is None else [canon.to_expr(a) / canon.to_expr(b) for a, b in found]


def _compared(polys: list[Poly], fixed: frozenset[int], canon: Canon) -> list[list[Quotient]]:
    """Return one equation for every monomial in the generators that are not ``fixed``."""
    count = len(canon.ring.vars)
    parts: dict[tuple[int, ...], list[dict[tuple[int, ...], Any]]] = {}
    for column, poly in enumerate(polys):
        for exponents, coefficient in poly.to_dict().items():
            inside = tuple(int(k) if count - 1 - i in fixed else 0 for i, k in enumerate(exponents))
            outside = tuple(int(k) - j for k, j in zip(exponents, inside, strict=True))
            parts.setdefault(outside, [{} for _ in polys])[column][inside] = coefficient
    return [[(canon.ctx.from_dict(part), canon.one) for part in row] for row in parts.values()]


Proposals = Callable[[Algebra, Form], Iterator[Expr]]
#: In order of cost.
FAMILIES: tuple[Proposals, ...] = (simple, of_combination, of_powers)
