"""What can go without changing the set: constraints left out one by one, the last in the order first.

Where leaving a constraint out gives freedom, it is needed. Where it gives none, what the constraint says must follow
from what is left: the set may lose a part and keep its dimension.

How many equations are independent of all before them where relations are dependent at the drawing only.

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
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations, groupby
from typing import NamedTuple

from dofkit.base.components import components
from dofkit.base.deadline import OutOfTimeError, check, limited
from dofkit.base.verdicts import Verdict, weakest
from dofkit.classification.dependence.block_implication import Everywhere, NearDrawing, SufficientSets, is_drawn
from dofkit.classification.dependence.circuits import Redundancies
from dofkit.classification.dependence.implied_constraints import LEAVING_SECONDS
from dofkit.classification.freedom.block import answer
from dofkit.classification.freedom.reference_branches import all_of
from dofkit.exact.matrices.sparse import echelon
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, split
from dofkit.relations.normal.pieces import Finite, Still
from dofkit.relations.setting import Setting


def by_removal(block: Block, setting: Setting, a: Answer, nullity: int, numbered: Sequence[int]) -> Redundancies:
    """What can go, the last in the order first, without changing the freedom of the block nor its set.

    ``nullity``: rows too many by the freedom, where nothing else tells; ``numbered``: the equation each row is of.
    """
    differential = {r.constraint for r in block.rows if not isinstance(r.piece, Finite)}
    integrated = {r.constraint for r in block.rows if _constant(r) is not None}
    owners = owners_of(block)
    order = sorted(dict.fromkeys(owners), key=lambda o: (o in differential) + (o in integrated))
    left = LeftOut(block, setting, a)
    with limited(LEAVING_SECONDS):
        found = _dispensable(left, order)
        circuits = _circuits(left, order, found.redundant)
    nullity = max(nullity, sum(o in found.redundant for o in owners))
    groups = [(nullity, sorted(order))] if found.redundant else []
    told = replace(found, groups=groups, circuits=circuits, verdict=left.verdict)
    count = counted(block, setting, a, numbered) if is_drawn(block, a, setting) else None
    if count is not None:
        groups = groups or count.groups
        counts = replace(told, independent=count.independent, equations=count.equations, seen=count.seen)
        return replace(counts, groups=groups, verdict=weakest(told.verdict, "numeric" if count.seen else "proved"))
    independent = {o: 0 for o, circuit in circuits.items() if circuit and max(circuit) < o}
    independent |= {o: 1 for o in order if owners.count(o) == 1 and o not in (*found.redundant, *found.undecided)}
    uncounted = tuple(o for o in order if o not in independent and o not in found.undecided)
    return replace(told, independent=independent, uncounted=uncounted)


def _dispensable(left: LeftOut, order: Sequence[int]) -> Redundancies:
    """As many constraints as can go together, the last in the order first, and those of which it is not known.

    What can go together can go one by one. Of constraints that can go one by one as many are tried as could be more.
    """
    gone, single, open_ = list[int](), list[int](), list[int]()
    try:
        for owner in reversed(order):
            alone = left.can_go([owner])
            together = left.can_go([*gone, owner]) if alone else alone
            single += [owner] if alone else []
            gone += [owner] if together else []
            open_ += [owner] if together is None else []
        while len(gone) < len(single):
            more = combinations(single, len(gone) + 1)
            better = next((choice for choice in more if left.can_go(choice) is not False), None)
            if better is None or left.can_go(better) is None:
                open_ += better or ()
                break
            gone = list(better)
    except OutOfTimeError:
        open_ += [o for o in order if o not in gone]
    return Redundancies({}, sorted(gone), [], {}, tuple(sorted(set(open_) - set(gone))))


def _circuits(left: LeftOut, order: Sequence[int], redundant: Sequence[int]) -> dict[int, list[int]]:
    """For each constraint that can go a minimal set of those kept from which it follows; none where that is open."""
    found = {}
    for owner in redundant:
        kept = [o for o in order if o not in redundant]
        try:
            for other in reversed(kept):
                if left.can_go([owner], [o for o in kept if o != other]):
                    kept = [o for o in kept if o != other]
        except OutOfTimeError:
            break
        found[owner] = sorted(kept)
    return found


def owners_of(block: Block) -> list[int]:
    """The constraint that wrote each row."""
    return [r.constraint for r in block.rows]


@dataclass
class LeftOut:
    """A block without some of its constraints; each choice is asked once. ``verdict``: of the weakest argument."""

    block: Block
    setting: Setting
    whole: Answer
    verdict: Verdict = "proved"
    _told: dict[tuple[frozenset[int], frozenset[int]], bool | None] = field(default_factory=dict)
    _freedom: dict[frozenset[int], Freedoms | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        a = self.whole
        if a.dof is not None and a.velocity_dof is not None:
            self._freedom[frozenset(owners_of(self.block))] = Freedoms(a.dof, a.velocity_dof, {*a.hidden})

    def can_go(self, owners: Collection[int], others: Collection[int] | None = None) -> bool | None:
        """Is the set that some constraints and ``others`` cut out the same without the former? None: not decided.

        ``others``: where none are given, all other constraints of the block.
        """
        gone = frozenset(owners)
        kept = frozenset(o for o in owners_of(self.block) if o not in gone) if others is None else frozenset(others)
        if (gone, kept) not in self._told:
            check()
            same = self._same_freedom(gone, kept)
            self._told[gone, kept] = self._same_set(gone, kept) if same else same
        return self._told[gone, kept]

    def _same_freedom(self, gone: frozenset[int], kept: frozenset[int]) -> bool | None:
        """Are the freedoms the same, and are the hidden relations there too?"""
        before, after = self._freedoms(gone | kept), self._freedoms(kept)
        if before is None or after is None:
            return None
        needed = {g for g in before.hidden if not any(s.args[1] in self._constants(gone) for s in g.symbols)}
        return (before.dof, before.velocity_dof) == (after.dof, after.velocity_dof) and after.hidden >= needed

    def _freedoms(self, kept: frozenset[int]) -> Freedoms | None:
        """The freedoms that some constraints leave, without the constants of integration of the others."""
        if kept not in self._freedom:
            gone = self._constants(frozenset(owners_of(self.block)) - kept)
            names = [c for c in self.block.coordinates if c not in gone]
            rows = [r for r in self.block.rows if r.constraint in kept]
            self._freedom[kept] = freedoms(names, rows, self.setting)
        return self._freedom[kept]

    def _constants(self, owners: frozenset[int]) -> set[str | None]:
        return {_constant(r) for r in self.block.rows if r.constraint in owners} - {None}

    def _same_set(self, gone: frozenset[int], kept: frozenset[int]) -> bool | None:
        """Does what is left out follow? It does near a drawing where nothing but motions of the whole is left there.

        What holds for some constant of integration is told by the freedom, and the relations it hides, alone.
        """
        rows, others = ([i for i, r in enumerate(self.block.rows) if r.constraint in own] for own in (gone, kept))
        if not is_drawn(self.block, self.whole, self.setting):
            everywhere = Everywhere(self.block, self.setting)
            self.verdict = weakest(self.verdict, "probable")
            return True if self._constants(gone) else all_of(everywhere.follows(i, others) for i in rows)
        near = NearDrawing(self.block, self.setting)
        after = self._freedoms(kept)
        if near.is_orbit(others, None if after is None else after.dof):
            return True
        if near.imply(others, rows, self.whole):
            self.verdict = weakest(self.verdict, "probable")
            return True
        self.verdict = weakest(self.verdict, "numeric")
        return near.seem_to_imply(others, rows) or None


def _constant(row: Row) -> str | None:
    """The constant of integration C of a row dC = 0."""
    return next(iter(row.piece.coefficients)) if isinstance(row.piece, Still) else None


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
