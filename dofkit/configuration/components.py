"""The parts of a configuration space: is there a larger one than that of the point that was found?

A regular point of r relations in n unknowns tells the dimension n - r of its own part. No part is smaller [Krull1928],
but one may be larger: y = (x - 1) u, (x - 1) v = y w, (x - 1) w = y u hold where x = 1, y = 0 whatever u, v, w are.
That none is larger is known where

- the relations but one give a coordinate each as a function of others: the set is a graph over a hypersurface;
- a Groebner basis shows the dimension of all complex points, or does so for every case [Buchberger1965].
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import product as cartesian
from math import prod
from typing import NamedTuple

from dofkit.base.errors import NoValueError
from dofkit.base.verdicts import ArgumentKey, weakest
from dofkit.configuration import cases as all_cases
from dofkit.configuration.variety import BRANCHED, Variety, chart_of_relations, field_jacobian, on_variety
from dofkit.exact.analyticity import is_analytic
from dofkit.exact.matrices.sparse import components, rank_of_rows
from dofkit.exact.ring.canonical import is_identically_zero, quotients_of
from dofkit.exact.ring.program import false_without_value, none_without_value
from dofkit.exact.zero import independent_generators
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Chart
from dofkit.relations.linear_relations import Explicit, explicit_relations

#: Relations that are looked at; cases of all parts together that are looked at, and that are listed.
MAX_RELATIONS, MAX_TOGETHER, MAX_PRODUCTS = 200, 16, 2000
LARGER = "over the complex numbers the set has a component of larger dimension, and its real points were not decided"
NO_CASE = "no configuration satisfies all equations: each case leads to an equation without a solution"
NEAR = (
    "the freedom is that of the component of the configuration space that contains the witness: a larger "
    "component was not excluded"
)
#: A case of each part, which hold together.
Choice = tuple[all_cases.BoundedCase, ...]
OTHERS = "whether several components pass through the point that was found was not decided"


class RelationPart(NamedTuple):
    """Relations between ``unknowns`` that no other relations share."""

    relations: tuple[Expr, ...]
    unknowns: tuple[Expr, ...]


def largest_component(chart: Chart, variety: Variety, find: Callable[[Chart], Variety], case: bool = False) -> Variety:
    """What is known of the set, for its component of largest dimension; ``find`` gives that of another chart.

    ``case``: what was found is the set of a case, which is a part of this one.
    """
    if variety.dimension is None or not variety.consistent:
        return variety
    near = _near_its_point if case else _near
    if _in_regions(chart) or len(chart.relations) > MAX_RELATIONS:
        return near(variety)
    if len(chart.relations) < 2:
        least = chart.coordinates - len(chart.relations)
        return _by(variety, "one relation") if variety.dimension >= least else _near(variety)
    set_cases = _cases_of_set(chart)
    if set_cases is None or not set_cases[2]:
        return near(variety)
    solved, loose, together = set_cases
    best, open_, regular = variety, list[bool](), _is_regular(chart, variety)
    for number, choice in enumerate(together):
        if loose + _most(choice) <= (best.dimension or 0):
            break
        if number == MAX_TOGETHER:
            return near(best) if best is variety else _near_its_point(best)
        larger = _variety_of(chart, _relations_of(solved, choice), find)
        if larger.consistent is False and larger.verdict == "proved":
            continue
        best, ended = _larger(chart, best, larger, loose + _most(choice))
        if not ended:
            open_.append(all(case.counted for case in choice))
    if any(open_) and regular:
        return replace(best, dimension=None, verdict="undecided", reasons=[*best.reasons, LARGER])
    if open_:
        return near(best) if best is variety else _near_its_point(best)
    best = _by(best, "cases" if solved.implicit else "graph")
    best = replace(best, separating=separating_expressions(together, (best.dimension or 0) - loose))
    exact = all(case.exact for choice in together for case in choice)
    return best if exact else replace(best, verdict=weakest(best.verdict, "probable"))


def separating_expressions(choices: Sequence[Sequence[all_cases.BoundedCase]], largest: int) -> tuple[Expr, ...]:
    """Return expressions that vanish in every case of the largest dimension and not in every smaller one.

    The shortest come first; where no relation occurs in all large cases, their product is the only one.
    """
    cases = [({g for case in choice for g in case.relations}, _most(choice)) for choice in choices]
    large, small = [c for c, most in cases if most == largest], [c for c, most in cases if most < largest]
    marking = [sorted((g for g in case if any(g not in other for other in small)), key=_length) for case in large]
    if not marking or not all(marking):
        return ()
    common = [g for g in marking[0] if all(g in case for case in large)]
    return tuple(common) or (ex.mul(*dict.fromkeys(case[0] for case in marking)),)


def _length(e: Expr) -> tuple[int, str]:
    return sum(1 for _ in ex.nodes(e)), repr(e)


def _variety_of(chart: Chart, relations: Sequence[Expr], find: Callable[[Chart], Variety]) -> Variety:
    """What is known of the set of other relations; nothing where they have no value at the points that are tried."""
    try:
        return find(_restricted(chart, relations))
    except NoValueError:
        return Variety(None, None, "undecided")


def _is_regular(chart: Chart, variety: Variety) -> bool:
    """Return whether the relations have as large a rank there as the dimension says."""
    rank = (
        None if not variety.samples else rank_of_rows(field_jacobian(chart, variety.samples[0]), variety.samples[0].p)
    )
    return rank is not None and variety.dimension == chart.coordinates - rank


def by_cases(chart: Chart, variety: Variety, find: Callable[[Chart], Variety]) -> Variety:
    """What is known of a set of which no regular point was found: the first case with points, or that none has any."""
    if not 0 < len(chart.relations) <= MAX_RELATIONS:
        return variety
    set_cases = _cases_of_set(chart)
    if set_cases is None:
        return variety
    solved, _, together = set_cases
    if not together:
        parametric = [g for g in solved.implicit if any(s.args[0] == "parameter" for s in g.symbols)]
        return Variety(False, None, "probable" if parametric else "proved", reasons=[NO_CASE], argument="cases")
    for choice in together[:MAX_TOGETHER]:
        relations = _relations_of(solved, choice)
        if set(relations) == set(chart.relations) and not variety.parted:
            continue
        seen = _variety_of(chart, relations, find)
        samples = [p for p in seen.samples if on_variety(chart, p)]
        if seen.consistent and samples:
            return replace(seen, samples=samples)
    return variety


def _by(variety: Variety, argument: ArgumentKey) -> Variety:
    """What was found at a regular point, of all parts by an argument."""
    return replace(variety, argument=argument) if variety.argument == "regular point" else variety


def _near(variety: Variety) -> Variety:
    """The variety, as a claim about its own component only."""
    return replace(variety, about="component", reasons=[*variety.reasons, NEAR])


def _near_its_point(case: Variety) -> Variety:
    """Return the same of a case, a part of the set: near its point the rest of the set may be larger."""
    return replace(case, dimension=None, verdict="undecided", reasons=[*case.reasons, OTHERS])


def _most(choice: Iterable[all_cases.BoundedCase]) -> int:
    return sum(case.most for case in choice)


def _larger(chart: Chart, best: Variety, other: Variety, most: int) -> tuple[Variety, bool]:
    """Return the larger of two varieties, and whether the other has the dimension ``most``: none can be larger."""
    samples = [p for p in other.samples if on_variety(chart, p)]
    if not other.consistent or other.dimension is None or not samples:
        return best, False
    larger = other.dimension > (best.dimension or 0)
    return (replace(other, samples=samples) if larger else best), other.dimension >= most


def _restricted(chart: Chart, relations: Sequence[Expr]) -> Chart:
    """The chart with other relations, in a ring of their own: they may have no value where those of the chart do."""
    ring = chart.ring.another(relations)
    for var in chart.ring.vars:
        if var.kind == "symbol":
            ring.symbol(var.key)
    return chart_of_relations(chart, relations, ring)


def is_graph(chart: Chart) -> bool:
    """Return whether every relation gives a coordinate as a function of others on one region [ImplicitFunctions]."""
    if len(chart.relations) > MAX_RELATIONS or _in_regions(chart) or _has_branches(chart):
        return False
    return not explicit_relations(chart.relations).implicit


def _in_regions(chart: Chart) -> bool:
    """Return whether signs of what moves occur: on each side of their zeros other functions stand there.

    Signs of velocities part these, at every configuration.
    """
    moving = frozenset(s for s in chart.symbols if s != ex.TIME)
    signs = [chart.ring.var_expr[v.index].symbols for v in chart.ring.vars if v.kind == "sign"]
    return any(not moving.isdisjoint(u) and not any(s.args[0] == "velocity" for s in u) for u in signs)


def _has_branches(chart: Chart) -> bool:
    """Return whether functions of what moves may be related in some regions only: acos(cos(x)) is x, or -x.

    On the set y = x^2 so is sqrt(y). Elsewhere what is analytic has one relation in all regions, and independent
    generators have none.
    """
    moving, related = frozenset(chart.symbols), frozenset[Expr]().union(*(g.symbols for g in chart.relations))
    branched = [chart.ring.var_expr[v.index] for v in chart.ring.vars if v.kind in BRANCHED]
    independent = independent_generators(chart.ring)
    return any(
        not related.isdisjoint(moving & e.symbols)
        or not (independent or is_analytic(e, moving, chart.setting.positive))
        for e in branched
    )


@false_without_value
def is_irreducible(chart: Chart) -> bool:
    """Return whether the set is known to have one component: what is generic at a regular point is so at all of them.

    So have a graph, and the zeros of one polynomial without factors: parts that it may have over larger numbers are
    conjugate, and as good as each other where no such number occurs (x - sqrt(2) y is 0 on one part of x^2 = 2 y^2).
    """
    if len(chart.relations) > MAX_RELATIONS or _in_regions(chart) or _has_branches(chart):
        return False
    implicit = explicit_relations(chart.relations).implicit
    if len(implicit) != 1:
        return not implicit
    canon, [(top, _)] = quotients_of(implicit, chart.setting.positive)
    factors = canon.factors(top)
    ring = canon.ring
    numbers = any(
        v.kind in ("root", "cos") and chart.ring.var_expr[v.index].symbols.isdisjoint(chart.symbols)
        for v in chart.ring.vars
    )
    plain = not numbers and all(ring.vars[i].kind == "symbol" for i in canon.generators_in(top))
    moving = [i for s in chart.symbols if s != ex.TIME and (i := ring.var_index(s)) is not None]
    return plain and sum(not {*canon.generators_in(f)}.isdisjoint(moving) for f, _ in factors) == 1


def parts_of(relations: Sequence[Expr], symbols: Sequence[Expr]) -> list[RelationPart]:
    """Return the relations by the coordinates that they share; the moment is any."""
    coordinates = frozenset(symbols)
    groups = []
    for numbers in components(g.symbols & coordinates for g in relations):
        shared = tuple(relations[i] for i in numbers)
        mentioned = frozenset().union(*(g.symbols for g in shared))
        groups.append(RelationPart(shared, tuple(s for s in symbols if s in mentioned)))
    return groups


def _cases_of_set(chart: Chart) -> tuple[Explicit, int, list[Choice]] | None:
    """Return what the relations give explicitly, the number of coordinates in no other, and choices of cases of parts.

    The largest choices come first; there is none where a part has no case. None where they are too many.
    """
    solved = explicit_relations(chart.relations)
    groups = parts_of(solved.implicit, [s for s in chart.symbols if s != ex.TIME])
    cases = [_cases(part, chart) for part in groups]
    if [] not in cases and (None in cases or prod(len(c or ()) for c in cases) > MAX_PRODUCTS):
        return None
    loose = chart.coordinates - len(solved.explicit) - sum(len(part.unknowns) for part in groups)
    return solved, loose, sorted(cartesian(*(c or () for c in cases)), key=lambda choice: -_most(choice))


def _relations_of(solved: Explicit, choice: Choice) -> list[Expr]:
    return [*solved.explicit.values(), *(g for case in choice for g in case.relations)]


@none_without_value
def _cases(part: RelationPart, chart: Chart) -> list[all_cases.BoundedCase] | None:
    """Return the cases of a part with the bounds of their dimensions."""
    nonzero = [g for g in part.relations if is_identically_zero(g, chart.setting.positive) is not True]
    return all_cases.cases_of(nonzero, part.unknowns, chart.setting.positive)
