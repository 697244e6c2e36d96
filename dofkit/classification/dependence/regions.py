"""Relations that say only where they hold, on a whole region (x = abs(x)): they take no freedom away.

One of them can be left out where the others hold within its region only. They do where the others and the condition's
contrary, u < 0, that is u s^2 = -1 for some s, are proved to have no solution; they do not where a certified real point
satisfies both.
"""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.base.deadline import check
from dofkit.classification.dependence.circuits import Redundancies
from dofkit.classification.dependence.implication import SLACK
from dofkit.classification.freedom.reference_branches import all_of
from dofkit.configuration.states import States, value_at
from dofkit.exact.ring.program import Scalar
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Row, coordinates_of
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.no_solution import no_solution
from dofkit.relations.normal.pieces import Finite, Normal, Piece
from dofkit.relations.reduced import Reduced
from dofkit.relations.setting import Setting

#: Real points that are looked at outside of a region.
POINTS = 2


def is_region(r: Reduced) -> bool:
    """Return whether all equations of a constraint only state where they are satisfied."""
    return bool(r.normals) and all(map(is_conditional, r.normals))


def is_conditional(n: Normal) -> bool:
    """Return whether an equation only states where it is satisfied, on all its branches."""
    return bool(n.branches) and all(b and all(isinstance(p, DomainCondition) for p in b) for b in n.branches)


def of_regions(
    reduced: Sequence[Reduced], setting: Setting, regions: Sequence[int], kept: Sequence[int]
) -> list[Redundancies]:
    """Which of some regions can be left out beside the constraints that are kept, the last written first."""
    left, found = list(regions), []
    for i in reversed(regions):
        others = [*kept, *(j for j in left if j != i)]
        told = _holds(reduced, setting, i, others)
        equations = reduced[i].equations
        if told is None:
            found.append(Redundancies({i: 0}, [], [(equations, [i])], {}, (i,)))
        elif not told:
            found.append(Redundancies({i: 0}, [], [(equations, [i])], {}))
        else:
            left.remove(i)
            needed = list(others)
            for j in sorted(others, reverse=True):
                fewer = [k for k in needed if k != j]
                needed = fewer if _holds(reduced, setting, i, fewer) else needed
            group = (equations, sorted((i, *needed)))
            every = tuple(range(equations))
            found.append(Redundancies({i: 0}, [i], [group], {i: sorted(needed)}, equations={i: every}))
    return found


def _holds(reduced: Sequence[Reduced], setting: Setting, i: int, others: Sequence[int]) -> bool | None:
    """Do others hold within the region of constraint i only? None where that was not decided."""
    given = [n for j in others for n in reduced[j].normals]
    if any(len(n.branches) != 1 for n in (*given, *reduced[i].normals)):
        return None
    pieces = [p for n in given for p in n.branches[0]]
    conditions = [p for n in reduced[i].normals for p in n.branches[0] if isinstance(p, DomainCondition)]
    return all_of(_within(c, pieces, setting) for c in conditions)


def _within(condition: DomainCondition, given: Sequence[Piece], setting: Setting) -> bool | None:
    """Does a condition hold wherever some pieces do?"""
    check()
    if condition in given:
        return True
    finite = [p.expr for p in given if isinstance(p, Finite)]
    known = [p.expr for p in given if isinstance(p, DomainCondition) and p.sense != "!="]
    outside = _contrary(condition)
    if no_solution([*finite, outside], setting.positive, known):
        return True
    only_finite = all(isinstance(p, Finite | DomainCondition) for p in given)
    return False if only_finite and _reached(finite, outside, given, setting) else None


def _contrary(condition: DomainCondition) -> Expr:
    """What has a solution s where the condition does not hold."""
    u, s = condition.expr, ex.coordinate(SLACK)
    if condition.sense == "!=":
        return u
    return ex.mul(u, s, s) + ex.ONE if condition.sense == ">=" else u + ex.mul(s, s)


def _reached(finite: Sequence[Expr], outside: Expr, given: Sequence[Piece], setting: Setting) -> bool:
    """Is there a certified real point where the relations hold, what is given, and the contrary of a condition?"""
    rows = [Row(k, Finite(e)) for k, e in enumerate((*finite, outside))]
    names = sorted(frozenset[str]().union(*(coordinates_of(p) for p in (*(r.piece for r in rows), *given))))
    conditions = [p for p in given if isinstance(p, DomainCondition)]
    try:
        states = States(names, rows, (), setting, [c.expr for c in conditions], True)
        for point in states.certain(POINTS):
            if all(_surely(c, value_at(states.ring, point, states.extra[c.expr])) for c in conditions):
                return True
    except ArithmeticError:
        return False
    return False


def _surely(condition: DomainCondition, value: Scalar | None) -> bool:
    """Does a ball show that a condition holds?"""
    return value is not None and not value.contains(0) and (condition.sense == "!=" or bool(value > 0))
