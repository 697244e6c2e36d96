"""A set of zeros divided into cases: a product is 0 where a factor is, a x + b where x = -b/a or where a = b = 0.

In each case most relations are solved for one coordinate each. Elimination that only divides by ``a`` misses the part
of the set with a = 0, which may be larger.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from dofkit.base.deadline import check
from dofkit.exact.analyticity import is_analytic
from dofkit.exact.ideals import dimension_of, echelon_by_degree
from dofkit.exact.ring.canonical import Canon, is_identically_zero, quotients_of
from dofkit.exact.ring.program import false_without_value
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import independent_generators
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.linear_relations import linear
from dofkit.relations.normal.zero_set import zero_set

#: Bound on the number of cases, and on the nodes of an expression after substituting a coordinate.
MAX_CASES, MAX_NODES = 48, 300


@dataclass(frozen=True)
class ZeroCase:
    """``solved`` relations, one for each unknown eliminated, ``unsolved`` ones, and expressions that are ``nonzero``.

    ``fresh``: further relations, which have not yet been split into factors.
    """

    solved: tuple[Expr, ...]
    unsolved: tuple[Expr, ...]
    fresh: tuple[Expr, ...]
    nonzero: tuple[Expr, ...] = ()

    @property
    def relations(self) -> tuple[Expr, ...]:
        """All relations of the case."""
        return self.solved + self.unsolved + self.fresh


@dataclass(frozen=True)
class BoundedCase:
    """The relations of a case, and a bound (``most``) on the dimension of its set.

    ``counted``: the bound is the dimension of the set of complex points. ``exact``: it is so for generic constants, not
    only for the random numbers used for them, because the dimension with constants as unknowns agrees.
    """

    relations: tuple[Expr, ...]
    most: int
    counted: bool
    exact: bool = True


def cases_of(
    relations: Sequence[Expr], unknowns: Sequence[Expr], positive: frozenset[Expr]
) -> list[BoundedCase] | None:
    """Return the cases of some relations between ``unknowns``; None if there are too many, no case if no real point.

    Other symbols are generic constants, in which the relations have to be analytic: otherwise a coefficient that is not
    0 everywhere might be 0 on an interval. Linear combinations of relations are used unless they give too many cases.
    """
    if not all(is_analytic(g, g.symbols.difference(unknowns), positive) for g in relations):
        return None
    cases = _cases_of(relations, unknowns, positive, True)
    return _cases_of(relations, unknowns, positive, False) if cases is None else cases


def _cases_of(
    relations: Sequence[Expr], unknowns: Sequence[Expr], positive: frozenset[Expr], combining: bool
) -> list[BoundedCase] | None:
    """Return `cases_of`; ``combining``: whether to use linear combinations of relations."""
    moving = frozenset(unknowns)
    pending, bounded, number = [ZeroCase((), (), tuple(relations))], list[BoundedCase](), 0
    while pending:
        check()
        number += 1
        if number > MAX_CASES:
            return None
        case = pending.pop()
        subcases = _split(case, moving, positive)
        if subcases is None and combining:
            together = _combined(case.unsolved, moving, positive)
            subcases = None if together is None else [replace(case, unsolved=(), fresh=together)]
        if subcases is None:
            bounded += [b for b in [_bounded(case, unknowns, positive)] if b.most >= 0]
        else:
            pending += subcases
    return bounded


def _split(case: ZeroCase, moving: frozenset[Expr], positive: frozenset[Expr]) -> list[ZeroCase] | None:
    """Return the subcases into which a case is divided; None if it is not divided further."""
    if case.fresh:
        g, unsplit = case.fresh[0], case.fresh[1:]
        branches = zero_set(g, positive, moving)[0]
        kept = [b for b in branches if not any(_same_zeros(e, u, positive) for e in b for u in case.nonzero)]
        return [
            replace(case, unsolved=case.unsolved + tuple(e for e in b if not e.is_zero), fresh=unsplit) for b in kept
        ]
    choices = list(_linear(case.unsolved, moving))
    if not choices:
        return None
    _, g, s, slope = min(choices, key=lambda choice: choice[0])
    others = tuple(e for e in case.unsolved if e != g)
    at_zero = substitute(g, {s: ex.ZERO})
    value = {s: -at_zero / slope}
    used = tuple(e for e in others if s in e.symbols)
    free = tuple(e for e in others if s not in e.symbols)
    solved = ZeroCase((*case.solved, g), free, tuple(substitute(e, value) for e in used), case.nonzero)
    if moving.isdisjoint(slope.symbols):
        return [solved]
    factors = [b[0] for b in zero_set(slope, positive, moving)[0] if len(b) == 1]
    return [
        replace(solved, nonzero=(*case.nonzero, *factors)),
        replace(case, unsolved=others, fresh=(slope, at_zero)),
    ]


def _combined(relations: Sequence[Expr], moving: frozenset[Expr], positive: frozenset[Expr]) -> tuple[Expr, ...] | None:
    """Return an equivalent set of linear combinations, if a new one is linear or can be split; else None.

    ``moving``: the unknowns, as against parameters. x^2 + z^2 = a^2 and x^2 + (z - w)^2 = a^2 give w (w - 2 z) = 0; two
    circles give their radical line.
    """
    if len(relations) < 2:
        return None
    combinations = echelon_by_degree(relations, positive)
    if combinations is None:
        return None
    new = (g for g in combinations if not any(_same_zeros(g, e, positive) for e in relations))
    return combinations if any(linear(g) or zero_set(g, positive, moving)[0] != ((g,),) for g in new) else None


def _linear(relations: Sequence[Expr], moving: frozenset[Expr]) -> Iterator[tuple[tuple[int, int], Expr, Expr, Expr]]:
    """Yield (cost of substituting, relation, unknown, its coefficient) for relations of first degree in an unknown."""
    sizes = {g: ex.size(g) for g in relations}
    for g in relations:
        for s in sorted(moving & g.symbols, key=repr):
            slope = diff(g, s)
            if s in slope.symbols or is_identically_zero(slope) is not False:
                continue
            if sizes[g] + max((sizes[e] for e in relations if e != g and s in e.symbols), default=0) > MAX_NODES:
                continue
            yield (not moving.isdisjoint(slope.symbols), ex.size(slope)), g, s, slope


@false_without_value
def _same_zeros(e: Expr, other: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether two expressions are equal up to a numerical factor; False also if they are too large."""
    if e.symbols != other.symbols:
        return False
    _, [(first, _), (second, _)] = quotients_of([e, other], positive)
    return bool(first * second.leading_coefficient() == second * first.leading_coefficient())


def _bounded(case: ZeroCase, unknowns: Sequence[Expr], positive: frozenset[Expr]) -> BoundedCase:
    """Return a case with the bound on its dimension, -1 if it has no point.

    One unsolved relation removes one dimension, unless it may be 0 = 0; for several a Groebner basis is computed.
    """
    most = len(unknowns) - len(case.solved)
    if not case.unsolved:
        return BoundedCase(case.relations, most, True)
    ring = Ring(case.unsolved, positive)
    nodes = [ring.node(g) for g in case.unsolved]
    if not independent_generators(ring):
        return BoundedCase(case.relations, most, False)
    if len(case.unsolved) == 1:
        return BoundedCase(case.relations, most - 1, True)
    moving = [i for s in unknowns if (i := ring.var_index(s)) is not None]
    others = {s for g in case.unsolved for s in g.symbols}.difference(unknowns)
    constants = [ring.var_node.index(ring.node(s)) for s in sorted(others, key=repr)]
    canon = Canon(ring)
    generators = [canon.quotient(node)[0] for node in nodes]
    dimension = dimension_of(canon, generators, moving)
    if dimension is None:
        return BoundedCase(case.relations, most - 1, False)
    total = dimension_of(canon, generators, [*moving, *constants])
    randomised = any(not e.symbols for e in ring.var_expr)  # numbers such as cos(1) are random in both
    exact = not randomised and total is not None and max(-1, total - len(constants)) <= dimension
    return BoundedCase(case.relations, -1 if dimension < 0 else most - len(moving) + dimension, True, exact)
