"""Which constraints of a system can be dropped: by rank, over branches, by leaving out, and copies."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations

import networkx as nx

from dofkit.base.deadline import check, limited, unless_late
from dofkit.classification.dependence.circuits import OwnedRows, Redundancies, analyse, left_open
from dofkit.classification.dependence.implication import SLACK, follows
from dofkit.classification.freedom.block import answer
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.freedom.through_reference import algebraic, all_of, through_reference
from dofkit.exact.matrices.sparse import SparseRow
from dofkit.exact.ring.ring import Ring
from dofkit.exact.solving.ideals import complex_dimension
from dofkit.expressions import tree as ex
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, coordinates_of, split
from dofkit.relations.normal.normal_form import Finite, Inequality, Nonlinear, Normal, Still
from dofkit.relations.reduced import Reduced
from dofkit.relations.setting import Setting

#: Constraints of one set that are tried one by one, and seconds spent on leaving constraints out.
MAX_CHOICES, LEAVING_SECONDS = 40, 5.0
#: Functions of which a relation may say one branch only.
BRANCHES = ("abs", "exp", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh")


def redundancies(reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> list[Redundancies]:
    """Part by part, by the rank of the rows; where that does not measure dependence, by what follows from what.

    Where there is no time or no way to tell, the constraints concerned are left open.
    """
    found = [_void(reduced)]
    if not outcome.consistent:
        return found
    found += copied(reduced, outcome)
    for numbers in _parts(reduced, outcome):
        found += unless_late(partial(_of_part, reduced, setting, outcome, numbers), [left_open(numbers)])
    return found


def all_needed(found: Redundancies, reduced: Sequence[Reduced], outcome: Outcome) -> Redundancies:
    """With no equation too many, what was left open is needed, where every equation takes one freedom at most.

    One that says several things (a sum of squares), hidden relations or a singular set may hide that another follows.
    """
    several = any(len(b) > 1 for r in reduced for n in r.normals for b in n.branches)
    if several or any(a.hidden or a.degenerate for a in outcome.answers):
        return found
    needed = {i: reduced[i].equations for i in found.undecided}
    return replace(found, independent={**found.independent, **needed}, undecided=())


def _parts(reduced: Sequence[Reduced], outcome: Outcome) -> list[list[int]]:
    """The constraints in use, those together that share coordinates."""
    graph: nx.Graph = nx.Graph()
    for i, r in enumerate(reduced):
        pieces = [p for n in r.normals for p in n.pieces if not isinstance(p, Inequality)]
        if pieces and i not in outcome.copies:
            graph.add_node(i)
            graph.add_edges_from((i, c) for p in pieces for c in coordinates_of(p))
    return sorted(sorted(i for i in c if isinstance(i, int)) for c in nx.connected_components(graph))


def _of_part(
    reduced: Sequence[Reduced], setting: Setting, outcome: Outcome, numbers: Sequence[int]
) -> list[Redundancies]:
    own = set(numbers)
    blocks = [
        (block, a)
        for block, a in zip(outcome.blocks, outcome.answers, strict=True)
        if any(r.constraint in own for r in block.rows)
    ]
    normals = [n for i in numbers for n in reduced[i].normals]
    constants = any(reduced[i].constants for i in numbers)
    several = any(len(through_reference(n, setting).branches) > 1 for n in normals)
    bent = any(isinstance(p, Nonlinear) for n in normals for p in n.pieces)
    hidden = any(a.hidden for _, a in blocks) and len(numbers) <= MAX_CHOICES
    if several or ((bent or hidden) and not constants):
        if _each_takes_one(normals, blocks):
            every = {i: reduced[i].equations for i in numbers}
            return [Redundancies(every, [], [], {}, equations=dict.fromkeys(numbers, ()))]
        return [_implied(reduced, setting, numbers)]
    found: list[Redundancies] = []
    parts: list[OwnedRows] = []
    numbered = _numbered(reduced[i] for i in numbers)
    for block, a in blocks:
        if a.velocity_dof is None:
            continue
        nullity = len(block.rows) - (len(block.coordinates) - a.velocity_dof)
        owners = owners_of(block)
        finite = [isinstance(r.piece, Finite) for r in block.rows]
        matrix = _without_hidden(block, a)
        if nullity <= 0 and a.hidden and not a.degenerate:
            counted = {o: owners.count(o) for o in owners}
            found.append(Redundancies(counted, [], [], {}, equations=dict.fromkeys(owners, ())))
        elif a.degenerate and "balls" not in setting.engines:
            found.append(left_open(owners))
        elif a.degenerate or a.hidden or len(matrix) != len(block.rows):
            found.append(unless_late(partial(_by_leaving_out, block, setting, a, nullity), left_open(owners)))
        else:
            own_equations = [numbered.get(id(r.piece), -1) for r in block.rows]
            parts.append(OwnedRows(matrix, owners, finite, a.modulus, own_equations, a.supports))
    by_rank = [
        unless_late(partial(_analysed, group), left_open(o for part in group for o in part.owners))
        for group in _sharing(parts)
    ]
    everywhere = unless_late(partial(_everywhere, reduced, setting, numbers, by_rank), None)
    if everywhere:
        return found + by_rank
    if everywhere is False:
        return [*found, _implied(reduced, setting, numbers)]
    return [*found, *map(_at_a_point, by_rank)]


def _numbered(reduced: Iterable[Reduced]) -> dict[int, int]:
    """The number of the scalar equation that a piece is of, by the piece's identity."""
    return {id(p): k for r in reduced for k, n in enumerate(r.normals) for p in n.pieces}


def _each_takes_one(normals: Sequence[Normal], blocks: Sequence[tuple[Block, Answer]]) -> bool:
    """Is the freedom less by as many as there are equations, one row each? Then none follows from the others.

    What k equations leave has no part of which the freedom is less by more than k.
    """
    one = all(len(b) == 1 for n in normals for b in n.branches)
    plain = all(a.velocity_dof is not None and not a.hidden and not a.degenerate for _, a in blocks)
    taken = sum(len(block.coordinates) - (a.velocity_dof or 0) for block, a in blocks)
    return one and plain and taken == len(normals) == sum(len(block.rows) for block, _ in blocks)


def _at_a_point(r: Redundancies) -> Redundancies:
    """Redundant by rank at a point, and not known to be so elsewhere."""
    independent = {i: k for i, k in r.independent.items() if i not in r.redundant}
    return Redundancies(independent, [], [], {}, tuple(r.redundant))


def _everywhere(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], by_rank: Sequence[Redundancies]
) -> bool | None:
    """Does what is redundant by rank hold wherever the others do? False where a written equation does not.

    x^2 + y^2 = 1, x = 1, y = 0: the first two have one gradient at the solution, but without x = 1 there is x = -1.
    """
    dropped = {i for r in by_rank for i in r.redundant}
    if not dropped or setting.reference is not None or len(numbers) > MAX_CHOICES:
        return True
    plain = all(reduced[i].constraint.type in ("equation", "on") for i in numbers)
    pieces = [p for i in numbers for n in reduced[i].normals for p in n.pieces]
    if not plain or not all(isinstance(p, Finite) and algebraic(p.expr, *BRANCHES) for p in pieces):
        return True
    kept = [i for i in numbers if i not in dropped]
    told = all_of(_follows(reduced, i, kept, setting) for i in dropped)
    return None if told and any(_fails_on_a_part(reduced, i, kept, setting) for i in dropped) else told


def _fails_on_a_part(reduced: Sequence[Reduced], i: int, kept: Sequence[int], setting: Setting) -> bool:
    """Is there a complex point of the others where some relation is not 0? Drawn points may all lie on another part.

    There is one where s g = 1 has a solution [Rabinowitsch1929]. Two minors of a matrix imply the third, but not where
    the column that they share is 0.
    """
    known = [p.expr for j in kept for n in reduced[j].normals for p in n.pieces if isinstance(p, Finite)]
    for g in (p.expr for n in reduced[i].normals for p in n.pieces if isinstance(p, Finite)):
        relations = [*known, ex.coordinate(SLACK) * g - ex.ONE]
        ring = Ring(relations, setting.positive)
        nodes = [ring.node(e) for e in relations]
        symbols = {s for e in relations for s in e.symbols if s.args[0] != "parameter"}
        moving = [k for s in symbols if (k := ring.var_index(s)) is not None]
        whole = complex_dimension(ring, nodes, moving)
        if whole is not None and whole >= 0:
            return True
    return False


def _analysed(group: list[OwnedRows]) -> Redundancies:
    """One group's redundancies."""
    check()
    return analyse(group)


def _implied(reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int]) -> Redundancies:
    """By implication; left open where the constraints are too many or there is no time left for them."""
    if len(numbers) > MAX_CHOICES:
        return left_open(numbers)
    return unless_late(partial(_by_implication, reduced, setting, numbers), left_open(numbers))


def _by_implication(reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int]) -> Redundancies:
    """A constraint is redundant where it holds at every state of motion that the others leave, on all their branches.

    The last in the order goes first; where more can go together in its place, they do.
    """
    until = time.process_time() + LEAVING_SECONDS
    kept, unknown = list(numbers), list[int]()
    for i in reversed(numbers):
        told = None if time.process_time() > until else _follows(reduced, i, [j for j in kept if j != i], setting)
        if told:
            kept.remove(i)
        elif told is None:
            unknown.append(i)
    dropped = _more(reduced, setting, numbers, [i for i in numbers if i not in kept], until)
    kept = [i for i in numbers if i not in dropped]
    circuits = {i: _needed(reduced, reduced[i].normals, kept, setting) for i in dropped}
    groups = [(reduced[i].equations, sorted({i, *circuits[i]})) for i in dropped]
    undecided = [i for i in unknown if i in kept]
    independent, more = _equation_by_equation(reduced, setting, numbers, kept)
    known = {i: n for i, n in independent.items() if i not in undecided}
    return Redundancies(known, dropped, [*groups, *more], circuits, tuple(undecided))


def _equation_by_equation(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], kept: Sequence[int]
) -> tuple[dict[int, int], list[tuple[int, list[int]]]]:
    """(equations of each that are independent of all before it, groups of equations within what is kept).

    What is finite comes before what is differential.
    """
    order = sorted(numbers, key=lambda i: any(not isinstance(p, Finite) for n in reduced[i].normals for p in n.pieces))
    independent: dict[int, int] = {}
    groups: list[tuple[int, list[int]]] = []
    for k, i in enumerate(order):
        before = [j for j in order[:k] if j in kept]
        single = reduced[i].equations == 1
        known_not_to = single and i in kept and before == order[:k]
        said = [] if known_not_to else _said_before(reduced, i, order[:k], setting)
        independent[i] = reduced[i].equations - len(said)
        if i in kept and not single:
            said = said if before == order[:k] else _said_before(reduced, i, before, setting)
            groups += [(len(said), sorted({i, *_needed(reduced, said, before, setting)}))] if said else []
    return independent, groups


def _more(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], dropped: list[int], until: float
) -> list[int]:
    """More constraints that can go together than ``dropped``, where there are: x = 0 and y = 0 beside x^2 + y^2 = 0.

    Where every constraint is one row there are none (the exchange of bases).
    """
    rows = [b for i in numbers for n in reduced[i].normals for b in n.branches]
    if not dropped or (len(rows) == len(numbers) and all(len(b) == 1 for b in rows)):
        return dropped
    single = [i for i in numbers if _follows(reduced, i, [j for j in numbers if j != i], setting)]
    for choice in combinations(reversed(single), len(dropped) + 1):
        if time.process_time() > until:
            break
        kept = [j for j in numbers if j not in choice]
        if all(_follows(reduced, i, kept, setting) for i in choice):
            return _more(reduced, setting, numbers, sorted(choice), until)
    return dropped


def _said_before(reduced: Sequence[Reduced], i: int, before: Sequence[int], setting: Setting) -> list[Normal]:
    """The equations of a constraint that follow from those before it and from its own first ones."""
    known = [n for j in before for n in reduced[j].normals]
    said = []
    for n in reduced[i].normals:
        if follows(n, known, setting):
            said.append(n)
        else:
            known.append(n)
    return said


def _follows(reduced: Sequence[Reduced], i: int, others: Sequence[int], setting: Setting) -> bool | None:
    known = [n for j in others for n in reduced[j].normals]
    return all_of(follows(n, known, setting) for n in reduced[i].normals)


def _needed(
    reduced: Sequence[Reduced], normals: Sequence[Normal], others: Sequence[int], setting: Setting
) -> list[int]:
    """A minimal set of the others that some equations follow from."""
    kept = list(others)
    for j in reversed(others):
        fewer = [n for k in kept if k != j for n in reduced[k].normals]
        if all(follows(n, fewer, setting) for n in normals):
            kept.remove(j)
    return kept


def _sharing(parts: Sequence[OwnedRows]) -> list[list[OwnedRows]]:
    """Blocks that share a constraint are looked at together."""
    graph: nx.Graph = nx.Graph()
    for k, part in enumerate(parts):
        graph.add_edges_from((("part", k), ("constraint", o)) for o in part.owners)
    components = nx.connected_components(graph)
    return [[parts[k] for kind, k in sorted(c) if kind == "part"] for c in components]


def copied(reduced: Sequence[Reduced], outcome: Outcome) -> list[Redundancies]:
    """What was written before is redundant."""
    return [
        Redundancies(
            {i: 0},
            [i],
            [(reduced[i].equations, sorted((i, j)))],
            {i: [j]},
            equations={i: tuple(range(reduced[i].equations))},
        )
        for i, j in outcome.copies.items()
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
    equations = {}
    for i, r in enumerate(reduced):
        void = tuple(k for k, normal in enumerate(r.normals) if normal.branches == ((),))
        empty = len(void)
        if not empty:
            continue
        equations[i] = void
        independent[i] = 0
        groups.append((empty, [i]))
        if empty == r.equations:
            redundant.append(i)
    return Redundancies(independent, redundant, groups, {i: [] for i in redundant}, equations=equations)


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
    nullity = max(nullity, sum(owners_of(block).count(o) for o in redundant))
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
