"""Numbers that were rounded: the roots and fractions that they may stand for."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from itertools import product
from math import pi, sqrt

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import replace_nodes
from dofkit.expressions.text import Comparison
from dofkit.expressions.tree import Expr
from dofkit.homework.answers.relations import AnswerReading

#: Numbers of more digits than whole ones and of at most so many are taken for rounded.
_ROOTS, _BELOW, _MOST_NUMBERS, _MOST_WAYS = (1, 2, 3, 5, 6, 7, 10), 12, 3, 12


def exact_ways(way: AnswerReading) -> Iterator[AnswerReading]:
    """The reading with its decimals replaced by exact numbers that round to them."""
    decimals = sorted(
        {n for c in way.relations for e in (c.left, c.right) for n in ex.nodes(e) if _is_decimal(n)}, key=repr
    )
    if not 0 < len(decimals) <= _MOST_NUMBERS:
        return
    choices = [list(_meant(n.args[0]))[:_MOST_WAYS] for n in decimals]
    for count, chosen in enumerate(product(*choices)):
        if count == _MOST_WAYS:
            return
        table = dict(zip(decimals, chosen, strict=True))
        relations = tuple(
            Comparison(replace_nodes(c.left, table), c.relation, replace_nodes(c.right, table), c.column)
            for c in way.relations
        )
        yield way._replace(relations=relations)


def _is_decimal(n: Expr) -> bool:
    """A number of two decimals or more, such as 0.58."""
    return n.op == "num" and _places(n.args[0]) >= 2


def _places(value: Fraction) -> int:
    """How many decimals a number has; 0 where it is no decimal."""
    for places in range(9):
        if (value * 10**places).denominator == 1:
            return places
    return 0


def _meant(value: Fraction) -> Iterator[Expr]:
    """Roots and fractions that give it when rounded, the simplest first; its sign is kept."""
    half = Fraction(1, 2 * 10 ** _places(value))
    sign = ex.num(-1 if value < 0 else 1)
    for figure, exact in _table():
        if abs(figure - abs(value)) <= half:
            yield sign * exact


@cache
def _table() -> tuple[tuple[float, Expr], ...]:
    found: dict[float, Expr] = {}
    for root in _ROOTS:
        for below in range(1, _BELOW + 1):
            for above in range(1, 2 * _BELOW):
                exact = ex.sqrt(ex.num(root)) * ex.num(Fraction(above, below))
                if root > 1 or 10**4 % Fraction(above, below).denominator:
                    found.setdefault(sqrt(root) * above / below, exact)
    for below in range(1, _BELOW + 1):
        found.setdefault(pi / below, ex.PI * ex.num(Fraction(1, below)))
    return tuple(found.items())
