"""Coordinates that analytic functions of one of them alone hold at isolated values: exp(x) = 1 + x says x = 0.

There the gradient may vanish, so that no interval test certifies a zero, and no polynomial takes the function's place.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from dofkit.configuration.components import RelationPart, explicit_relations, parts_of
from dofkit.configuration.generic_points import field_jacobian
from dofkit.configuration.variety import Variety
from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import differs_from_zero, interval_of
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.chart import Chart
from dofkit.relations.normal.exact_zeros import candidates, is_analytic_in_coordinates

MAX_RELATIONS = 40


def isolated(chart: Chart, found: Variety) -> Variety | None:
    """The set where some relations give a coordinate each and the others hold one coordinate each [IsolatedZeros].

    All of its points have such a coordinate at an isolated value, so its dimension is the number of the others; that
    it has points is shown by an exact common zero. What says nothing beside those given is left out: sin(z) = 0 beside
    z = pi. None where the relations are not so, or no zero was found. What was
    ``found`` over GF(p) is kept where it has the same rank.
    """
    if "balls" not in chart.engines or chart.time is not None or len(chart.relations) > MAX_RELATIONS:
        return None
    if not all(is_analytic_in_coordinates(g, poles=True) for g in chart.relations):
        return None
    given, left = explicit_relations(chart.relations)
    symbols = [s for s in chart.symbols if s != ex.TIME]
    needed = [g for g in left if g.symbols or not is_proved_zero(g, frozenset())]
    parts = parts_of(needed, symbols)
    if len(given) == len(chart.relations) or any(not _of_one_coordinate(part) for part in parts):
        return None
    zeros: dict[Expr, Expr] = {}
    for part in parts:
        zero = next(_common_zeros(part), None)
        if zero is None:
            return None
        zeros[part.unknowns[0]] = zero
    dimension = len(symbols) - len(given) - len(parts)
    samples = [p for p in found.samples if len(symbols) - rank_of_rows(field_jacobian(chart, p), p.p) == dimension]
    sure = Variety(True, dimension, "proved", samples, argument="isolated zeros")
    return replace(sure, witness=_witness(symbols, given, zeros))


def _of_one_coordinate(part: RelationPart) -> bool:
    """Do the relations hold one coordinate only, and is one of them somewhere not 0?"""
    if len(part.unknowns) != 1:
        return False
    return any(differs_from_zero(g) for g in part.relations)


def _common_zeros(part: RelationPart) -> Iterator[Expr]:
    """Exact values of the coordinate at which all of the relations vanish."""
    (s,) = part.unknowns
    for value in candidates(part.relations, s):
        try:
            there = [substitute(g, {s: value}) for g in part.relations]
            if all(interval_of(g) is not None and is_proved_zero(g, frozenset()) for g in there):
                yield value
        except NoValueError:
            continue


def _witness(symbols: Sequence[Expr], given: Sequence[Expr], zeros: dict[Expr, Expr]) -> dict[Expr, str] | None:
    """A point of the set; None where a coordinate that is given by others is none of short form."""
    known = {s: zeros.get(s, ex.ZERO) for s in symbols}
    for g in reversed(given):
        s = next((s for s in sorted(g.symbols, key=repr) if s not in zeros), None)
        if s is None or any(other != s and other not in zeros for other in g.symbols):
            return None
        slope = substitute(g, {**known, s: ex.ONE}) - substitute(g, {**known, s: ex.ZERO})
        known[s] = -substitute(g, {**known, s: ex.ZERO}) / slope
    return {s: to_text(value) for s, value in known.items()}
