"""Branches of the configuration space that have different dimensions, each named by an equation.

The largest dimension is the answer of the report. Where an expression h vanishes on every component of that dimension,
the set {h != 0} holds the others: it is the system with one coordinate u and the equation u h = 1 added, and it is
answered by the same methods [Rabinowitsch1929].
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations

from dofkit.base.deadline import expired
from dofkit.base.verdicts import Verdict, weakest
from dofkit.base.wording import many, verb
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.special.common_zeros import Leaf, Reals, common_zeros, in_order, order_of, where
from dofkit.classification.special.loci import meeting
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.terms import number_and_rest
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.pieces import Finite, Normal, Reduced
from dofkit.relations.setting import Setting
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


#: Branches of one constraint that are compared with each other.
MAX_BRANCHES = 4


def meetings(system: System, reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> Iterator[SpecialCase]:
    """Configurations that lie on two branches of one finite constraint. Raises TooLargeError."""
    if setting.reference is not None or outcome.consistent is not True:
        return
    nonzero = frozenset(ex.parameter(p) for p, sign in system.parameters.items() if sign == "nonzero")
    order = order_of(system)
    for i, r in enumerate(reduced):
        pairs = [pair for normal in r.normals for pair in _pairs(normal)]
        if not pairs:
            continue
        canon, reals = _reals([g for pair in pairs for g in pair], setting, nonzero)
        others = _others(i, outcome)
        zeros = [common_zeros(reals, [canon.quotient(canon.ring.node(g))[0] for g in pair]) for pair in pairs]
        sure: list[tuple[Leaf, Verdict]] = []
        for leaf in (leaf for leaves in zeros for leaf in leaves):
            conditions = leaf.conditions(canon)
            if not conditions or any(reals.of_parameters(c) for c in conditions) or leaf in [a for a, _ in sure]:
                continue
            shown = [canon.to_expr(c) for c in conditions]
            names = [c.name for c in system.coordinates if _mentioned(c.name, [*shown, *others])]
            verdict = meeting(names, setting, [*shown, *others])
            if verdict is not None:
                sure.append((leaf, verdict))
        largest = reals.largest([leaf for leaf, _ in sure])
        for leaf, verdict in [(a, v) for a, v in sure if a in largest]:
            yield SpecialCase(
                where=where(canon, leaf, order),
                kind="locus",
                what=f"two branches of {r.constraint.name} meet there",
                constraints=[r.constraint.name],
                verdict=verdict,
            )


def _pairs(normal: Normal) -> Iterator[list[Expr]]:
    """What vanishes where two branches meet, for every two of few finite ones."""
    if not 2 <= len(normal.branches) <= MAX_BRANCHES:
        return
    if any(not isinstance(p, Finite) for p in normal.pieces):
        return
    branches = [[p.expr for p in branch if isinstance(p, Finite)] for branch in normal.branches]
    for one, other in combinations(branches, 2):
        if not set(one) <= set(other) and not set(other) <= set(one):
            yield [*one, *other]


def _reals(expressions: Sequence[Expr], setting: Setting, nonzero: frozenset[Expr]) -> tuple[Canon, Reals]:
    ring = Ring(expressions, setting.positive)
    for e in expressions:
        ring.node(e)
    canon = Canon(ring)
    return canon, Reals(canon, setting.positive, nonzero)


def _others(constraint: int, outcome: Outcome) -> list[Expr]:
    """The finite relations of all other constraints."""
    finite = [r for b in outcome.blocks for r in b.finite if r.constraint != constraint]
    return [r.piece.expr for r in finite if isinstance(r.piece, Finite)]


def _mentioned(name: str, expressions: Sequence[Expr]) -> bool:
    return any(ex.coordinate(name) in e.symbols for e in expressions)
