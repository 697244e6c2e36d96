"""Branches of the configuration space that have different dimensions, each named by an equation.

The largest dimension is the answer of the report. Where an expression h vanishes on every component of that dimension,
the set {h != 0} holds the others: it is the system with one coordinate u and the equation u h = 1 added, and it is
answered by the same methods [Rabinowitsch1929].
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from dofkit.base.deadline import expired
from dofkit.base.verdicts import weakest
from dofkit.base.wording import many, verb
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.special.wording import in_order, order_of
from dofkit.expressions import tree as ex
from dofkit.expressions.terms import number_and_rest
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.reduced import Reduced
from dofkit.report import Report, SpecialCase
from dofkit.system import Constraint, Coordinate, Relation, System, TypeFacts

#: Expressions for which the rest of the configuration space is looked at.
MAX_EXPRESSIONS = 4
_RECIPROCAL = "_reciprocal"

Again = Callable[[System], Report]


def branch_dimensions(
    system: System, reduced: Sequence[Reduced], outcome: Outcome, report: Report, again: Again
) -> Iterator[SpecialCase]:
    """Yield the branch to which the degrees of freedom belong, where the rest of the configuration space has fewer."""
    claim = report.verdicts.get("dof")
    if system.reference is not None or not report.dof or claim is None or claim.about == "component":
        return
    for h in list(dict.fromkeys(_separating(reduced, outcome)))[:MAX_EXPRESSIONS]:
        rest = None if expired() else again(where_nonzero(system, h))
        elsewhere = None if rest is None else rest.verdicts.get("dof")
        if rest is None or rest.dof is None or elsewhere is None or elsewhere.about == "component":
            continue
        sure = weakest(claim.verdict, elsewhere.verdict)
        if rest.consistent and rest.dof < report.dof and sure != "undecided":
            shown = to_text(in_order(h, order_of(system)))
            concerned = (c for c in system.constraints if any(h.symbols & r.expr.symbols for r in c.relations))
            yield SpecialCase(
                where=f"{shown} = 0",
                kind="branch",
                what=f"only this branch has {many(report.dof, 'degree')} of freedom; "
                f"where {shown} is not 0 there {verb(rest.dof)} {rest.dof}",
                constraints=[c.name for c in concerned],
                verdict=sure,
            )
            return


def where_nonzero(system: System, h: Expr) -> System:
    """Return the system on the set where an expression does not vanish: u h = 1 holds there for one u."""
    reciprocal = Relation(ex.coordinate(_RECIPROCAL) * h - ex.ONE)
    facts = TypeFacts(written=True)
    condition = Constraint(_RECIPROCAL, _RECIPROCAL, facts, f"{to_text(h)} != 0", (reciprocal,))
    return replace(
        system,
        coordinates=(*system.coordinates, Coordinate(_RECIPROCAL)),
        constraints=(*system.constraints, condition),
    )


def _separating(reduced: Sequence[Reduced], outcome: Outcome) -> Iterator[Expr]:
    """Yield expressions that vanish on the branch that was answered, and may not do so on others."""
    products = [n for r in reduced for n in r.normals if len(n.branches) > 1]
    factors = {p.expr for n in products for branch in n.branches for p in branch if isinstance(p, Finite)}
    found = [r.piece.expr for r in outcome.rows if isinstance(r.piece, Finite) and r.piece.expr in factors]
    for h in [*found, *(h for a in outcome.answers for h in a.separating)]:
        yield number_and_rest(h)[1]
