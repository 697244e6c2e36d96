"""How many equations are independent of all before them where relations are dependent at the drawing only.

An equation is independent of others where it is no combination of them, with coefficients that are analytic near the
drawing. One after another they are held against those before. A row that is no sum of rows before it at the drawing is
of an independent equation. One that is such a sum is of a dependent equation where that vanishes on the manifold of the
independent ones before it [ImplicitFunctions]; the first that does not is independent, and so is a later one that takes
freedom away. Of several of one constraint all but one are dependent where they hold, in numbers, at the points near the
drawing where that one does: creases that meet in a point close up by one condition of the second order, told by several
equations. What was counted must be what the freedom says.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
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
    """Equations of each constraint that are independent of all before, those that are not, and groups.

    ``seen``: the constraints of whose equations some were seen in numbers to follow.
    """

    independent: dict[int, int]
    equations: dict[int, tuple[int, ...]]
    groups: list[tuple[int, list[int]]]
    seen: tuple[int, ...]


def counted(block: Block, setting: Setting, a: Answer, numbered: Sequence[int]) -> EquationCount | None:
    """The count for a block that was answered at the drawing; ``numbered``: the equation that each row is of.

    None where it was not decided, or is not what the freedom says.
    """
    if a.dof is None or len(a.matrix) != len(block.rows):
        return None
    counting = _Counting(block, setting, a)
    supports = counting.supports()
    if supports is None or len(supports) != max(0, len(block.rows) - (len(block.coordinates) - a.dof)):
        return None
    owners = [r.constraint for r in block.rows]
    following = Counter(owners[i] for i in supports)
    circuits = [{owners[i], *(owners[j] for j in support)} for i, support in supports.items()]
    joined = [{o for k in numbers for o in circuits[k]} for numbers in components(circuits)]
    groups = [(sum(following[o] for o in c), sorted(c)) for c in joined]
    equations = {o: tuple(numbered[i] for i in supports if owners[i] == o) for o in owners}
    independent = {o: k - following[o] for o, k in Counter(owners).items()}
    return EquationCount(independent, equations, sorted(groups, key=lambda g: g[1]), tuple(counting.seen))


@dataclass
class _Counting:
    """What follows from what, row by row; ``bent``: rows dependent at the drawing only; ``seen``: as in the count."""

    block: Block
    setting: Setting
    a: Answer
    seen: list[int] = field(default_factory=list)
    bent: list[int] = field(default_factory=list)
    following: dict[int, list[int]] = field(default_factory=dict)

    @cached_property
    def _near(self) -> NearDrawing:
        return NearDrawing(self.block, self.setting)

    @cached_property
    def _owners(self) -> list[int]:
        return [r.constraint for r in self.block.rows]

    @cached_property
    def _dependent(self) -> Mapping[int, Sequence[int]]:
        """Rows that are sums of rows before them at the drawing, and of which."""
        return echelon(self.a.matrix, self.a.modulus, supports=True).supports

    def supports(self) -> dict[int, list[int]] | None:
        """For every row that follows from those before it rows from which it does; None where that is open.

        The rows of one constraint stand in no order: of those that say the same beside others any may be the first.
        """
        for owner, rows in groupby(sorted(self._dependent), key=self._owners.__getitem__):
            left = self._left(rows)
            if left is None or not (self._by_one(owner, left) or self._by_freedom(left)):
                return None
        return self.following

    def _left(self, rows: Iterable[int]) -> list[int] | None:
        """Those of some dependent rows that follow from no independent ones; None where that is not known of one."""
        found = []
        for i in rows:
            check()
            pivots = [k for k in range(i) if k not in self._dependent]
            enough = SufficientSets(self._near, self._owners, pivots).enough(i, self._dependent[i])
            if enough is not None:
                self.following[i] = enough
            elif self._near.follows(i, pivots) is None:
                return None
            else:
                found.append(i)
        return found

    def _by_one(self, owner: int, rows: Sequence[int]) -> bool:
        """Do several rows of a constraint hold where one of them does beside those before, as far as numbers tell?"""
        if len(rows) < 2:
            return False
        pivots = [k for k, o in enumerate(self._owners) if o <= owner and k not in self._dependent]
        for first in rows:
            others = [i for i in rows if i != first]
            given = [*pivots, *self.bent, first]
            if self._near.seem_to_imply(given, others) and (not self.bent or self._takes_freedom(first)):
                self.bent.append(first)
                self.following |= dict.fromkeys(others, given)
                self.seen.append(owner)
                return True
        return False

    def _by_freedom(self, rows: Sequence[int]) -> bool:
        """Does each of some rows take freedom away, the first of all apart? They are independent then."""
        for i in rows:
            if self.bent and not self._takes_freedom(i):
                return False
            self.bent.append(i)
        return True

    def _takes_freedom(self, row: int) -> bool:
        """Do the rows before this one, but for those that follow, leave less freedom with it than without it?"""
        rows = [self.block.rows[k] for k in range(row + 1) if k not in self.following]
        before, after = (freedoms(self.block.coordinates, some, self.setting) for some in (rows[:-1], rows))
        return before is not None and after is not None and after.dof < before.dof
