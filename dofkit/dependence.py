"""Which constraints of a system can be dropped: by rank, over branches, by leaving out, and copies."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import networkx as nx

from dofkit.analysis import answer
from dofkit.answers import Answer, Setting
from dofkit.blocks import Block, Row, split
from dofkit.branches import algebraic, all_of, follows, through_reference
from dofkit.deadline import check, limited, unless_late
from dofkit.exact.sparse import SparseRow
from dofkit.normal import Finite, Still
from dofkit.redundancy import Redundancies, Rows, analyse, left_open
from dofkit.solving import Outcome, Reduced

#: Constraints of one set that are tried one by one, and seconds spent on leaving constraints out.
MAX_CHOICES, LEAVING_SECONDS = 16, 5.0


def redundancies(reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> list[Redundancies]:
    """Block by block, by the rank of the rows; where that does not measure dependence, by leaving constraints out.

    Where there is no time or no way to tell, the constraints concerned are left open.
    """
    found = [_void(reduced)]
    if not outcome.consistent:
        return found
    found += copied(reduced, outcome)
    if any(len(through_reference(n, setting).branches) > 1 for r in reduced for n in r.normals):
        return found + _over_branches(reduced, setting, outcome)
    parts: list[Rows] = []
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        if not block.rows or a.velocity_dof is None:
            continue
        nullity = len(block.rows) - (len(block.coordinates) - a.velocity_dof)
        owners = owners_of(block)
        finite = [isinstance(r.piece, Finite) for r in block.rows]
        matrix = _without_hidden(block, a)
        if nullity <= 0 and (a.degenerate or a.hidden):
            found.append(Redundancies({o: owners.count(o) for o in owners}, [], [], {}))
        elif a.degenerate or a.hidden or len(matrix) != len(block.rows):
            found.append(unless_late(partial(_by_leaving_out, block, setting, a, nullity), left_open(owners)))
        else:
            parts.append(Rows(matrix, owners, finite, a.modulus))
    by_rank = [
        unless_late(partial(_analysed, group), left_open(o for part in group for o in part.owners))
        for group in _sharing(parts)
    ]
    everywhere = unless_late(partial(_everywhere, reduced, setting, outcome, by_rank), None)
    if everywhere:
        return found + by_rank
    return found + (
        _over_branches(reduced, setting, outcome) if everywhere is False else list(map(_at_a_point, by_rank))
    )


def _at_a_point(r: Redundancies) -> Redundancies:
    """Redundant by rank at a point, and not known to be so elsewhere."""
    independent = {i: k for i, k in r.independent.items() if i not in r.redundant}
    return Redundancies(independent, [], [], {}, tuple(r.redundant))


def _everywhere(
    reduced: Sequence[Reduced], setting: Setting, outcome: Outcome, by_rank: Sequence[Redundancies]
) -> bool | None:
    """Does what is redundant by rank hold wherever the others do? False where a written equation does not.

    x^2 + y^2 = 1, x = 1, y = 0: the first two have one gradient at the solution, but without x = 1 there is x = -1.
    """
    dropped = {i for r in by_rank for i in r.redundant}
    written = [i for i, r in enumerate(reduced) if r.normals and i not in outcome.copies]
    if not dropped or setting.reference is not None or len(written) > MAX_CHOICES:
        return True
    plain = all(reduced[i].constraint.type in ("equation", "on") for i in written)
    pieces = [p for i in written for n in reduced[i].normals for p in n.pieces]
    if not plain or not all(isinstance(p, Finite) and algebraic(p.expr) for p in pieces):
        return True
    kept = [i for i in written if i not in dropped]
    return all_of(_follows(reduced, i, kept, setting) for i in dropped)


def _analysed(group: list[Rows]) -> Redundancies:
    """One group's redundancies."""
    check()
    return analyse(group)


def _over_branches(reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> list[Redundancies]:
    """With several branches a constraint is redundant where it holds on every branch of the others."""
    numbers = [i for i, r in enumerate(reduced) if r.normals and i not in outcome.copies]
    independent = {i: reduced[i].equations for i in numbers}
    if len(numbers) > MAX_CHOICES:
        return [left_open(numbers)]
    kept, circuits, undecided = list(numbers), {}, []
    for i in reversed(numbers):
        others = [j for j in kept if j != i]
        known = _follows(reduced, i, others, setting)
        if known is None:
            undecided.append(i)
            del independent[i]
        elif known:
            kept = others
            independent[i] = 0
            circuits[i] = _needed(reduced, i, others, setting)
    redundant = sorted(circuits)
    groups = [
        (sum(reduced[i].equations for i in redundant), sorted({*redundant, *(j for c in circuits.values() for j in c)}))
    ]
    return [Redundancies(independent, redundant, groups if redundant else [], circuits, tuple(undecided))]


def _follows(reduced: Sequence[Reduced], i: int, others: Sequence[int], setting: Setting) -> bool | None:
    known = [through_reference(n, setting) for j in others for n in reduced[j].normals]
    return all_of(follows(through_reference(n, setting), known, setting) for n in reduced[i].normals)


def _needed(reduced: Sequence[Reduced], i: int, others: Sequence[int], setting: Setting) -> list[int]:
    """A minimal set of the others that is enough."""
    kept = list(others)
    for j in reversed(others):
        if _follows(reduced, i, [k for k in kept if k != j], setting):
            kept.remove(j)
    return kept


def _sharing(parts: Sequence[Rows]) -> list[list[Rows]]:
    """Blocks that share a constraint are looked at together."""
    graph: nx.Graph = nx.Graph()
    for k, part in enumerate(parts):
        graph.add_edges_from((("part", k), ("constraint", o)) for o in part.owners)
    components = nx.connected_components(graph)
    return [[parts[k] for kind, k in sorted(c) if kind == "part"] for c in components]


def copied(reduced: Sequence[Reduced], outcome: Outcome) -> list[Redundancies]:
    """What was written before is redundant."""
    return [
        Redundancies({i: 0}, [i], [(reduced[i].equations, sorted((i, j)))], {i: [j]}) for i, j in outcome.copies.items()
    ]


def merged(found: Sequence[Redundancies]) -> list[tuple[int, list[int]]]:
    """Groups that share a constraint are one."""
    graph: nx.Graph = nx.Graph()
    groups = [g for r in found for g in r.groups]
    for _, members in groups:
        nx.add_path(graph, members) if len(members) > 1 else graph.add_node(members[0])
    merged = []
    for component in nx.connected_components(graph):
        merged.append((sum(n for n, members in groups if members[0] in component), sorted(component)))
    return sorted(merged, key=lambda g: g[1])


def _void(reduced: Sequence[Reduced]) -> Redundancies:
    """Relations that hold always (0 = 0) are redundant by themselves."""
    independent, redundant, groups = {}, [], []
    for i, r in enumerate(reduced):
        empty = sum(normal.branches == ((),) for normal in r.normals)
        if not empty:
            continue
        independent[i] = 0
        groups.append((empty, [i]))
        if empty == r.equations:
            redundant.append(i)
    return Redundancies(independent, redundant, groups, {i: [] for i in redundant})


def _by_leaving_out(block: Block, setting: Setting, a: Answer, nullity: int) -> Redundancies:
    """What can go, the last in the order first, without changing the freedom of the block."""
    owners = list(dict.fromkeys(owners_of(block)))
    differential = {r.constraint for r in block.rows if not isinstance(r.piece, Finite)}
    integrated = {r.constraint for r in block.rows if _constant(r) is not None}
    order = sorted(owners, key=lambda o: (o in differential) + (o in integrated))
    kept = list(order)
    with limited(LEAVING_SECONDS):
        for owner in reversed(order):
            if len(kept) < 2:
                break
            check()
            fewer = [r for r in block.rows if r.constraint in kept and r.constraint != owner]
            if _same_freedom(block, fewer, setting, a):
                kept.remove(owner)
    redundant = sorted(set(order) - set(kept))
    members = sorted(order) if redundant else []
    groups = [(nullity, members)] if redundant else []
    independent = {o: 0 if o in redundant else owners_of(block).count(o) for o in order}
    if sum(independent.values()) != len(block.rows) - nullity:
        independent = {o: k for o, k in independent.items() if k < 2}
    return Redundancies(independent, redundant, groups, {o: sorted(kept) for o in redundant})


def owners_of(block: Block) -> list[int]:
    """The constraint that wrote each row."""
    return [r.constraint for r in block.rows]


def _same_freedom(block: Block, rows: Sequence[Row], setting: Setting, a: Answer) -> bool:
    gone = {_constant(r) for r in block.rows} - {_constant(r) for r in rows}
    blocks, untouched = split([c for c in block.coordinates if c not in gone], rows)
    answers = [answer(b, setting) for b in blocks]
    if any(x.dof is None or x.velocity_dof is None for x in answers):
        return False
    dof = len(untouched) + sum(x.dof or 0 for x in answers)
    velocity = len(untouched) + sum(x.velocity_dof or 0 for x in answers)
    needed = {g for g in a.hidden if gone.isdisjoint(str(s.args[1]) for s in g.symbols)}
    had_finite = {g for x in answers for g in x.hidden} >= needed
    return dof == a.dof and velocity == a.velocity_dof and had_finite


def _constant(row: Row) -> str | None:
    """The constant of integration C of a row dC = 0."""
    return next(iter(row.piece.coefficients)) if isinstance(row.piece, Still) else None


def _without_hidden(block: Block, a: Answer) -> list[SparseRow]:
    """The matrix without the rows of hidden relations."""
    first = len(block.finite)
    return a.matrix[:first] + a.matrix[first + len(a.hidden) :]
