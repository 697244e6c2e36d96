"""How many equations are independent of all before them where relations are dependent at the drawing only.

An equation is independent of others where it is no combination of them, with coefficients that are analytic near the
drawing. One after another they are held against those before. A row that is no sum of rows before it at the drawing is
of an independent equation. One that is such a sum is of a dependent equation where that vanishes on the manifold of the
independent ones before it [ImplicitFunctions]; the first that does not is independent, and so is a later one that takes
freedom away; of another nothing is known. What was counted must be what the freedom says.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from dofkit.base.components import components
from dofkit.base.deadline import check
from dofkit.classification.dependence.implications import NearDrawing
from dofkit.classification.dependence.sufficient_sets import SufficientSets
from dofkit.classification.freedom.block import answer
from dofkit.exact.matrices.sparse import echelon
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, split
from dofkit.relations.setting import Setting


class Freedoms(NamedTuple):
    """Of some rows on some coordinates, with the hidden relations they force."""

    dof: int
    velocity_dof: int
    hidden: set[Expr]


def freedoms(coordinates: Sequence[str], rows: Sequence[Row], setting: Setting) -> Freedoms | None:
    """The freedom that some rows leave; None where it is not known."""
    blocks, untouched = split(coordinates, rows)
    dof = velocity = len(untouched)
    hidden: set[Expr] = set()
    for block in blocks:
        found = answer(block, setting)
        if found.dof is None or found.velocity_dof is None:
            return None
        dof, velocity, hidden = dof + found.dof, velocity + found.velocity_dof, hidden | {*found.hidden}
    return Freedoms(dof, velocity, hidden)


class EquationCount(NamedTuple):
    """Equations of each constraint that are independent of all before, those that are not, and groups."""

    independent: dict[int, int]
    equations: dict[int, tuple[int, ...]]
    groups: list[tuple[int, list[int]]]


def counted(block: Block, setting: Setting, a: Answer, numbered: Sequence[int]) -> EquationCount | None:
    """The count for a block that was answered at the drawing; ``numbered``: the equation that each row is of.

    None where it was not decided, or is not what the freedom says.
    """
    if a.dof is None or len(a.matrix) != len(block.rows):
        return None
    supports = _Counting(block, setting, a).supports()
    if supports is None or len(supports) != max(0, len(block.rows) - (len(block.coordinates) - a.dof)):
        return None
    owners = [r.constraint for r in block.rows]
    following = Counter(owners[i] for i in supports)
    circuits = [{owners[i], *(owners[j] for j in support)} for i, support in supports.items()]
    joined = [{o for k in numbers for o in circuits[k]} for numbers in components(circuits)]
    groups = [(sum(following[o] for o in c), sorted(c)) for c in joined]
    equations = {o: tuple(numbered[i] for i in supports if owners[i] == o) for o in owners}
    independent = {o: k - following[o] for o, k in Counter(owners).items()}
    return EquationCount(independent, equations, sorted(groups, key=lambda g: g[1]))


@dataclass(frozen=True)
class _Counting:
    block: Block
    setting: Setting
    a: Answer

    def supports(self) -> dict[int, list[int]] | None:
        """For every row that follows from those before it rows from which it does; None where that is open."""
        near = NearDrawing(self.block, self.setting)
        dependent = echelon(self.a.matrix, self.a.modulus, supports=True).supports
        owners = [r.constraint for r in self.block.rows]
        following: dict[int, list[int]] = {}
        bent = False
        for i in dependent:
            check()
            pivots = [k for k in range(i) if k not in dependent]
            found = SufficientSets(near, owners, pivots).enough(i, dependent[i])
            if found is not None:
                following[i] = found
                continue
            if near.follows(i, pivots) is None or (bent and not self._takes_freedom(i, following)):
                return None
            bent = True
        return following

    def _takes_freedom(self, row: int, following: dict[int, list[int]]) -> bool:
        """Do the rows before this one, but for those that follow, leave less freedom with it than without it?"""
        rows = [self.block.rows[k] for k in range(row + 1) if k not in following]
        before, after = (freedoms(self.block.coordinates, some, self.setting) for some in (rows[:-1], rows))
        return before is not None and after is not None and after.dof < before.dof
