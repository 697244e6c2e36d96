"""Sums as combinations of their terms, keys that do not depend on their order, and symbols of one sum only."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from math import gcd
from typing import NamedTuple

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
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


class Combined(NamedTuple):
    """``expr`` is an expression with a coordinate in the place of each sum that ``sums`` gives for it by its name."""

    expr: Expr
    sums: Mapping[str, Expr]


def combined(e: Expr) -> Combined:
    """Return ``e`` in fewer symbols, where some of them occur through one sum with rational coefficients only.

    Sums that are looked at stand in a function. One of their coordinates takes the place of the sum, which is a change
    of coordinates, and none of the other symbols may be left.
    """
    sums: dict[str, Expr] = {}
    for total in sorted(dict.fromkeys(_sums_in_functions(e)), key=_weight):
        if any(str(s.args[-1]) in sums for s in total.symbols):
            continue
        terms = linear_terms(total)
        pivot = next((s for s in sorted(terms, key=repr) if s.args[0] == "coordinate"), None)
        if pivot is None:
            continue
        others = total - ex.num(terms[pivot]) * pivot
        substituted = substitute(e, {pivot: (pivot - others) / ex.num(terms[pivot])})
        if substituted.symbols.isdisjoint(total.symbols - {pivot}):
            e, sums[str(pivot.args[1])] = substituted, total
    return Combined(e, sums)


def _sums_in_functions(e: Expr) -> Iterator[Expr]:
    """Return the sums of several symbols, without their number, that functions stand around."""
    for node in ex.nodes(e) if e.functions else ():
        for argument in node.args[1:] if node.op == "fn" else ():
            if argument.op not in ("add", "mul") or len(argument.symbols) < 2:
                continue
            terms = linear_terms(argument)
            symbols = {s: c for s, c in terms.items() if s.op == "sym"}
            still = all(s.args[0] in ("coordinate", "parameter", "time") for s in symbols)
            if still and len(symbols) > 1 and len(terms) == len(symbols) + (ex.ONE in terms):
                yield ex.add(*(ex.num(c) * s for s, c in symbols.items()))


def _weight(total: Expr) -> Fraction:
    """Of sums that are multiples of each other the least goes first: cos(2 x - 2 y) is cos(2 u) with u = x - y."""
    return sum(map(abs, linear_terms(total).values()), Fraction(0))
