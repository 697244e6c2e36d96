"""Expressions written shorter; a form counts only where it is proved equal to the expression."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import comb, prod
from typing import Any

from dofkit.base.deadline import OutOfTimeError, by_processor, check, left
from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon, Poly, is_identically_zero, lowest_terms
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.sympy_bridge import Bridge, UntranslatableError
from dofkit.expressions.tree import Expr
from dofkit.motion.lagrange.term_order import ordered

#: Expressions with more SymPy operations, or that would have more terms than this, are not expanded.
EXPANDED, TERMS, MANY = 3000, 1500, 10**9
#: Seconds for all expressions of one report.
SECONDS = 6.0
#: A product that hides a sum with velocities is read as if it were longer by so many symbols.
HIDDEN = 8
_RATES = ("velocity", "acceleration")


@dataclass
class Tidier:
    """Writes expressions as short as a form is found while ``seconds`` last."""

    bridge: Bridge
    positive: frozenset[Expr]
    seconds: float = SECONDS

    def __call__(self, e: Any) -> Expr:
        """Return an expression of SymPy's, written shorter."""
        return self.shorter(self.bridge.expr(e))

    def shorter(self, e: Expr) -> Expr:
        """Return the shortest form that is proved equal, in the order of terms that people expect."""
        best, size = e, length(e)
        start = time.thread_time()
        try:
            with by_processor(min(self.seconds, left())):
                for form in self._forms(e):
                    check()
                    if length(form) < size and is_identically_zero(form - e, self.positive) is True:
                        best, size = form, length(form)
        except OutOfTimeError:
            check()
        self.seconds -= time.thread_time() - start
        return ordered(best)

    def _forms(self, e: Expr) -> Iterator[Expr]:
        """Yield sums by rates with factored coefficients, then what SymPy expands, collects and joins to one angle."""
        check()
        if all(n.op in ("num", "sym") for n in ex.nodes(e)):
            return
        sorted_by_rates = by_rates(e, self.positive)
        forms = [e] if sorted_by_rates is None else [e, sorted_by_rates]
        yield from forms[1:]
        plain = self.bridge.sympy(forms[-1])
        if int(plain.count_ops()) > EXPANDED:
            return
        waves = any(n.op == "fn" and n.args[0] in ("sin", "cos") for n in ex.nodes(e))
        for form in self._by_sympy(plain, waves, terms(e) <= TERMS):
            check()
            try:
                yield self.bridge.expr(form)
            except (UntranslatableError, NoValueError):
                continue

    def _by_sympy(self, e: Any, waves: bool, expands: bool) -> Iterator[Any]:
        """Yield SymPy's forms: cos a cos b + sin a sin b = cos(a - b), terms expanded, 1 - cos^2 = sin^2."""
        import sympy
        from sympy.simplify.fu import TR6, TR10i

        if waves:
            yield TR10i(e)
        if expands:
            rates = [self.bridge.velocity(n, k) for k in (2, 1) for n in self.bridge.positions]
            expanded = sympy.expand(e)
            yield expanded
            yield sympy.collect(expanded, rates)
            if waves:
                yield TR10i(sympy.expand(TR6(expanded)))


def terms(e: Expr) -> int:
    """No fewer than the terms of any sum in ``e`` once products and powers are written out."""
    memo: dict[Expr, int] = {}
    for node in ex.nodes(e):
        parts = [memo[child] for child in ex.children(node)]
        if node.op == "add":
            many = sum(parts)
        elif node.op == "mul":
            many = prod(parts)
        elif node.op == "pow" and node.args[1].op == "num" and node.args[1].args[0].denominator == 1:
            power = min(abs(node.args[1].args[0].numerator), TERMS)
            many = comb(min(parts[0], TERMS) + power - 1, power)
        else:
            many = 1
        memo[node] = min(many, MANY)
    return max(memo.values())


def by_rates(e: Expr, positive: frozenset[Expr]) -> Expr | None:
    """In the canonical ring, a sum over the monomials in velocities and accelerations, each coefficient factored."""
    ring = Ring([e], positive)
    try:
        node = ring.node(e)
        canon = Canon(ring)
        top, bottom = canon.quotient(node)
        if any(_is_rate(canon, i) for i in canon.generators_in(bottom)):
            return None
        terms = [ex.mul(_factored(canon, part, bottom), rates) for rates, part in _grouped(canon, top)]
    except NoValueError:
        return None
    return ex.add(*terms) if terms else ex.ZERO


def _is_rate(canon: Canon, index: int) -> bool:
    shown = canon.ring.var_expr[index]
    return shown.op == "sym" and shown.args[0] in _RATES


def _grouped(canon: Canon, top: Poly) -> list[tuple[Expr, Poly]]:
    """The polynomial's parts by their monomials in rates."""
    shown = list(reversed(canon.ring.var_expr))
    moving = [e.op == "sym" and e.args[0] in _RATES for e in shown] or [False]
    groups: dict[tuple[int, ...], dict[tuple[int, ...], Any]] = {}
    for exponents, coefficient in top.to_dict().items():
        rates = tuple(int(k) if m else 0 for k, m in zip(exponents, moving, strict=True))
        rest = tuple(0 if m else int(k) for k, m in zip(exponents, moving, strict=True))
        groups.setdefault(rates, {})[rest] = coefficient
    return [
        (ex.mul(*(ex.power(v, ex.num(k)) for v, k in zip(shown, rates, strict=False) if k)), canon.ctx.from_dict(part))
        for rates, part in groups.items()
    ]


def _factored(canon: Canon, top: Poly, bottom: Poly) -> Expr:
    top, bottom = lowest_terms(top, bottom)
    return _product(canon, top) / _product(canon, bottom)


def _product(canon: Canon, poly: Poly) -> Expr:
    content, factors = poly.factor()[0], canon.factors(poly)
    number = ex.num(Fraction(int(content.p), int(content.q)))
    parts = [ex.power(canon.to_expr(f), ex.num(k)) for f, k in factors]
    if number != ex.ONE and len(parts) == 1 and parts[0].op == "add":
        return Expr("mul", (number, parts[0])) if number != ex.MINUS_ONE else -parts[0]
    return ex.mul(number, *parts)


def length(e: Expr) -> int:
    """How long an expression is to read."""
    hidden = e.op == "mul" and any(p.op == "add" and any(s.args[0] in _RATES for s in p.symbols) for p in e.args)
    return 1 + HIDDEN * hidden + sum(map(length, ex.children(e)))
