"""Where branches of a constraint that is a product meet."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from dofkit.base.verdicts import Verdict
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.special.common_zeros import Leaf, Reals, common_zeros
from dofkit.classification.special.loci import meeting
from dofkit.classification.special.wording import order_of, where
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.pieces import Finite, Normal
from dofkit.relations.reduced import Reduced
from dofkit.relations.setting import Setting
from dofkit.report import SpecialCase
from dofkit.system import System

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
