"""A constraint with every relation reduced to what it says over the reals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from dofkit.expressions.renaming import Unwritten
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.pieces import Inequality, Normal
from dofkit.system import Constraint, Relation

#: The kinds of symbols that a configuration gives values.
FINITE = frozenset({"coordinate", "parameter", "time"})


class Reduced(NamedTuple):
    """A constraint with every relation reduced; ``inequalities`` apart. ``written``: the relation of each normal."""

    constraint: Constraint
    normals: tuple[Normal, ...]
    inequalities: tuple[Inequality, ...]
    written: Sequence[Relation] = ()

    @property
    def equations(self) -> int:
        return len(self.normals)

    @property
    def constants(self) -> tuple[str, ...]:
        """What stands for constants of an integration by time."""
        return tuple([c for normal in self.normals for c in normal.constants])

    @property
    def domain(self) -> tuple[DomainCondition, ...]:
        """Where its equations, as they were written, have a value; velocities have one wherever there is a motion."""
        relations = self.constraint.relations
        if isinstance(relations, Unwritten) or not (self.normals or self.inequalities):
            return ()
        written = (DomainCondition(*required) for r in relations if r.sense == "=" for required in r.domain)
        return tuple(dict.fromkeys(c for c in written if {s.args[0] for s in c.expr.symbols} <= FINITE))
