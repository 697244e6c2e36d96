"""Compares the regions that relations describe together with other constraints.

Two regions are equal if neither contains a point outside the other. Each difference is a system of inequalities, which
is proved to be empty or has a certified point.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

from dofkit.classification.feasibility.feasibility import judged
from dofkit.classification.freedom.branches import solve
from dofkit.classification.study import Study
from dofkit.exact.ring.canonical import lowest_terms, quotients_of
from dofkit.exact.ring.program import none_without_value
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, in_velocities, replace_nodes, substitute
from dofkit.expressions.tree import ZERO, Expr
from dofkit.relations.normal.domain import DomainCondition, is_always_satisfied
from dofkit.relations.normal.pieces import Inequality, Reduced
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.setting import Setting
from dofkit.system import Constraint, Relation, Sense, System, TypeFacts

#: The most systems of inequalities for one difference.
MOST_CASES = 24
_ROOT = ex.parameter("a root")
_OPPOSITE: dict[Sense, Sense] = {">": ">=", ">=": ">"}


class Difference(NamedTuple):
    """Whether a region has points outside another (None: undecided), and inequalities that such points satisfy."""

    exists: bool | None
    system: tuple[Relation, ...] = ()


@dataclass(frozen=True)
class Regions:
    """The regions of relations between the coordinates of a system, where the constraints ``context`` are satisfied."""

    system: System
    context: Sequence[Reduced]
    setting: Setting

    def difference(self, region: Sequence[Relation], other: Sequence[Relation]) -> Difference:
        """Return whether the context allows points of ``region`` outside ``other``."""
        positive = self.setting.positive
        failing = [case for relation in other for case in _failing(relation, positive)]
        systems = [(*case, *outside) for case in _cases_of_all(region) for outside in failing]
        decided = len(systems) <= MOST_CASES
        for relations in systems[:MOST_CASES]:
            reduced = [*self.context, *(_reduced(r, positive) for r in relations)]
            outcome = solve(reduced, self.setting)
            if outcome.consistent is False:
                continue
            feasible = judged(Study(self.system, reduced, self.setting, outcome)).feasible
            if feasible:
                return Difference(True, relations)
            decided = decided and feasible is False
        return Difference(False if decided else None)


def _reduced(relation: Relation, positive: frozenset[Expr]) -> Reduced:
    """Return an inequality as a constraint, multiplied by its denominator if that is positive."""
    e = _numerator(relation.expr, positive) or relation.expr
    added = Constraint("region", "region", TypeFacts(written=True), "", (relation,))
    return Reduced(added, (), (Inequality(e, relation.sense == ">"),))


@none_without_value
def _numerator(e: Expr, positive: frozenset[Expr]) -> Expr | None:
    """Return the numerator of ``e``, in lowest terms, if the denominator is certainly positive, else None."""
    canon, [quotient] = quotients_of([e], positive)
    top, bottom = map(canon.to_expr, lowest_terms(*quotient))
    return top if bottom.symbols and never_holds(-bottom, False, positive) else None


def _cases_of_all(region: Sequence[Relation]) -> Iterator[list[Relation]]:
    """Yield systems without absolute values and square roots that are together equivalent to all relations."""
    for chosen in product(*(_cases(side) for relation in region for side in _sides(relation))):
        yield [relation for case in chosen for relation in case]


def _sides(relation: Relation) -> list[Relation]:
    """Return a relation in velocities, an equation as two inequalities."""
    e = in_velocities(relation.expr)[0]
    if relation.sense != "=":
        return [relation._replace(expr=e)]
    return [relation._replace(expr=e, sense=">="), relation._replace(expr=-e, sense=">=")]


def _failing(relation: Relation, positive: frozenset[Expr]) -> list[list[Relation]]:
    """Return systems of which one is satisfied where the relation is false or undefined, and none elsewhere."""
    result = []
    for written, sense in relation.domain:
        e = in_velocities(written)[0]
        if not is_always_satisfied(DomainCondition(e, sense), positive):
            zero = [Relation(e, ">="), Relation(-e, ">=")]
            result += [zero] if sense == "!=" else _cases(Relation(-e, _OPPOSITE[sense]))
    return [*result, *(c for r in _sides(relation) for c in _cases(r._replace(expr=-r.expr, sense=_OPPOSITE[r.sense])))]


def _cases(relation: Relation) -> list[list[Relation]]:
    """Return systems without absolute values and square roots that are together equivalent to an inequality."""
    e = relation.expr
    for node in ex.nodes(e):
        if node.op == "fn" and node.args[0] == "abs":
            inside = node.args[1]
            sides = ((inside, Relation(inside, ">=")), (-inside, Relation(-inside, ">")))
            return [
                [side, *case]
                for value, side in sides
                for case in _cases(relation._replace(expr=replace_nodes(e, {node: value})))
            ]
    for root in _roots(e):
        named = replace_nodes(e, {root: _ROOT})
        slope, remainder = diff(named, _ROOT), substitute(named, {_ROOT: ZERO})
        if slope.op != "num" or any(_roots(remainder)):
            break
        square, domain = root.args[0] * slope * slope, Relation(root.args[0], ">=")
        if slope.args[0] < 0:
            below = relation._replace(expr=remainder * remainder - square)
            return [[domain, Relation(remainder, ">="), below]]
        above = relation._replace(expr=square - remainder * remainder)
        return [[domain, relation._replace(expr=remainder)], [domain, Relation(-remainder, ">="), above]]
    return [[relation]]


def _roots(e: Expr) -> list[Expr]:
    return [n for n in ex.nodes(e) if n.op == "pow" and n.args[1] == ex.HALF]
