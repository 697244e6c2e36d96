"""A block as the engines see it: its program, its finite relations, its columns."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.reductions import ALL, ReductionName, Reductions
from dofkit.system import Coordinate


@dataclass(frozen=True)
class Chart:
    """A block's ring, its finite relations and its columns: coordinates, then time where it occurs.

    ``columns`` are generator indices (-1: the symbol occurs nowhere); ``unknowns`` are the symbols that a
    real search moves: coordinates and generic geometry. ``relations`` are what the nodes compute; ``engines`` those
    that may look at it; ``size`` is the scale of lengths; ``reductions``: those in
    use, and ``kinds`` which of them may use each relation. ``within``: they hang by joints on other bodies.
    """

    ring: Ring
    nodes: tuple[int, ...]
    symbols: tuple[Expr, ...]
    columns: tuple[int, ...]
    unknowns: tuple[Expr, ...]
    positive: frozenset[Expr]
    roles: tuple[Coordinate, ...] = ()
    relations: tuple[Expr, ...] = ()
    engines: Engines = BOTH
    size: float = 1.0
    reductions: Reductions = ALL
    kinds: tuple[ReductionName, ...] = ()
    within: bool = False

    @property
    def coordinates(self) -> int:
        """The number of columns that are coordinates."""
        return sum(s.args[0] == "coordinate" for s in self.symbols)

    @property
    def time(self) -> int | None:
        """The number of the column that is time."""
        return self.symbols.index(ex.TIME) if ex.TIME in self.symbols else None

    @property
    def scales(self) -> list[float]:
        """The size by which each column is measured: places by the scale of lengths."""
        places = {c.name for c in self.roles if c.role in ("x", "y", "z")}
        return [self.size if s.args[-1] in places else 1.0 for s in self.symbols]


Displacement = dict[int, list[tuple[int, int | None]]]


def displacement_fields(chart: Chart) -> list[Displacement]:
    """Translations and rotations: for a column, the sum of factor * (the value of another column, or 1).

    Only where every coordinate of the block is a place or the angle of a planar body.
    """
    place = {str(s.args[1]): i for i, s in enumerate(chart.symbols) if s != ex.TIME}
    here = [c for c in chart.roles if c.name in place]
    if len(here) != len(place) or any(c.role not in ("x", "y", "z", "angle") for c in here):
        return []
    by_owner: dict[str, dict[str, int]] = {}
    for c in here:
        by_owner.setdefault(str(c.owner), {})[c.role] = place[c.name]
    axes = sorted({r for roles_of in by_owner.values() for r in roles_of if r != "angle"})
    found: list[Displacement] = [{o[a]: [(1, None)] for o in by_owner.values() if a in o} for a in axes]
    for a, b in combinations(axes, 2):
        turn: Displacement = {}
        for o in by_owner.values():
            if a in o and b in o:
                turn[o[a]] = [(-1, o[b])]
                turn[o[b]] = [(1, o[a])]
            if "angle" in o:
                turn[o["angle"]] = [(1, None)]
        found.append(turn)
    return found
