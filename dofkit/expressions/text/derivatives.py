"""Derivatives that a text may ask for: by time, by a symbol, total differentials."""

from __future__ import annotations

from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import DT, ONE, TIME, ZERO, Expr, add, call, differential, mul, nodes, sym, velocity


def size(e: Expr, limit: int) -> int:
    """The number of different nodes of ``e``, counted up to ``limit``."""
    count = 0
    for count, _ in enumerate(nodes(e), 1):
        if count >= limit:
            break
    return count


def _ordered(e: Expr) -> list[Expr]:
    """The symbols of ``e`` in an order that is the same in every run."""
    return sorted(e.symbols, key=lambda s: s.args)


def by_time(e: Expr) -> Expr | None:
    """The total derivative by time; None where that has no meaning here."""
    terms = []
    for symbol in _ordered(e):
        kind, name = symbol.args
        if kind == "coordinate":
            terms.append(mul(diff(e, symbol), velocity(name)))
        elif kind == "velocity":
            terms.append(mul(diff(e, symbol), sym("acceleration", name)))
        elif kind == "time":
            terms.append(diff(e, TIME))
        elif kind != "parameter":
            return None
    return add(*terms) if terms else ZERO


def total_differential(e: Expr) -> Expr | None:
    """The sum of the partial derivatives, each times its differential; None where motions occur."""
    terms = []
    for symbol in _ordered(e):
        kind, name = symbol.args
        if kind == "coordinate":
            terms.append(mul(diff(e, symbol), differential(name)))
        elif kind == "time":
            terms.append(mul(diff(e, TIME), DT))
        elif kind != "parameter":
            return None
    return add(*terms) if terms else ZERO


def raise_order(e: Expr, index: int) -> Expr:
    """The unknown function ``e`` differentiated once more by its argument ``index``, from 0."""
    name, orders, arguments = e.args
    return call(name, arguments, tuple(order + (i == index) for i, order in enumerate(orders)))


def over_dt(e: Expr) -> Expr | None:
    """``e`` divided by dt where it is linear in differentials: `dx/dt` is the velocity of x."""
    if e.op == "sym":
        if e == DT:
            return ONE
        return velocity(e.args[1]) if e.args[0] == "differential" else None
    if e.op == "add":
        terms = [over_dt(term) for term in e.args]
        found = [term for term in terms if term is not None]
        return add(*found) if len(found) == len(terms) else None
    if e.op == "mul":
        moving = [i for i, part in enumerate(e.args) if any(is_differential(s) for s in part.symbols)]
        if len(moving) == 1 and (moved := over_dt(e.args[moving[0]])) is not None:
            return mul(*e.args[: moving[0]], moved, *e.args[moving[0] + 1 :])
    return None


def is_differential(e: Expr) -> bool:
    """True for dq and dt."""
    return e.op == "sym" and e.args[0] in ("differential", "dt")
