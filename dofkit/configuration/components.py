"""The components of a configuration space: is there a larger one than that of the point that was found?

At a regular point of r independent relations in n unknowns its component has the dimension n - r. No component is
smaller [Krull1928], but one may be larger: y = (x - 1) u, (x - 1) v = y w, (x - 1) w = y u are satisfied for x = 1,
y = 0 and all u, v, w. It is known that none is larger if

- all relations except one are solved for a coordinate each: the set is a graph over a hypersurface;
- a Groebner basis gives the dimension of the complex points, of the set or of every case [Buchberger1965].
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

#: Bounds on the relations, and on the choices of cases that are analysed, and that are listed.
MAX_RELATIONS, MAX_TOGETHER, MAX_PRODUCTS = 200, 16, 2000
LARGER = "over the complex numbers the set has a component of larger dimension, and its real points were not decided"
NO_CASE = "no configuration satisfies all equations: each case leads to an equation without a solution"
NEAR = (
    "the freedom is that of the component of the configuration space that contains the witness: a larger "
    "component was not excluded"
)
#: One case for each part of the relations, to be satisfied together.
Choice = tuple[all_cases.BoundedCase, ...]
OTHERS = "whether several components pass through the point that was found was not decided"


class RelationPart(NamedTuple):
    """Relations, and their ``unknowns``, which occur in no other relations."""

    relations: tuple[Expr, ...]
    unknowns: tuple[Expr, ...]


def largest_component(chart: Chart, variety: Variety, find: Callable[[Chart], Variety], case: bool = False) -> Variety:
    """Return the variety of the component of largest dimension, given a ``variety`` near some point.

    ``find`` computes the variety of another chart; ``case``: the given variety is that of a case only. If a larger
    component cannot be excluded, the result is about the component of the point, or undecided.
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
    best, undecided, regular = variety, list[bool](), _is_regular(chart, variety)
    for number, choice in enumerate(together):
        if loose + _most(choice) <= (best.dimension or 0):
            break
        if number == MAX_TOGETHER:
            return near(best) if best is variety else _near_its_point(best)
        larger = _variety_of(chart, _relations_of(solved, choice), find)
        if larger.consistent is False and larger.verdict == "proved":
            continue
        best, reached = _larger(chart, best, larger, loose + _most(choice))
        if not reached:
            undecided.append(all(case.counted for case in choice))
    if any(undecided) and regular:
        return replace(best, dimension=None, verdict="undecided", reasons=[*best.reasons, LARGER])
    if undecided:
        return near(best) if best is variety else _near_its_point(best)
    best = _by(best, "cases" if solved.implicit else "graph")
    best = replace(best, separating=separating_expressions(together, (best.dimension or 0) - loose))
    exact = all(case.exact for choice in together for case in choice)
    return best if exact else replace(best, verdict=weakest(best.verdict, "probable"))


def separating_expressions(choices: Sequence[Sequence[all_cases.BoundedCase]], largest: int) -> tuple[Expr, ...]:
    """Return expressions that vanish in every case of the largest dimension and not in every smaller one.

    The shortest come first. If no relation occurs in all large cases, a product of one of each is the only result.
    """
    cases = [({g for case in choice for g in case.relations}, _most(choice)) for choice in choices]
    large, small = [c for c, most in cases if most == largest], [c for c, most in cases if most < largest]
    marking = [sorted((g for g in case if any(g not in other for other in small)), key=_length) for case in large]
    if not marking or not all(marking):
        return ()
    common = [g for g in marking[0] if all(g in case for case in large)]
    return tuple(common) or (ex.mul(*dict.fromkeys(case[0] for case in marking)),)


def _length(e: Expr) -> tuple[int, str]:
    return ex.size(e), repr(e)


def _variety_of(chart: Chart, relations: Sequence[Expr], find: Callable[[Chart], Variety]) -> Variety:
    """Return the variety of ``relations`` in the chart; undecided if they have no value at the points tried."""
    try:
        return find(_restricted(chart, relations))
    except NoValueError:
        return Variety(None, None, "undecided")


def _is_regular(chart: Chart, variety: Variety) -> bool:
    """Return whether the rank of the relations at the first sample agrees with the dimension."""
    rank = (
        None if not variety.samples else rank_of_rows(field_jacobian(chart, variety.samples[0]), variety.samples[0].p)
    )
    return rank is not None and variety.dimension == chart.coordinates - rank


def by_cases(chart: Chart, variety: Variety, find: Callable[[Chart], Variety]) -> Variety:
    """Return the variety of the first case with points, or an empty one if there is no case; else ``variety``."""
    if not 0 < len(chart.relations) <= MAX_RELATIONS:
        return variety
    set_cases = _cases_of_set(chart)
    if set_cases is None:
        return variety
    solved, _, choices = set_cases
    if not choices:
        parametric = [g for g in solved.implicit if any(s.args[0] == "parameter" for s in g.symbols)]
        return Variety(False, None, "probable" if parametric else "proved", reasons=[NO_CASE], argument="cases")
    for choice in choices[:MAX_TOGETHER]:
        relations = _relations_of(solved, choice)
        if set(relations) == set(chart.relations) and not variety.parted:
            continue
        of_case = _variety_of(chart, relations, find)
        samples = [p for p in of_case.samples if on_variety(chart, p)]
        if of_case.consistent and samples:
            return replace(of_case, samples=samples)
    return variety


def _by(variety: Variety, argument: ArgumentKey) -> Variety:
    """Return the variety with an argument for all components in place of "regular point"."""
    return replace(variety, argument=argument) if variety.argument == "regular point" else variety


def _near(variety: Variety) -> Variety:
    """The variety, as a claim about its own component only."""
    return replace(variety, about="component", reasons=[*variety.reasons, NEAR])


def _near_its_point(case: Variety) -> Variety:
    """Return the variety of a case as undecided, because the set may have a larger component through its point."""
    return replace(case, dimension=None, verdict="undecided", reasons=[*case.reasons, OTHERS])


def _most(choice: Iterable[all_cases.BoundedCase]) -> int:
    return sum(case.most for case in choice)


def _larger(chart: Chart, best: Variety, other: Variety, most: int) -> tuple[Variety, bool]:
    """Return (the larger of two varieties, whether the other one reaches the bound ``most`` on its dimension)."""
    samples = [p for p in other.samples if on_variety(chart, p)]
    if not other.consistent or other.dimension is None or not samples:
        return best, False
    larger = other.dimension > (best.dimension or 0)
    return (replace(other, samples=samples) if larger else best), other.dimension >= most


def _restricted(chart: Chart, relations: Sequence[Expr]) -> Chart:
    """Return the chart with other relations, in a new ring, as those of the chart may have no value where these do."""
    ring = chart.ring.another(relations)
    for var in chart.ring.vars:
        if var.kind == "symbol":
            ring.symbol(var.key)
    return chart_of_relations(chart, relations, ring)


def is_graph(chart: Chart) -> bool:
    """Return whether every relation can be solved for a coordinate, so that the set is a graph [ImplicitFunctions]."""
    if len(chart.relations) > MAX_RELATIONS or _in_regions(chart) or _has_branches(chart):
        return False
    return not explicit_relations(chart.relations).implicit


def _in_regions(chart: Chart) -> bool:
    """Return whether signs of expressions in coordinates (not velocities) occur, so that relations differ by region."""
    moving = frozenset(s for s in chart.symbols if s != ex.TIME)
    signs = [chart.ring.var_expr[v.index].symbols for v in chart.ring.vars if v.kind == "sign"]
    return any(not moving.isdisjoint(u) and not any(s.args[0] == "velocity" for s in u) for u in signs)


def _has_branches(chart: Chart) -> bool:
    """Return whether functions of the coordinates may be related in some regions only: acos(cos(x)) is x, or -x.

    On the set y = x^2 this is also so for sqrt(y). Analytic functions have the same relations everywhere, and
    independent generators have none.
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
    """Return whether the set is known to be irreducible, so that generic results are valid at all regular points.

    It is if it is a graph over the zeros of an irreducible polynomial, or of none. These may have several components
    over algebraic numbers, which are conjugate and alike if no such number occurs (x = +-sqrt(2) y in x^2 = 2 y^2).
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
    """Return the relations grouped by shared coordinates, each group with its unknowns; time joins none."""
    coordinates = frozenset(symbols)
    groups = []
    for numbers in components(g.symbols & coordinates for g in relations):
        shared = tuple(relations[i] for i in numbers)
        mentioned = frozenset().union(*(g.symbols for g in shared))
        groups.append(RelationPart(shared, tuple(s for s in symbols if s in mentioned)))
    return groups


def _cases_of_set(chart: Chart) -> tuple[Explicit, int, list[Choice]] | None:
    """Return (explicit solutions, number of coordinates in no implicit relation, choices of a case for each part).

    The choices of largest dimension come first; there is none if a part has no case. None if they are too many.
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
    """Return the cases of a part with the bounds on their dimensions; None if they are too many."""
    nonzero = [g for g in part.relations if is_identically_zero(g, chart.setting.positive) is not True]
    return all_cases.cases_of(nonzero, part.unknowns, chart.setting.positive)
