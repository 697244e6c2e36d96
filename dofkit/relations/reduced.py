"""A constraint with every relation reduced to what it says over the reals."""

from __future__ import annotations

from typing import NamedTuple

from dofkit.relations.normal.pieces import Inequality, Normal
from dofkit.system import Constraint


class Reduced(NamedTuple):
    """A constraint with every relation reduced; ``inequalities`` apart."""

    constraint: Constraint
    normals: tuple[Normal, ...]
    inequalities: tuple[Inequality, ...]

    @property
    def equations(self) -> int:
        return len(self.normals)

    @property
    def constants(self) -> tuple[str, ...]:
        """What stands for constants of an integration by time."""
        return tuple([c for normal in self.normals for c in normal.constants])
