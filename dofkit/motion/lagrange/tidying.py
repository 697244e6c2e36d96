"""Expressions written shorter, with terms, factors and signs in the order of a textbook.

A shorter form is used only if it is proved equal to the expression.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import comb, gcd, lcm, prod
from typing import Any

from dofkit.base.deadline import OutOfTimeError, by_processor, check, remaining_seconds, thread_time
from dofkit.base.errors import NoValueError
from dofkit.exact.ring.canonical import Canon, Poly, is_identically_zero, lowest_terms, quotients_of
from dofkit.exact.ring.program import none_without_value
from dofkit.expressions import tree as ex
from dofkit.expressions.sympy_bridge import Bridge, UntranslatableError
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import Expr

#: The most SymPy operations, and terms after expansion, of an expression that is rewritten; a bound on counts of terms.
EXPANDED, TERMS, MANY = 3000, 1500, 10**9
#: The most terms of a sum in which angles are combined, because SymPy compares every two terms.
JOINED = 60
#: Seconds of processor time for all expressions of one report.
SECONDS = 6.0
#: What a product with a sum of velocities as a factor adds to the length, because it is hard to read.
HIDDEN = 8
_RATES = ("velocity", "acceleration")


@dataclass
class Tidier:
    """Writes expressions in the shortest form that is found, within ``seconds`` of processor time in total."""

    bridge: Bridge
    positive: frozenset[Expr]
    seconds: float = SECONDS

    def __call__(self, e: Any) -> Expr:
        """Return a SymPy expression as an `Expr` in its shortest form."""
        return self.shorter(self.bridge.from_sympy(e))

    def shorter(self, e: Expr) -> Expr:
        """Return the shortest form that is proved equal to ``e``, in the usual order of terms."""
        best, size = e, length(e)
        start = thread_time()
        try:
            with by_processor(min(self.seconds, remaining_seconds())):
                for form in self._forms(e):
                    check()
                    if length(form) < size and is_identically_zero(form - e, self.positive) is True:
                        best, size = form, length(form)
        except OutOfTimeError:
            check()
        self.seconds -= thread_time() - start
        return ordered(best)

    def _forms(self, e: Expr) -> Iterator[Expr]:
        """Yield other forms of e: collected by velocities with factored coefficients, then those of SymPy."""
        check()
        if all(n.op in ("num", "sym") for n in ex.nodes(e)):
            return
        sorted_by_rates = by_rates(e, self.positive)
        forms = [e] if sorted_by_rates is None else [e, sorted_by_rates]
        yield from forms[1:]
        plain = self.bridge.to_sympy(forms[-1])
        if int(plain.count_ops()) > EXPANDED:
            return
        waves = any(n.op == "fn" and n.args[0] in ("sin", "cos") for n in ex.nodes(e))
        for form in self._by_sympy(plain, waves, terms(e) <= TERMS):
            check()
            try:
                yield self.bridge.from_sympy(form)
            except (UntranslatableError, NoValueError):
                continue

    def _by_sympy(self, e: Any, waves: bool, expands: bool) -> Iterator[Any]:
        """Yield SymPy's forms: cos a cos b + sin a sin b = cos(a - b) applied, expanded, 1 - cos^2 = sin^2 applied."""
        import sympy
        from sympy.simplify.fu import TR6, TR10i

        if waves and terms(self.bridge.from_sympy(e)) <= JOINED:
            yield TR10i(e)
        if expands:
            rates = [self.bridge.velocity(n, k) for k in (2, 1) for n in self.bridge.positions]
            expanded = sympy.expand(e)
            yield expanded
            yield sympy.collect(expanded, rates)
            if waves and len(expanded.args) <= JOINED:
                yield TR10i(sympy.expand(TR6(expanded)))


def terms(e: Expr) -> int:
    """Return an upper bound, at most `MANY`, on the number of terms in any sum of ``e`` after expansion."""
    memo: dict[Expr, int] = {}
    for node in ex.nodes(e):
        counts = [memo[child] for child in ex.children(node)]
        if node.op == "add":
            many = sum(counts)
        elif node.op == "mul":
            many = prod(counts)
        elif node.op == "pow" and node.args[1].op == "num" and node.args[1].args[0].denominator == 1:
            power = min(abs(node.args[1].args[0].numerator), TERMS)
            many = comb(min(counts[0], TERMS) + power - 1, power)
        else:
            many = 1
        memo[node] = min(many, MANY)
    return max(memo.values())


@none_without_value
def by_rates(e: Expr, positive: frozenset[Expr]) -> Expr | None:
    """Return ``e`` as a sum over monomials in velocities and accelerations with factored coefficients, or None."""
    canon, [(top, bottom)] = quotients_of([e], positive)
    if any(_is_rate(canon, i) for i in canon.generators_in(bottom)):
        return None
    terms = [ex.mul(_factored(canon, part, bottom), rates) for rates, part in _grouped(canon, top)]
    return ex.add(*terms) if terms else ex.ZERO


def _is_rate(canon: Canon, index: int) -> bool:
    generator = canon.ring.var_expr[index]
    return generator.op == "sym" and generator.args[0] in _RATES


def _grouped(canon: Canon, top: Poly) -> list[tuple[Expr, Poly]]:
    """Return (monomial in velocities and accelerations, its coefficient) for each one in a polynomial."""
    generators = canon.ring.var_expr
    rates = {i for i in range(len(generators)) if _is_rate(canon, i)}
    coefficients = canon.collected(top, rates)
    return [(ex.mul(*(ex.power(generators[i], ex.num(k)) for i, k in m)), part) for m, part in coefficients.items()]


def _factored(canon: Canon, top: Poly, bottom: Poly) -> Expr:
    top, bottom = lowest_terms(top, bottom)
    return _factored_product(canon, top) / _factored_product(canon, bottom)


def _factored_product(canon: Canon, poly: Poly) -> Expr:
    factors, content = canon.factors(poly), poly.factor()[0]
    number = ex.num(Fraction(int(content.p), int(content.q)))
    powers = [ex.power(canon.to_expr(f), ex.num(k)) for f, k in factors]
    if number != ex.ONE and len(powers) == 1 and powers[0].op == "add":
        return Expr("mul", (number, powers[0])) if number != ex.MINUS_ONE else -powers[0]
    return ex.mul(number, *powers)


def length(e: Expr) -> int:
    """Return the length of an expression for a reader: the number of nodes as written, more for `HIDDEN` sums."""
    lengths: dict[Expr, int] = {}
    for node in ex.nodes(e):
        sums = [p for p in node.args if p.op == "add"] if node.op == "mul" else []
        hidden = any(s.args[0] in _RATES for p in sums for s in p.symbols)
        lengths[node] = 1 + HIDDEN * hidden + sum(lengths[child] for child in ex.children(node))
    return lengths[e]


_KINDS = {"parameter": 0, "time": 1, "coordinate": 2, "velocity": 4, "acceleration": 5}
#: First letters of parameters in the order of writing: masses, inertias, stiffness and damping, gravity.
_LETTERS = ("mM", "IJ", "kc", "g")
#: The highest exponent of a sum from which a numerical factor is taken out.
_HIGHEST = 4
_LETTER = re.compile(r"([A-Za-z])_?(?:\d\w*|(?<=_)\w+)?")


def ordered(e: Expr) -> Expr:
    """Return ``e`` with its terms and factors in the usual order, and with few minus signs."""
    memo: dict[Expr, Expr] = {}
    for node in ex.nodes(e):
        operands = tuple(memo[child] for child in ex.children(node))
        if node.op == "add":
            memo[node] = _sum(operands)
        elif node.op == "mul":
            memo[node] = _product(operands)
        else:
            memo[node] = ex.rebuild(node, operands)
    return memo[e]


def _sum(terms: tuple[Expr, ...]) -> Expr:
    return Expr("add", tuple(sorted(terms, key=_term)))


def _product(factors: tuple[Expr, ...]) -> Expr:
    """Return the product, with signs and numerical factors of its sums taken out.

    ``-a*(-b - c)`` is ``a*(b + c)``, ``a*(cos(x) - 1)`` is ``-a*(1 - cos(x))``, ``(a/2 + b/2)*c`` is ``(a + b)*c/2``;
    a minus sign goes into a difference of constants.
    """
    number, kept = Fraction(1), []
    for factor in factors:
        base, exponent = factor.args if factor.op == "pow" else (factor, ex.ONE)
        if base.op == "num" and exponent == ex.ONE:
            number *= base.args[0]
            continue
        whole = exponent.op == "num" and exponent.args[0].denominator == 1
        content = _content(base) if base.op == "add" and whole else Fraction(1)
        if content != 1 and abs(exponent.args[0]) <= _HIGHEST:
            base = _sum(tuple(_times(term, 1 / content) for term in base.args))
            number *= content ** exponent.args[0].numerator
            factor = base if exponent == ex.ONE else Expr("pow", (base, exponent))
        kept.append(factor)
    turned = next((k for k, part in enumerate(kept) if _is_reversible(part)), None) if number < 0 else None
    if turned is not None:
        kept[turned], number = _sum(tuple(_times(term, Fraction(-1)) for term in kept[turned].args)), -number
    return _times(Expr("mul", tuple(sorted(kept, key=_factor))) if len(kept) != 1 else kept[0], number)


def _is_reversible(e: Expr) -> bool:
    """Return whether ``e`` is a sum of parameters with as many minus as plus signs, which is as good reversed."""
    constants = e.op == "add" and all(s.args[0] == "parameter" for s in e.symbols)
    return constants and 2 * sum(map(_is_negative, e.args)) == len(e.args)


def _content(e: Expr) -> Fraction:
    """Return the common numerical factor of the terms of a sum, negative if that saves minus signs."""
    numbers = [ex.number_and_rest(term)[0] for term in e.args]
    common = Fraction(gcd(*(n.numerator for n in numbers)), lcm(*(n.denominator for n in numbers)))
    return -common if _better_negated(e) else common


def _times(term: Expr, number: Fraction) -> Expr:
    """Return number * term, with the factors in their order."""
    factor, others = ex.number_and_rest(term)
    number *= factor
    if number == 1 or others == ex.ONE:
        return others if number == 1 else ex.num(number)
    return Expr("mul", (ex.num(number), *(others.args if others.op == "mul" else (others,))))


def _better_negated(e: Expr) -> bool:
    """Return whether a sum has more minus than plus signs, or is like ``cos(x) - 1``."""
    below = sum(map(_is_negative, e.args))
    if len(e.args) == 2 and below == 1:
        return any(t.op == "num" and t.args[0] < 0 for t in e.args) and any(t.op == "fn" for t in e.args)
    return 2 * below > len(e.args)


def _is_negative(term: Expr) -> bool:
    return ex.number_and_rest(term)[0] < 0


def _orders(e: Expr, kind: str) -> int:
    return sum(s.args[0] == kind for s in e.symbols)


def _term(e: Expr) -> tuple[bool, bool, bool, bool, tuple[object, ...]]:
    """Return the sort key of a term: accelerations, velocities, others; positive before negative; constants first."""
    factors = e.args if e.op == "mul" else (e,)
    moving = any(s.args[0] != "parameter" for s in e.symbols)
    quick = not _orders(e, "acceleration"), not _orders(e, "velocity")
    return *quick, _is_negative(e), moving, tuple(map(_factor, factors))


def _factor(e: Expr) -> tuple[int, int, str]:
    """Return the sort key: numbers, parameters, coordinates, functions and sums, velocities, accelerations."""
    base = e.args[0] if e.op == "pow" else e
    if base.op == "num":
        return -1, 0, to_text(base)
    if base.op == "sym":
        kind, name = base.args
        return _KINDS.get(kind, 6), _place_of(name) if kind == "parameter" else 0, name
    if all(s.args[0] == "parameter" for s in base.symbols):
        return 0, min((_place_of(s.args[1]) for s in base.symbols), default=0), to_text(base)
    return 3, 0, to_text(base)


def _place_of(parameter: str) -> int:
    """Return the place of a parameter in a product by its letter, as in ``m g l``, ``m l^2``, ``k x``."""
    match = _LETTER.fullmatch(parameter)
    letter = match[1] if match is not None else ""
    return next((place for place, letters in enumerate(_LETTERS) if letter and letter in letters), len(_LETTERS))
