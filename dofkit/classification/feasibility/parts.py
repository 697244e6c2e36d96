"""Constraints that have to be looked at together with an inequality, and what they say on each choice of branches."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product as cartesian
from math import prod

from dofkit.base.components import components
from dofkit.classification.feasibility.refutation import SignClaim
from dofkit.expressions.calculus import accelerations_of
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Row, coordinates_of
from dofkit.relations.integration_constants import with_rows
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Finite, Inequality, Nonlinear, Pfaffian, Still
from dofkit.relations.reduced import Reduced
from dofkit.relations.velocity_reductions import form_rate, rate

#: Choices of branches that are looked at.
MAX_CHOICES = 16


@dataclass(frozen=True)
class Choice:
    """One branch of every relation: its rows, and the conditions, inequalities among them."""

    rows: tuple[Row, ...]
    conditions: tuple[DomainCondition, ...]

    @property
    def names(self) -> list[str]:
        """The coordinates that occur."""
        found = [*(coordinates_of(r.piece) for r in self.rows), *map(coordinates_of, self.conditions)]
        return sorted(frozenset[str]().union(*found))

    def claims(self) -> list[SignClaim]:
        """What holds at every state of motion; what is only != 0 is left out."""
        finite = [r.piece.expr for r in self.rows if isinstance(r.piece, Finite)]
        forms = [form_rate(r.piece) for r in self.rows if isinstance(r.piece, Pfaffian)]
        curved = [r.piece.expr for r in self.rows if isinstance(r.piece, Nonlinear)]
        held = [SignClaim(c.expr, ">" if c.sense == ">" else ">=") for c in self.conditions if c.sense != "!="]
        if forms or curved or any(velocities_of(c.expr) for c in held):
            finite += [*map(rate, finite), *forms, *curved]
        return [*(SignClaim(e, "=") for e in finite), *held]


@dataclass(frozen=True)
class Part:
    """Constraints by their ``numbers`` that share coordinates, one after another, an inequality among them."""

    numbers: tuple[int, ...]
    reduced: tuple[Reduced, ...]

    @property
    def inequalities(self) -> list[Inequality]:
        """All of them."""
        return [q for r in self.reduced for q in r.inequalities]

    @property
    def readable(self) -> bool:
        """Are the inequalities about configurations and velocities, and not about differentials or accelerations?"""
        kinds = {s.args[0] for q in self.inequalities for s in q.expr.symbols}
        return kinds.isdisjoint({"differential", "dt"}) and not any(accelerations_of(q.expr) for q in self.inequalities)

    def choices(self) -> Iterator[Choice] | None:
        """Every choice of branches; None where they are too many."""
        normals = [(i, n) for i, r in zip(self.numbers, self.reduced, strict=True) for n in r.normals]
        if prod(len(n.branches) for _, n in normals) > MAX_CHOICES:
            return None
        constants = {c: Row(i, Still(c)) for i, r in zip(self.numbers, self.reduced, strict=True) for c in r.constants}
        own = tuple(DomainCondition(q.expr, ">" if q.strict else ">=") for q in self.inequalities)
        return (
            _choice([(i, branch) for (i, _), branch in zip(normals, chosen, strict=True)], own, constants)
            for chosen in cartesian(*(n.branches for _, n in normals))
        )

    def written(self) -> list[SignClaim]:
        """The finite relations and the inequalities as they were written, all branches in one."""
        relations = [q for r in self.reduced for q in r.constraint.relations if q.sense == "=" and _finite(q.expr)]
        own = [SignClaim(q.expr, ">" if q.strict else ">=") for q in self.inequalities]
        return [*(SignClaim(q.expr, "=") for q in relations), *own]


def _finite(e: Expr) -> bool:
    return all(s.args[0] in ("coordinate", "parameter", "time") for s in e.symbols)


def _choice(
    branches: Sequence[tuple[int, Sequence[object]]], own: tuple[DomainCondition, ...], constants: dict[str, Row]
) -> Choice:
    rows = [Row(i, p) for i, branch in branches for p in branch if isinstance(p, Finite | Pfaffian | Nonlinear)]
    conditions = [p for _, branch in branches for p in branch if isinstance(p, DomainCondition)]
    return Choice(tuple(with_rows(rows, constants)), tuple(dict.fromkeys((*conditions, *own))))


def parts_of(reduced: Sequence[Reduced], numbers: Sequence[int], shared: bool) -> list[Part]:
    """The parts with an inequality; ``shared``: what shares time or a parameter belongs together as well."""
    together = components(_mentioned(reduced[i], shared) for i in numbers)
    groups = [sorted(numbers[k] for k in group) for group in together]
    parts = [Part(tuple(g), tuple(reduced[i] for i in g)) for g in groups]
    return sorted((p for p in parts if p.inequalities), key=lambda p: p.numbers)


def _mentioned(r: Reduced, shared: bool) -> frozenset[str]:
    pieces = [*(p for n in r.normals for branch in n.branches for p in branch), *r.inequalities]
    names = frozenset[str]().union(*map(coordinates_of, pieces))
    constants = (s for q in r.constraint.relations for s in q.expr.symbols if s.args[0] in ("parameter", "time"))
    return names | frozenset(repr(s) for s in constants) if shared else names
