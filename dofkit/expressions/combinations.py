"""Symbols that occur through one linear combination only: sin(x - y) = x - y is sin(x) = x with x - y for x."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import NamedTuple

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr


class Combined(NamedTuple):
    """``expr`` is an expression with a coordinate in the place of each sum that ``sums`` gives for it by its name."""

    expr: Expr
    sums: Mapping[str, Expr]


def combined(e: Expr) -> Combined:
    """``e`` in fewer symbols, where some of them occur through one sum with rational coefficients only.

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
        rest = total - ex.num(terms[pivot]) * pivot
        found = substitute(e, {pivot: (pivot - rest) / ex.num(terms[pivot])})
        if found.symbols.isdisjoint(total.symbols - {pivot}):
            e, sums[str(pivot.args[1])] = found, total
    return Combined(e, sums)


def _sums_in_functions(e: Expr) -> Iterator[Expr]:
    """The sums of several symbols, without their number, that functions stand around."""
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
