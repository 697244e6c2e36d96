"""Which constraints of a system are redundant: by rank, by implication over branches, by removal, and copies."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

from dofkit.base.deadline import unless_late
from dofkit.base.verdicts import About, least, together
from dofkit.classification.dependence import removal
from dofkit.classification.dependence.circuits import ROWS, OwnedRows, analyse
from dofkit.classification.dependence.implication import IMPLIED, Everywhere
from dofkit.classification.dependence.implied_constraints import MAX_CHOICES, constraint_follows, implied
from dofkit.classification.dependence.near_reference import NearReference, is_at_reference
from dofkit.classification.freedom.branches import Outcome, off_reference
from dofkit.classification.freedom.preparation import algebraic, all_of, branches_at_reference
from dofkit.exact.matrices.sparse import components
from dofkit.relations.answer import IDENTITY, Answer, Redundancies, undecided_dependence
from dofkit.relations.blocks import Block, Row, coordinates_of
from dofkit.relations.normal.domain import DomainCondition, is_always_satisfied
from dofkit.relations.normal.pieces import Finite, Inequality, Nonlinear, Normal, Pfaffian, Piece, Reduced
from dofkit.relations.setting import Setting

#: Functions, besides algebraic ones, with which redundancy by rank is tested on all components.
BRANCHED = ("abs", "exp", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh")
#: {constraint: (block, answer) of the blocks with rows of it}.
BlocksOf = dict[int, list[tuple[Block, Answer]]]


def redundancies(reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> list[Redundancies]:
    """Return the redundancies of each set of constraints that share coordinates: by rank, or by implication.

    Constraints for which time runs out, or no method is sound, are undecided.
    """
    result = _void(reduced)
    if not outcome.consistent:
        return result
    result += copied(reduced, outcome)
    blocks: BlocksOf = defaultdict(list)
    for block, a in outcome.answered_parts:
        for i in dict.fromkeys(r.constraint for r in block.rows):
            blocks[i].append((block, a))
    bridged = outcome.bridged
    result += [_independent(bridged)] if bridged else []
    missed = zip(outcome.blocks, off_reference(outcome, setting), strict=True)
    elsewhere = {row.constraint for block, is_missed in missed if is_missed for row in block.rows}
    for numbers in _connected(reduced, outcome, bridged):
        of_part = setting if elsewhere.isdisjoint(numbers) else replace(setting, reference=None)
        work = partial(_of_relations, reduced, of_part, blocks, numbers)
        result += unless_late(work, [undecided_dependence(numbers)])
    return [_within_domain(r, reduced, setting) for r in result]


def _within_domain(r: Redundancies, reduced: Sequence[Reduced], setting: Setting) -> Redundancies:
    """Return ``r``, about a component only if a redundant constraint as written has no value at some points."""
    required = {c for i in r.redundant for c in reduced[i].domain() if not is_always_satisfied(c, setting.positive)}
    if not required:  # of many parts, each would look at all constraints otherwise
        return r
    by_others = {c for i, other in enumerate(reduced) if i not in r.redundant for c in other.domain()}
    return r if required <= by_others else _within(r, "component")


def _is_region(r: Reduced) -> bool:
    """Return whether all equations of a constraint are satisfied on regions (see `_is_conditional`)."""
    return bool(r.normals) and all(map(_is_conditional, r.normals))


def _is_conditional(n: Normal) -> bool:
    """Return whether all branches of an equation consist of conditions only, as those of abs(x) = x do."""
    return bool(n.branches) and all(b and all(isinstance(p, DomainCondition) for p in b) for b in n.branches)


def all_needed(dependent: Sequence[Redundancies], reduced: Sequence[Reduced], outcome: Outcome) -> list[Redundancies]:
    """Return the redundancies with undecided constraints as needed, given that no equation is surplus.

    They are unchanged if an equation may remove several freedoms (a sum of squares), if a row was rewritten by others,
    if there are hidden relations, or if the set is singular.
    """
    several = any(len(b) > 1 for r in reduced for n in r.normals for b in n.branches)
    if several or not _are_written(outcome.rows, reduced) or any(a.hidden or a.degenerate for a in outcome.answers):
        return list(dependent)
    answer = []
    for r in dependent:
        needed = {i: reduced[i].equations for i in r.undecided}
        answer.append(replace(r, independent={**r.independent, **needed}, undecided=()) if needed else r)
    return answer


def _connected(reduced: Sequence[Reduced], outcome: Outcome, bridged: Collection[int]) -> list[list[int]]:
    """Return the sets of constraints connected by coordinates, without copies and joints that close no loop."""
    used: list[int] = []
    names: list[frozenset[str]] = []
    for i, r in enumerate(reduced):
        if i in bridged:
            continue
        pieces = [p for n in r.normals for b in n.branches for p in b if not isinstance(p, Inequality)]
        if pieces and i not in outcome.copies:
            used.append(i)
            names.append(frozenset().union(*map(coordinates_of, (*pieces, *r.domain()))))
    return [[used[k] for k in numbers] for numbers in components(names)]


def _of_relations(
    reduced: Sequence[Reduced], setting: Setting, blocks_of: BlocksOf, numbers: Sequence[int]
) -> list[Redundancies]:
    """Return the redundancies of connected constraints by rank if this is sound, otherwise by implication."""
    blocks = list({id(block): (block, a) for i in numbers for block, a in blocks_of.get(i, ())}.values())
    if _each_takes_one(reduced, numbers, blocks):
        return [_independent({i: reduced[i].equations for i in numbers})]
    on_a_region = any(i not in blocks_of for i in numbers)
    if on_a_region or not _measured_by_rank(reduced, setting, numbers, blocks):
        return [_as_free(implied(reduced, setting, numbers), reduced, blocks)]
    numbered = _numbered(reduced[i] for i in numbers)
    answered = [
        a for block in blocks if block[1].velocity_dof is not None for a in _of_block(*block, setting, numbered)
    ]
    settled = [a for a in answered if isinstance(a, Redundancies)]
    needed = set[int]().union(*(r.needed for r in settled))
    by_rank = []
    by_rows = [a for a in answered if isinstance(a, OwnedRows) and a.owners]  # joined if they share a constraint
    for places in components(part.owners for part in by_rows):
        group = [by_rows[k] for k in places]
        undecided = undecided_dependence(o for rows in group for o in rows.owners)
        by_rank.append(unless_late(partial(analyse, group, needed), undecided))
    conditional = _has_piece(reduced, (i for r in by_rank for i in r.redundant), DomainCondition)
    unsound = conditional or _has_piece(reduced, (i for r in by_rank for i in r.uncounted), Pfaffian)
    linear: About | None = "everywhere" if all(a.linear for _, a in blocks) else None
    work = partial(_scope, reduced, setting, numbers, by_rank)
    scope = None if unsound else linear or unless_late(work, None)
    if scope is None:
        return [*settled, _as_free(implied(reduced, setting, numbers), reduced, blocks)]
    return [_within(r, scope) for r in _agreed([*settled, *by_rank])]


def _has_piece(reduced: Sequence[Reduced], numbers: Iterable[int], kind: type[Piece]) -> bool:
    """Return whether a branch of one of some constraints has a piece of a kind."""
    return any(isinstance(p, kind) for i in numbers for n in reduced[i].normals for b in n.branches for p in b)


def _within(r: Redundancies, scope: About) -> Redundancies:
    """Return the redundancies with a claim about the points of ``scope`` at most."""
    return replace(r, claim=replace(r.claim, about=least(r.claim.about, scope)))


def _scope(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], by_rank: Sequence[Redundancies]
) -> About | None:
    """Return for which points the redundancy by rank is valid; None if it fails on some component, or is undecided.

    x^2 + y^2 = 1, x = 1, y = 0: the first two have one gradient at the solution, but without x = 1 there is x = -1.
    Only few algebraic equations are examined on all components, and these may miss one, so that the claim is about the
    component at which the rank was computed. If there are forms, geometric equations are compared with each other.
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
    return "component" if follow or (follow is None and len(finite) < len(numbers)) else None


def _as_free(implied: Redundancies, reduced: Sequence[Reduced], blocks: Sequence[tuple[Block, Answer]]) -> Redundancies:
    """Return redundancies by implication with numbers of independent equations that agree with the freedom.

    The independent equations must be as many as freedoms are removed, and the groups must account for the others. If
    they do not agree, rows are counted instead, at the points where the freedom was determined: of x z = 0 and z = 0
    one, although the second is not implied by the first. If this fails too, the numbers are unknown.
    """
    if implied.undecided or any(a.velocity_dof is None for _, a in blocks):
        return implied
    removed = sum(len(block.coordinates) - (a.velocity_dof or 0) for block, a in blocks)
    equations = sum(reduced[i].equations for i in implied.independent)
    if sum(implied.independent.values()) <= removed and _account_for_others(implied, equations):
        return implied
    matrices = [OwnedRows(a.matrix, removal.owners_of(b), _finite_rows(b), a.modulus) for b, a in blocks]
    complete = all(len(part.matrix) == len(part.owners) for part in matrices)
    by_rank = analyse(matrices) if complete else Redundancies({})
    with_rows = {owner for part in matrices for owner in part.owners}
    idle = [(reduced[i].equations, [i]) for i in implied.independent if i not in with_rows]
    independent = {i: by_rank.independent.get(i, 0) for i in implied.independent}
    counted = replace(implied, independent=independent, groups=[*by_rank.groups, *idle], equations={})
    members = {i for _, group in counted.groups for i in group}
    agree = sum(independent.values()) == removed and _account_for_others(counted, equations)
    if agree and members >= {*implied.redundant}:
        return counted
    return replace(implied, independent={}, uncounted=tuple(implied.independent))


def _account_for_others(dependence: Redundancies, equations: int) -> bool:
    """Return whether the nullities of the groups add up to the number of equations that are not independent."""
    return sum(nullity for nullity, _ in dependence.groups) >= equations - sum(dependence.independent.values())


def _finite_rows(block: Block) -> list[bool]:
    return [isinstance(r.piece, Finite) for r in block.rows]


def _agreed(dependent: Sequence[Redundancies]) -> list[Redundancies]:
    """Return redundancies in which a constraint is redundant only if it is needed in none of them."""
    return [r.without(set().union(*(other.needed for other in dependent))) for r in dependent]


def _measured_by_rank(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], blocks: Sequence[tuple[Block, Answer]]
) -> bool:
    """Return whether dependence is a deficiency of rank: there is one branch, and nothing nonlinear or hidden."""
    normals = [n for i in numbers for n in reduced[i].normals]
    if any(len(branches_at_reference(n, setting).branches) > 1 for n in normals):
        return False
    nonlinear = any(isinstance(p, Nonlinear) for n in normals for p in n.pieces)
    hidden = any(a.hidden for _, a in blocks) and len(numbers) <= MAX_CHOICES
    return not (nonlinear or hidden)


def _of_block(
    block: Block, a: Answer, setting: Setting, numbered: Mapping[int, int]
) -> Iterator[Redundancies | OwnedRows]:
    """Yield the redundancies of a block, or its rows if they can be analysed by rank, with those of other blocks."""
    nullity = len(block.rows) - (len(block.coordinates) - (a.velocity_dof or 0))
    owners = removal.owners_of(block)
    equations = [numbered.get(id(r.piece), -1) for r in block.rows]
    first = len(block.finite)
    matrix = a.matrix[:first] + a.matrix[first + len(a.hidden) :]  # without the rows of hidden equations
    undecided = undecided_dependence(owners)
    removed = partial(removal.by_removal, block, setting, a, nullity, equations)
    is_finite = "balls" in setting.engines and len(block.finite) == len(block.rows)
    by_removal = partial(unless_late, removed if is_finite else partial(undecided_dependence, owners), undecided)
    if a.degenerate or a.hidden or len(matrix) != len(block.rows):
        yield by_removal()
    else:
        finite = _finite_rows(block)
        # a constraint with a single row is redundant if and only if this row is
        sure = a.supports is not None or (a.identical and a.trusted and len({*owners}) == len(owners))
        of_kind = NearReference if is_at_reference(block, a, setting) else Everywhere
        implied = None if sure or nullity <= 0 else of_kind(block, setting)
        claim = a.claim if sure or a.linear else together(ROWS, IMPLIED)
        yield OwnedRows(
            matrix, owners, finite, a.modulus, equations, a.supports, implied, claim, by_removal if is_finite else None
        )


def _independent(counted: Mapping[int, int]) -> Redundancies:
    """Return redundancies with so many equations of each constraint, all independent."""
    return Redundancies(dict(counted), equations=dict.fromkeys(counted, ()))


def _numbered(reduced: Iterable[Reduced]) -> dict[int, int]:
    """Return {id of a piece: the number of its scalar equation in its constraint}."""
    return {id(p): k for r in reduced for k, n in enumerate(r.normals) for p in n.pieces}


def _are_written(rows: Iterable[Row], reduced: Iterable[Reduced]) -> bool:
    """Return whether rows are as written: zdot = 0 is what xdot^2 + ydot^2 + zdot^2 = 1 says only with other rows."""
    return _numbered(reduced).keys() >= {id(r.piece) for r in rows}


def _each_takes_one(reduced: Sequence[Reduced], numbers: Sequence[int], blocks: Sequence[tuple[Block, Answer]]) -> bool:
    """Return whether each equation has one row and removes one freedom, so that none is implied by the others."""
    rows = [r for block, _ in blocks for r in block.rows]
    single = sorted([r.constraint for r in rows]) == [i for i in numbers for _ in range(reduced[i].equations)]
    plain = all(a.velocity_dof is not None and not (a.hidden or a.degenerate) for _, a in blocks)
    removed = sum(len(block.coordinates) - (a.velocity_dof or 0) for block, a in blocks)
    return single and plain and len(rows) == removed and _are_written(rows, (reduced[i] for i in numbers))


def copied(reduced: Sequence[Reduced], outcome: Outcome) -> list[Redundancies]:
    """Return that each constraint that is a copy of an earlier one is redundant."""
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
    """Return the (nullity, members) of all groups; those that share a constraint are joined."""
    groups = [g for r in dependent for g in r.groups]
    merged = []
    for numbers in components(members for _, members in groups):
        together = {i for k in numbers for i in groups[k][1]}
        merged.append((sum(groups[k][0] for k in numbers), sorted(together)))
    return sorted(merged, key=lambda g: g[1])


def _void(reduced: Sequence[Reduced]) -> list[Redundancies]:
    """Return that relations that are always satisfied (0 = 0) are redundant.

    Equations satisfied on a region, in constraints with other equations, are counted here as dependent as well.
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
