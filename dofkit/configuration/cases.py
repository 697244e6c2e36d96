"""A set of zeros divided into cases: a product is 0 where a factor is, a x + b where x = -b/a or where a = b = 0.

On each case all relations but a few give one coordinate each. Elimination that divides by ``a`` sees the first kind
only; a part on which ``a`` is 0 may be larger.
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

#: Cases that are distinguished, in all; nodes of an expression past which no coordinate is put into it.
MAX_CASES, MAX_NODES = 48, 300


@dataclass(frozen=True)
class ZeroCase:
    """Where ``solved`` relations give one unknown each, ``unsolved`` vanish too, and none of ``nonzero`` does.

    ``fresh``: relations whose factors were not looked at.
    """

    solved: tuple[Expr, ...]
    unsolved: tuple[Expr, ...]
    fresh: tuple[Expr, ...]
    nonzero: tuple[Expr, ...] = ()

    @property
    def relations(self) -> tuple[Expr, ...]:
        """All that vanishes there."""
        return self.solved + self.unsolved + self.fresh


@dataclass(frozen=True)
class BoundedCase:
    """The relations of a case and a bound of the dimension of its points; ``counted``: the complex ones have it.

    ``exact``: with constants as further unknowns the set has no more dimensions than these, so they are not due to the
    random numbers that constants are given.
    """

    relations: tuple[Expr, ...]
    most: int
    counted: bool
    exact: bool = True


def cases_of(
    relations: Sequence[Expr], unknowns: Sequence[Expr], positive: frozenset[Expr]
) -> list[BoundedCase] | None:
    """Return the cases of some relations between ``unknowns``; None where there are too many of them.

    Other symbols are generic constants, in which the relations have to be analytic: else what is not 0 everywhere may
    be 0 through an interval. No case: there is no real point. Where combinations lead to too many cases, those of the
    relations as they are.
    """
    if not all(is_analytic(g, g.symbols.difference(unknowns), positive) for g in relations):
        return None
    cases = _cases_of(relations, unknowns, positive, True)
    return _cases_of(relations, unknowns, positive, False) if cases is None else cases


def _cases_of(
    relations: Sequence[Expr], unknowns: Sequence[Expr], positive: frozenset[Expr], combining: bool
) -> list[BoundedCase] | None:
    moving = frozenset(unknowns)
    open_, bounded, seen = [ZeroCase((), (), tuple(relations))], list[BoundedCase](), 0
    while open_:
        check()
        seen += 1
        if seen > MAX_CASES:
            return None
        case = open_.pop()
        subcases = _split(case, moving, positive)
        if subcases is None and combining:
            together = _combined(case.unsolved, moving, positive)
            subcases = None if together is None else [replace(case, unsolved=(), fresh=together)]
        if subcases is None:
            bounded += [b for b in [_bounded(case, unknowns, positive)] if b.most >= 0]
        else:
            open_ += subcases
    return bounded


def _split(case: ZeroCase, moving: frozenset[Expr], positive: frozenset[Expr]) -> list[ZeroCase] | None:
    """Return the cases within one; None where it is divided no further."""
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
    """Combinations with numbers that say the same, where one of them is linear or falls into factors; else None.

    x^2 + z^2 = a^2 and x^2 + (z - w)^2 = a^2 give w (w - 2 z) = 0; two circles meet on a line.
    """
    if len(relations) < 2:
        return None
    combinations = echelon_by_degree(relations, positive)
    if combinations is None:
        return None
    new = (g for g in combinations if not any(_same_zeros(g, e, positive) for e in relations))
    return combinations if any(linear(g) or zero_set(g, positive, moving)[0] != ((g,),) for g in new) else None


def _linear(relations: Sequence[Expr], moving: frozenset[Expr]) -> Iterator[tuple[tuple[int, int], Expr, Expr, Expr]]:
    """(how large, relation, unknown, its coefficient) where a relation has the first degree in an unknown."""
    sizes = {g: sum(1 for _ in ex.nodes(g)) for g in relations}
    for g in relations:
        for s in sorted(moving & g.symbols, key=repr):
            slope = diff(g, s)
            if s in slope.symbols or is_identically_zero(slope) is not False:
                continue
            if sizes[g] + max((sizes[e] for e in relations if e != g and s in e.symbols), default=0) > MAX_NODES:
                continue
            yield (not moving.isdisjoint(slope.symbols), sum(1 for _ in ex.nodes(slope))), g, s, slope


@false_without_value
def _same_zeros(e: Expr, other: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether two expressions are the same up to a number."""
    if e.symbols != other.symbols:
        return False
    _, [(first, _), (second, _)] = quotients_of([e, other], positive)
    return bool(first * second.leading_coefficient() == second * first.leading_coefficient())


def _bounded(case: ZeroCase, unknowns: Sequence[Expr], positive: frozenset[Expr]) -> BoundedCase:
    """Return a case that is divided no further, with the bound of its dimension: -1 where it has no point.

    One relation takes one dimension away, unless it holds everywhere; several take that of a Groebner basis.
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
    whole = dimension_of(canon, generators, moving)
    if whole is None:
        return BoundedCase(case.relations, most - 1, False)
    total = dimension_of(canon, generators, [*moving, *constants])
    drawn = any(not e.symbols for e in ring.var_expr)  # numbers such as cos(1) are drawn in both
    exact = not drawn and total is not None and max(-1, total - len(constants)) <= whole
    return BoundedCase(case.relations, -1 if whole < 0 else most - len(moving) + whole, True, exact)
