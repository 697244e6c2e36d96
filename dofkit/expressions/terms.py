"""Sums as combinations of their terms, and keys that do not depend on their order."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import gcd

from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

#: Products of sums are multiplied out in arguments up to this many terms.
EXPAND_TERMS = 64


def expand(e: Expr) -> Expr:
    """Return ``e`` with products of sums and small powers of sums multiplied out."""
    if e.op == "add":
        return ex.add(*(expand(term) for term in e.args))
    if e.op == "mul":
        total: list[Expr] = [ex.ONE]
        for factor in (expand(f) for f in e.args):
            terms = factor.args if factor.op == "add" else (factor,)
            if len(total) * len(terms) > EXPAND_TERMS:
                return e
            total = [ex.mul(a, b) for a in total for b in terms]
        return ex.add(*total)
    if e.op == "pow" and e.args[1].op == "num" and e.args[0].op == "add":
        exponent = e.args[1].args[0]
        if exponent.denominator == 1 and 2 <= exponent <= 4:
            return expand(Expr("mul", (e.args[0],) * int(exponent)))
    return e


def linear_terms(e: Expr) -> dict[Expr, Fraction]:
    """Return ``e`` as a combination of its terms with rational coefficients, not 0; the number's term is `ONE`."""
    if e.op == "sym":
        return {e: Fraction(1)}
    total = expand(e)
    terms: dict[Expr, Fraction] = {}
    cancels = False
    for term in total.args if total.op == "add" else (total,):
        factor, base = ex.number_and_rest(term)
        if factor:
            base = sorted_product(base)
            if base in terms:
                factor += terms[base]
                cancels = cancels or not factor
            terms[base] = factor
    return {base: factor for base, factor in terms.items() if factor} if cancels else terms


def sorted_product(e: Expr) -> Expr:
    """Return the same product, its factors in an order of their own."""
    return Expr("mul", tuple(sorted(e.args, key=repr))) if e.op == "mul" else e


def sorted_sum(e: Expr) -> tuple[tuple[str, Fraction], ...]:
    """Return a key that does not depend on the order of terms."""
    return tuple(sorted((repr(base), factor) for base, factor in linear_terms(e).items()))


def content(e: Expr) -> tuple[Fraction, Expr]:
    """Return a sum as positive rational content times the rest."""
    factors = [ex.number_and_rest(t)[0] for t in e.args]
    top = gcd(*(abs(f.numerator) for f in factors))
    bottom = 1
    for f in factors:
        bottom = bottom * f.denominator // gcd(bottom, f.denominator)
    content = Fraction(top, bottom)
    return content, ex.mul(ex.num(1 / content), e)


def longest_number(expressions: Iterable[Expr]) -> int:
    """Return the bits of the longest numerator or denominator of a number that occurs; 0 where none does."""
    seen: set[Expr] = set()
    stack, longest = list(expressions), 0
    while stack:
        node = stack.pop()
        if node.op == "num":
            value: Fraction = node.args[0]
            longest = max(longest, value.numerator.bit_length(), value.denominator.bit_length())
        elif node.op != "sym" and node not in seen:
            seen.add(node)
            stack.extend(ex.children(node))
    return longest
