"""Which constraints of a system are redundant: by rank, over branches, by leaving out, and copies."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Literal

from dofkit.base.deadline import unless_late
from dofkit.base.verdicts import About, least, together
from dofkit.classification.dependence import removal
from dofkit.classification.dependence.circuits import ROWS, OwnedRows, analyse
from dofkit.classification.dependence.implication import IMPLIED, implication_of
from dofkit.classification.dependence.implied_constraints import MAX_CHOICES, constraint_follows, implied
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.freedom.preparation import algebraic, all_of, branches_at_reference
from dofkit.exact.matrices.sparse import SparseRow, components
from dofkit.relations.answer import IDENTITY, Answer, Redundancies, undecided_dependence
from dofkit.relations.blocks import Block, coordinates_of
from dofkit.relations.normal.domain import DomainCondition, is_always_satisfied
from dofkit.relations.normal.pieces import Finite, Inequality, Nonlinear, Normal, Reduced
from dofkit.relations.setting import Setting

#: Functions that may state one branch only.
BRANCHED = ("abs", "exp", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh")
#: The blocks that hold rows of a constraint, with their answers, by its number.
BlocksOf = dict[int, list[tuple[Block, Answer]]]


def redundancies(reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> list[Redundancies]:
    """Part by part, by the rank of the rows; where that does not measure dependence, by what is implied by what.

    Where there is no time or no way to tell, the constraints concerned are undecided.
    """
    result = _void(reduced)
    if not outcome.consistent:
        return result
    result += copied(reduced, outcome)
    blocks: BlocksOf = defaultdict(list)
    for block, a in outcome.answered_parts:
        for i in dict.fromkeys(r.constraint for r in block.rows):
            blocks[i].append((block, a))
    apart = outcome.bridged
    result += [_independent(apart)] if apart else []
    for numbers in _connected(reduced, outcome, apart):
        work = partial(_of_part, reduced, setting, blocks, numbers)
        result += unless_late(work, [undecided_dependence(numbers)])
    return [_within_domain(r, reduced, setting) for r in result]


def _within_domain(r: Redundancies, reduced: Sequence[Reduced], setting: Setting) -> Redundancies:
    """Return the same about a component where what is redundant has no value, as it was written, at some points."""
    asked = {c for i in r.redundant for c in reduced[i].domain() if not is_always_satisfied(c, setting.positive)}
    needed = {c for i, other in enumerate(reduced) if i not in r.redundant for c in other.domain()}
    return r if asked <= needed else _within(r, "component")


def _is_region(r: Reduced) -> bool:
    """Return whether all equations of a constraint only state where they are satisfied."""
    return bool(r.normals) and all(map(_is_conditional, r.normals))


def _is_conditional(n: Normal) -> bool:
    """Return whether an equation only states where it is satisfied, on all its branches."""
    return bool(n.branches) and all(b and all(isinstance(p, DomainCondition) for p in b) for b in n.branches)


def all_needed(dependent: Sequence[Redundancies], reduced: Sequence[Reduced], outcome: Outcome) -> list[Redundancies]:
    """With no equation too many, what was undecided is needed, where every equation takes one freedom at most.

    One that says several things (a sum of squares), hidden relations or a singular set may hide that another follows.
    """
    several = any(len(b) > 1 for r in reduced for n in r.normals for b in n.branches)
    if several or any(a.hidden or a.degenerate for a in outcome.answers):
        return list(dependent)
    answer = []
    for r in dependent:
        needed = {i: reduced[i].equations for i in r.undecided}
        answer.append(replace(r, independent={**r.independent, **needed}, undecided=()) if needed else r)
    return answer


def _connected(reduced: Sequence[Reduced], outcome: Outcome, apart: Collection[int]) -> list[list[int]]:
    """The constraints in use but those ``apart``, those together that share coordinates."""
    used: list[int] = []
    names: list[frozenset[str]] = []
    for i, r in enumerate(reduced):
        if i in apart:
            continue
        every = [p for n in r.normals for b in n.branches for p in b]
        pieces = every if _is_region(r) else [p for p in every if not isinstance(p, Inequality | DomainCondition)]
        if pieces and i not in outcome.copies:
            used.append(i)
            names.append(frozenset().union(*map(coordinates_of, pieces)))
    return [[used[k] for k in numbers] for numbers in components(names)]


def _of_part(
    reduced: Sequence[Reduced], setting: Setting, blocks: BlocksOf, numbers: Sequence[int]
) -> list[Redundancies]:
    """Of constraints that share coordinates: those that take freedom away, then those that hold on whole regions."""
    regions = [i for i in numbers if _is_region(reduced[i])]
    if not regions:
        return _of_relations(reduced, setting, blocks, numbers)
    others = [i for i in numbers if i not in regions]
    by_others = _of_relations(reduced, setting, blocks, others) if others else []
    undecided = [Redundancies({i: 0}, groups=[(reduced[i].equations, [i])], undecided=(i,)) for i in regions]
    return [*by_others, *undecided]


def _of_relations(
    reduced: Sequence[Reduced], setting: Setting, blocks_of: BlocksOf, numbers: Sequence[int]
) -> list[Redundancies]:
    """Of constraints that share coordinates: by implication where rank does not measure dependence, else by rank."""
    blocks = list({id(block): (block, a) for i in numbers for block, a in blocks_of.get(i, ())}.values())
    if _each_takes_one(reduced, numbers, blocks):
        return [_independent({i: reduced[i].equations for i in numbers})]
    if not _measured_by_rank(reduced, setting, numbers, blocks):
        return [_as_free(implied(reduced, setting, numbers), reduced, blocks)]
    numbered = _numbered(reduced[i] for i in numbers)
    answered = [
        a for block in blocks if block[1].velocity_dof is not None for a in _of_block(*block, setting, numbered)
    ]
    settled = [a for a in answered if isinstance(a, Redundancies)]
    needed = set[int]().union(*(r.needed for r in settled))
    by_rank = []
    for group in _joined([a for a in answered if isinstance(a, OwnedRows)]):
        undecided = undecided_dependence(o for rows in group for o in rows.owners)
        by_rank.append(unless_late(partial(analyse, group, needed), undecided))
    redundant = [reduced[i] for r in by_rank for i in r.redundant]
    if any(isinstance(p, DomainCondition) for r in redundant for n in r.normals for b in n.branches for p in b):
        return [*settled, _as_free(implied(reduced, setting, numbers), reduced, blocks)]
    is_linear = all(a.linear for _, a in blocks)
    scope = "everywhere" if is_linear else unless_late(partial(_scope, reduced, setting, numbers, by_rank), None)
    if scope is False:
        return [*settled, _as_free(implied(reduced, setting, numbers), reduced, blocks)]
    if scope is None:
        return _agreed([*settled, *(_undecided_redundancy(r) for r in by_rank)])
    return [_within(r, scope) for r in _agreed([*settled, *by_rank])]


def _within(r: Redundancies, scope: About) -> Redundancies:
    """Return the same about fewer points."""
    return replace(r, claim=replace(r.claim, about=least(r.claim.about, scope)))


def _undecided_redundancy(r: Redundancies) -> Redundancies:
    """Return what remains where constraints are redundant by rank at one point, and may be needed elsewhere."""
    independent = {i: k for i, k in r.independent.items() if i not in r.redundant}
    return Redundancies(independent, undecided=tuple(r.redundant), claim=r.claim)


def _scope(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], by_rank: Sequence[Redundancies]
) -> About | Literal[False] | None:
    """Return for which points the redundancy by rank is valid; False where it fails on some component.

    x^2 + y^2 = 1, x = 1, y = 0: the first two have one gradient at the solution, but without x = 1 there is x = -1.
    Only few algebraic equations are examined on all components, which may miss one; so the answer is about the
    component on which the rank was taken. Where forms occur, geometric equations are compared with each other:
    of sin(z) = 0 and z = 0 the first is redundant. None: undecided.
    """
    dropped = {i for r in by_rank for i in r.redundant}
    if setting.reference is not None:
        return "reference"
    if not dropped or len(numbers) > MAX_CHOICES:
        return "component"
    finite = [i for i in numbers if all(isinstance(p, Finite) for n in reduced[i].normals for p in n.pieces)]
    pieces = [p for i in finite for n in reduced[i].normals for p in n.pieces]
    written = all(reduced[i].constraint.facts.written for i in numbers)
    if not written or not all(isinstance(p, Finite) and algebraic(p.expr, *BRANCHED) for p in pieces):
        return "component"
    kept = [i for i in finite if i not in dropped]
    follow = all_of(constraint_follows(reduced, i, kept, setting) for i in dropped if i in finite)
    if len(finite) < len(numbers):
        return False if follow is False else "component"
    return "component" if follow else follow


def _as_free(implied: Redundancies, reduced: Sequence[Reduced], blocks: Sequence[tuple[Block, Answer]]) -> Redundancies:
    """Return what was counted, where it agrees with the freedom that the equations take away.

    No more equations are independent than take freedom away, and the groups hold all others. Where the order in which
    equations imply each other says otherwise, their rows are counted, at the points where the freedom was determined:
    none of what is satisfied on a whole region; of x z = 0 and z = 0 one, though neither is implied by those before it.
    """
    if implied.undecided or any(a.velocity_dof is None for _, a in blocks):
        return implied
    taken = sum(len(block.coordinates) - (a.velocity_dof or 0) for block, a in blocks)
    equations = sum(reduced[i].equations for i in implied.independent)
    if sum(implied.independent.values()) <= taken and _hold_the_others(implied, equations):
        return implied
    matrices = [OwnedRows(a.matrix, removal.owners_of(b), _finite_rows(b), a.modulus) for b, a in blocks]
    complete = all(len(part.matrix) == len(part.owners) for part in matrices)
    by_rank = analyse(matrices) if complete else Redundancies({})
    with_rows = {owner for part in matrices for owner in part.owners}
    idle = [(reduced[i].equations, [i]) for i in implied.independent if i not in with_rows]
    independent = {i: by_rank.independent.get(i, 0) for i in implied.independent}
    counted = replace(implied, independent=independent, groups=[*by_rank.groups, *idle], equations={})
    members = {i for _, group in counted.groups for i in group}
    if sum(independent.values()) == taken and members >= {*implied.redundant} and _hold_the_others(counted, equations):
        return counted
    return replace(implied, independent={}, uncounted=tuple(implied.independent))


def _hold_the_others(dependence: Redundancies, equations: int) -> bool:
    """Return whether the groups hold as many equations as are not independent."""
    return sum(nullity for nullity, _ in dependence.groups) >= equations - sum(dependence.independent.values())


def _finite_rows(block: Block) -> list[bool]:
    return [isinstance(r.piece, Finite) for r in block.rows]


def _agreed(dependent: Sequence[Redundancies]) -> list[Redundancies]:
    """A constraint of several equations is redundant only where all of them are, whatever block they are in."""
    return [r.without(set().union(*(other.needed for other in dependent))) for r in dependent]


def _measured_by_rank(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], blocks: Sequence[tuple[Block, Answer]]
) -> bool:
    """Return whether the rank measures dependence: one branch, and nothing nonlinear or hidden."""
    normals = [n for i in numbers for n in reduced[i].normals]
    if any(len(branches_at_reference(n, setting).branches) > 1 for n in normals):
        return False
    bent = any(isinstance(p, Nonlinear) for n in normals for p in n.pieces)
    hidden = any(a.hidden for _, a in blocks) and len(numbers) <= MAX_CHOICES
    return not (bent or hidden)


def _of_block(
    block: Block, a: Answer, setting: Setting, numbered: Mapping[int, int]
) -> Iterator[Redundancies | OwnedRows]:
    """What is settled of a block at once, or its rows where their rank tells."""
    nullity = len(block.rows) - (len(block.coordinates) - (a.velocity_dof or 0))
    owners = removal.owners_of(block)
    equations = [numbered.get(id(r.piece), -1) for r in block.rows]
    matrix = _without_hidden(block, a)
    if nullity <= 0 and a.hidden and not a.degenerate:
        yield _independent(dict(Counter(owners)))
    elif a.degenerate or a.hidden or len(matrix) != len(block.rows):
        undecided = undecided_dependence(owners)
        is_finite = "balls" in setting.engines and len(block.finite) == len(block.rows)
        removed = partial(removal.by_removal, block, setting, a, nullity, equations)
        yield unless_late(removed, undecided) if is_finite else undecided
    else:
        finite = _finite_rows(block)
        # a constraint that wrote a single row is dropped or not, as its row depends or not
        sure = a.supports is not None or (a.identical and a.trusted and len({*owners}) == len(owners))
        implied = None if sure or nullity <= 0 else implication_of(block, a, setting)
        claim = a.claim if sure or a.linear else together(ROWS, IMPLIED)
        yield OwnedRows(matrix, owners, finite, a.modulus, equations, a.supports, implied, claim)


def _joined(matrices: Sequence[OwnedRows]) -> list[list[OwnedRows]]:
    """Return the rows in groups: blocks that share a constraint are examined together."""
    owned = [part for part in matrices if part.owners]
    return [[owned[k] for k in numbers] for numbers in components(part.owners for part in owned)]


def _without_hidden(block: Block, a: Answer) -> list[SparseRow]:
    """Return the matrix without the rows of hidden equations."""
    first = len(block.finite)
    return a.matrix[:first] + a.matrix[first + len(a.hidden) :]


def _independent(counted: Mapping[int, int]) -> Redundancies:
    """So many equations of each constraint, all independent."""
    return Redundancies(dict(counted), equations=dict.fromkeys(counted, ()))


def _numbered(reduced: Iterable[Reduced]) -> dict[int, int]:
    """The number of the scalar equation that a piece is of, by the piece's identity."""
    return {id(p): k for r in reduced for k, n in enumerate(r.normals) for p in n.pieces}


def _each_takes_one(reduced: Sequence[Reduced], numbers: Sequence[int], blocks: Sequence[tuple[Block, Answer]]) -> bool:
    """Return whether the freedom is less by as many as there are equations, one row each: none is implied then.

    On the branches in use the rows of the others leave no part of which the freedom is less by more than they are.
    """
    rows = Counter(r.constraint for block, _ in blocks for r in block.rows)
    single = rows == {i: reduced[i].equations for i in numbers}
    plain = all(a.velocity_dof is not None and not (a.hidden or a.degenerate) for _, a in blocks)
    return (
        single
        and plain
        and sum(rows.values()) == sum(len(block.coordinates) - (a.velocity_dof or 0) for block, a in blocks)
    )


def copied(reduced: Sequence[Reduced], outcome: Outcome) -> list[Redundancies]:
    """What was written before is redundant."""
    return [
        Redundancies(
            {i: 0},
            [i],
            [(reduced[i].equations, sorted((i, j)))],
            {i: [j]},
            equations={i: tuple(range(reduced[i].equations))},
            claim=IDENTITY,
        )
        for i, j in outcome.copies.items()
    ]


def merged(dependent: Sequence[Redundancies]) -> list[tuple[int, list[int]]]:
    """Groups that share a constraint are one."""
    groups = [g for r in dependent for g in r.groups]
    merged = []
    for numbers in components(members for _, members in groups):
        together = {i for k in numbers for i in groups[k][1]}
        merged.append((sum(groups[k][0] for k in numbers), sorted(together)))
    return sorted(merged, key=lambda g: g[1])


def _void(reduced: Sequence[Reduced]) -> list[Redundancies]:
    """Relations that are always satisfied (0 = 0) are redundant by themselves.

    What is satisfied on a region only does not reduce the freedom either; as a part of a constraint it is counted here.
    """
    result = []
    for i, r in enumerate(reduced):
        void = tuple(k for k, normal in enumerate(r.normals) if normal.branches == ((),))
        partly = () if _is_region(r) else tuple(k for k, normal in enumerate(r.normals) if _is_conditional(normal))
        if void or partly:
            idle = len(void) + len(partly)
            redundant = [i] if len(void) == r.equations else []
            circuits: dict[int, list[int]] = {i: [] for i in redundant}
            named = {} if partly else {i: void}
            result.append(Redundancies({i: 0}, redundant, [(idle, [i])], circuits, equations=named, claim=IDENTITY))
    return result
