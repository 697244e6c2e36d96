"""Integrals of Pfaffian forms: f and mu with df = mu omega, proposed by rules and proved by differentiating.

A result is returned only where df = mu omega holds identically in the canonical ring, component by component, and mu
is proved not to vanish at a point; a form for which no rule applies gives None. The work is bounded by a count of
steps, and that of SymPy by time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, count

from dofkit.exact.errors import raising_no_value
from dofkit.exact.zero import certainly_nonzero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.algebra import Algebra, GivenUpError, size
from dofkit.integrability.integrals.antiderivative import Form, potential
from dofkit.integrability.integrals.factors import FAMILIES, MAX_VARIABLES
from dofkit.integrability.integrals.normal_shape import Pair, arranged, cost, shapes, upright
from dofkit.relations.normal.pieces import Pfaffian

__all__ = ["Integral", "integrate"]

#: The largest form that is integrated, in nodes.
MAX_FORM = 300
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
    for family in FAMILIES if len(form) <= MAX_VARIABLES else FAMILIES[:1]:
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
