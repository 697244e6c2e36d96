"""Integrals of Pfaffian forms: f and mu with df = mu omega, proposed by rules and proved by differentiating.

A result is returned only where df = mu omega holds identically in the canonical ring, component by component, and mu
is proved not to vanish at a point; a form for which no rule applies gives None. The work is bounded by a count of
steps, and that of SymPy by time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, combinations, count
from typing import Any

from dofkit.exact.errors import raising_no_value
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.zero import certainly_nonzero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.algebra import Algebra, GivenUpError, Poly, Quotient, size, solve
from dofkit.integrability.integrals.normal_shape import Pair, arranged, cost, shapes, upright
from dofkit.integrability.integrals.potentials import Form, potential
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
    items = {s: a for s, a in form.items() if not work.vanishes(a)}
    if not items or sum(size(a) for a in items.values()) > MAX_FORM:
        return None
    mentioned = {s for a in items.values() for s in a.symbols if s.args[0] in ("coordinate", "time")} - set(items)
    whole: Form = items | dict.fromkeys(sorted(mentioned, key=repr), ex.ZERO)
    if work.closed(whole):
        closed = potential(work, whole)
        if closed is not None:
            for shown in dict.fromkeys((arranged(upright(closed)), arranged(closed), closed)):
                if _proved(work, whole, (shown, ex.ONE)):
                    return Integral(None, _equation(shown, whole))
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
    return holds and (mu.op == "num" or certainly_nonzero(mu, work.positive))


# integrating factors: mu with d(mu omega) = 0, each used only once that is proved


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
