"""Closed forms: the function whose differential they are [PoincareLemma]."""

from __future__ import annotations

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.algebra import Algebra
from dofkit.integrability.integrals.antiderivative import antiderivative

#: Symbol -> coefficient, zeros too for the symbols that only coefficients mention.
Form = dict[Expr, Expr]
#: As many orders of integration are tried.
MAX_ORDERS = 4


def potential(work: Algebra, form: Form) -> Expr | None:
    """f with df = omega, one variable after the other; None where an antiderivative is not found."""
    symbols = list(form)
    for first in range(min(len(symbols), MAX_ORDERS)):
        found = _in_order(work, form, [*symbols[first:], *symbols[:first]])
        if found is not None:
            return found
    return None


def _in_order(work: Algebra, form: Form, order: list[Expr]) -> Expr | None:
    total, done = ex.ZERO, set[Expr]()
    for symbol in order:
        rest = form[symbol] - diff(total, symbol)
        if not done.isdisjoint(rest.symbols):
            rest = work.tidy(rest)
            if not done.isdisjoint(rest.symbols):
                return None
        part = ex.ZERO if rest.is_zero else antiderivative(work, rest, symbol)
        if part is None:
            return None
        total = total + part
        done.add(symbol)
    return total
