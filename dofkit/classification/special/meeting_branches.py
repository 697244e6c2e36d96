"""Where branches of a constraint that is a product meet."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.special.common_zeros import Reals, common_zeros
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
    seen: set[tuple[str, str]] = set()
    for i, r in enumerate(reduced):
        for pair in (pair for normal in r.normals for pair in _pairs(normal)):
            canon, reals = _reals(pair, setting, nonzero)
            polys = [canon.quotient(canon.ring.node(g))[0] for g in pair]
            for leaf in common_zeros(reals, polys):
                conditions = leaf.conditions(canon)
                at = where(canon, leaf, order)
                if not conditions or any(reals.of_parameters(c) for c in conditions) or (at, r.constraint.name) in seen:
                    continue
                seen.add((at, r.constraint.name))
                others = _others(i, outcome)
                shown = [canon.to_expr(c) for c in conditions]
                names = [c.name for c in system.coordinates if _mentioned(c.name, [*shown, *others])]
                sure = meeting(names, setting, [*shown, *others])
                if sure is not None:
                    what = f"two branches of {r.constraint.name} meet there"
                    yield SpecialCase(where=at, kind="locus", what=what, constraints=[r.constraint.name], verdict=sure)


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
