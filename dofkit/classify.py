"""From a scene to its report: orders the passes; the only module that knows them all."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product as cartesian

import networkx as nx

from dofkit import expr as ex
from dofkit.analysis import Answer, Setting, alone, answer
from dofkit.blocks import Block, Row, coordinates_of, split, uses_time
from dofkit.branches import algebraic, follows, through_reference
from dofkit.choice import generalized
from dofkit.count import Facts, count
from dofkit.deadline import DEFAULT_SECONDS, OutOfTimeError, check, limited
from dofkit.entries import Told, entry
from dofkit.errors import Fault, SceneError, TextError
from dofkit.exact.field import NoPointError
from dofkit.expr import Expr
from dofkit.lowering import lower
from dofkit.normal import Finite, Inequality, Nonlinear, Normal, Pfaffian, normalise, without_instants
from dofkit.rank import bounded
from dofkit.redundancy import Redundancies, Rows, analyse
from dofkit.report import ConstraintEntry, ForceEntry, Redundancy, Report, Verdict, weakest
from dofkit.scene import Scene
from dofkit.system import Constraint, System
from dofkit.velocities import reduced as reduced_velocities
from dofkit.zeros import never_holds

#: Choices of branches that are looked at.
MAX_CHOICES = 16
#: Constraints of a conflict that are tried one by one for a minimal set, and the seconds spent on it.
MAX_CONFLICT, CONFLICT_SECONDS = 60, 5.0

#: Up to this many coordinates, those of one constraint are listed in the scene's order.
FEW = 2000

_BRANCH_WARNING = "'{name}' holds on several branches; the numbers are those of the largest"


@dataclass(frozen=True)
class Reduced:
    """A constraint with every relation reduced; ``inequalities`` apart."""

    constraint: Constraint
    normals: tuple[Normal, ...]
    inequalities: tuple[Inequality, ...]

    @property
    def equations(self) -> int:
        return len(self.normals)


@dataclass
class Outcome:
    """The blocks of one choice of branches and their answers."""

    rows: list[Row]
    blocks: list[Block]
    answers: list[Answer]
    untouched: list[str]
    impossible: list[int] = field(default_factory=list)
    first_order: int | None = None
    copies: dict[int, int] = field(default_factory=dict)

    @property
    def consistent(self) -> bool | None:
        if self.impossible or any(a.consistent is False for a in self.answers):
            return False
        return None if any(a.consistent is None for a in self.answers) else True

    @property
    def dof(self) -> int | None:
        return self._total([a.dof for a in self.answers])

    @property
    def velocity_dof(self) -> int | None:
        return self._total([a.velocity_dof for a in self.answers])

    def _total(self, parts: Sequence[int | None]) -> int | None:
        if not self.consistent or any(p is None for p in parts):
            return None
        return len(self.untouched) + sum(p for p in parts if p is not None)

    @property
    def size(self) -> tuple[int, int, int]:
        """What makes one choice of branches larger than another."""
        return (int(self.consistent is not False), -1 if self.dof is None else self.dof, self.velocity_dof or 0)


def classify(scene: Scene | System, budget: float | None = None) -> Report:
    """How the system of ``scene`` can move.

    ``budget``: seconds for the scene (60 where none is given); what is not finished then is undecided.
    Raises `SceneError` with every fault where the scene cannot be read as mathematics.
    """
    system = scene if isinstance(scene, System) else lower(scene)
    positive = frozenset(ex.parameter(p) for p, sign in system.parameters.items() if sign == "positive")
    positive |= frozenset(ex.parameter(p) for p in system.generic if p.startswith("_L"))
    reduced = reduce_all(system, positive)
    setting = Setting(
        positive,
        tuple(ex.parameter(p) for p in system.generic),
        system.pose,
        system.reference,
        system.coordinates,
        system.tolerance,
        system.size,
    )
    with limited(DEFAULT_SECONDS if budget is None else budget):
        outcome = solve(system, reduced, setting)
        return _report(system, reduced, setting, outcome)


def reduce_all(system: System, positive: frozenset[Expr]) -> list[Reduced]:
    """Every relation of every constraint as what it says; all that cannot be one are faults together."""
    found, faults = [], []
    for i, constraint in enumerate(system.constraints):
        normals, inequalities = [], []
        written = constraint.type in ("equation", "on")
        for relation in constraint.relations:
            if relation.sense != "=":
                inequalities.append(Inequality(relation.expr, relation.sense == ">"))
                continue
            try:
                normals.append(without_instants(normalise(relation.expr, positive, written)))
            except TextError as error:
                faults.append(Fault(f"'{constraint.name}': {error.message}", ("constraints", i), hint=error.hint))
        found.append(Reduced(constraint, tuple(normals), tuple(inequalities)))
    if faults:
        raise SceneError(tuple(faults), system.name)
    return found


def solve(system: System, reduced: Sequence[Reduced], setting: Setting) -> Outcome:
    """The largest of the branches, answered block by block."""
    normals = [(i, through_reference(normal, setting)) for i, r in enumerate(reduced) for normal in r.normals]
    options = [range(len(normal.branches)) or (None,) for _, normal in normals]
    positive = setting.positive
    never = [i for i, r in enumerate(reduced) if any(never_holds(q.expr, q.strict, positive) for q in r.inequalities)]
    copied = copies(reduced)
    best: Outcome | None = None
    cache: dict[tuple[int, ...], Answer] = {}
    for number, choice in enumerate(cartesian(*options)):
        if number == MAX_CHOICES:
            break
        rows, impossible = [], list(never)
        for (i, normal), branch in zip(normals, choice, strict=True):
            if branch is None:
                impossible.append(i)
            elif i not in copied:
                rows += [Row(i, p) for p in normal.branches[branch] if not isinstance(p, Inequality)]
        for way in reduced_velocities(rows, positive):
            outcome = _answered(system, way, impossible, setting, cache)
            if best is None or outcome.size > best.size:
                best = outcome
    if best is not None:
        best.copies = copied
    best = best or Outcome([], [], [], [c.name for c in system.coordinates])
    if setting.reference is not None and any(len(normal.branches) > 1 for _, normal in normals):
        best.first_order = _first_order(system, normals, setting)
    return best


def _first_order(system: System, normals: Sequence[tuple[int, Normal]], setting: Setting) -> int | None:
    """Velocities allowed to first order where branches cross: there the gradient of a product is 0."""
    rows = [
        Row(i, p) for i, n in normals if len(n.branches) == 1 for p in n.branches[0] if not isinstance(p, Inequality)
    ]
    blocks, untouched = split([c.name for c in system.coordinates], rows)
    parts = [_in_time(b, setting).instantaneous for b in blocks]
    return None if any(p is None for p in parts) else len(untouched) + sum(p for p in parts if p is not None)


def copies(reduced: Sequence[Reduced]) -> dict[int, int]:
    """Constraints all of whose relations an earlier one wrote already, up to a number: copy -> original."""
    seen: dict[tuple[object, ...], int] = {}
    found = {}
    for i, r in enumerate(reduced):
        if not r.normals or r.inequalities or any(normal.branches in ((), ((),)) for normal in r.normals):
            continue
        key = tuple(sorted(repr(_up_to_a_number(normal)) for normal in r.normals))
        if key in seen:
            found[i] = seen[key]
        else:
            seen[key] = i
    return found


def _up_to_a_number(normal: Normal) -> list[list[object]]:
    return [[_scaled(p) for p in branch] for branch in normal.branches]


def _scaled(piece: object) -> object:
    """A piece with the first coefficient made 1."""
    if isinstance(piece, Finite):
        first = piece.expr.args[0] if piece.expr.op == "add" else piece.expr
        number = first.args[0] if first.op == "mul" and first.args[0].op == "num" else first
        return ex.mul(piece.expr, ex.power(number, ex.MINUS_ONE)) if number.op == "num" else piece.expr
    return piece


def _answered(
    system: System,
    rows: list[Row],
    impossible: list[int],
    setting: Setting,
    cache: dict[tuple[int, ...], Answer],
) -> Outcome:
    blocks, untouched = split([c.name for c in system.coordinates], rows)
    answers = []
    for block in blocks:
        key = tuple(id(row.piece) for row in block.rows)
        known = cache.get(key)
        if known is None:
            known = cache[key] = _in_time(block, setting)
        answers.append(known)
    return Outcome(rows, blocks, answers, untouched, impossible)


def _in_time(block: Block, setting: Setting) -> Answer:
    """The block's answer; undecided where the time is used up."""
    try:
        check()
        return answer(block, setting)
    except OutOfTimeError as error:
        return Answer(None, verdict="undecided", reasons=[str(error)])
    except (ArithmeticError, NoPointError):
        return Answer(None, verdict="undecided", reasons=["an expression has no value at the points that were tried"])


# -- the report ------------------------------------------------------------------------------------------


def _report(system: System, reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> Report:
    names = [c.name for c in system.constraints]
    conflicting = _conflict(system, reduced, setting, outcome) if outcome.consistent is False else []
    redundancies = _redundancies(reduced, setting, outcome)
    entries = _entries(reduced, setting, outcome, redundancies, names)
    equations = sum(r.equations for r in reduced)
    dof, velocity_dof = outcome.dof, outcome.velocity_dof
    instantaneous = _instantaneous(system, outcome)
    verdict = weakest(*(e.verdict for e in entries), *(a.verdict for a in outcome.answers))
    if outcome.consistent is None:
        verdict = "undecided"
    told = count(
        system,
        Facts(
            sum(_finite_equations(r) for r in reduced),
            dof,
            outcome.consistent,
            sum(len(a.hidden) for a in outcome.answers),
            0,
            entries,
        ),
    )
    redundant_equations = None if velocity_dof is None else max(0, equations - (len(system.coordinates) - velocity_dof))
    if redundant_equations == 0:
        redundancies = [r for r in redundancies if r.redundant]
    return Report(
        scene=system.name,
        consistent=outcome.consistent,
        dof=dof,
        velocity_dof=velocity_dof,
        instantaneous_dof=instantaneous,
        singular=None if instantaneous is None or velocity_dof is None else instantaneous != velocity_dof,
        holonomic=_all([e.holonomic for e in entries]),
        scleronomic=_all([e.scleronomic for e in entries]),
        count=told,
        redundant_equations=redundant_equations,
        redundant=[names[i] for i in sorted({i for r in redundancies for i in r.redundant})],
        redundancies=[
            Redundancy(nullity=nullity, members=[names[i] for i in members])
            for nullity, members in _merged(redundancies)
        ],
        conflicting=[names[i] for i in conflicting],
        generalized_coordinates=_generalized(system, setting, outcome),
        growth_vector=_growth(outcome, entries),
        constraints=entries,
        forces=[ForceEntry(name=f.name, reason=f.reason) for f in system.forces],
        verdict=verdict,
        method="; ".join(dict.fromkeys(a.method for a in outcome.answers if a.method)) or "count",
        modelled=_modelled(system, outcome),
        warnings=_warnings(system, reduced, outcome),
    )


def _all(labels: Sequence[bool | None]) -> bool | None:
    """True where all are, False where one is not, else None."""
    if any(label is False for label in labels):
        return False
    return None if any(label is None for label in labels) else True


def _finite_equations(r: Reduced) -> int:
    return sum(all(isinstance(p, Finite) for p in normal.pieces) for normal in r.normals)


def _instantaneous(system: System, outcome: Outcome) -> int | None:
    if system.reference is None or outcome.consistent is not True:
        return None
    if outcome.first_order is not None:
        return outcome.first_order
    parts = [a.instantaneous for a in outcome.answers]
    if any(p is None for p in parts):
        return None
    return len(outcome.untouched) + sum(p for p in parts if p is not None)


def _redundancies(reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> list[Redundancies]:
    """Block by block, by the rank of the rows; where that does not measure dependence, by leaving constraints out."""
    found = [_void(reduced)]
    if not outcome.consistent:
        return found
    found += _copied(reduced, outcome)
    if any(len(through_reference(n, setting).branches) > 1 for r in reduced for n in r.normals):
        return found + _over_branches(reduced, setting, outcome)
    parts: list[Rows] = []
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        if not block.rows or a.velocity_dof is None:
            continue
        nullity = len(block.rows) - (len(block.coordinates) - a.velocity_dof)
        owners = [r.constraint for r in block.rows]
        finite = [isinstance(r.piece, Finite) for r in block.rows]
        matrix = _without_hidden(block, a)
        if nullity <= 0 and (a.degenerate or a.hidden):
            found.append(Redundancies({o: owners.count(o) for o in owners}, [], [], {}))
        elif a.degenerate or a.hidden or len(matrix) != len(block.rows):
            found.append(_by_leaving_out(block, setting, a, nullity))
        else:
            parts.append(Rows(matrix, owners, finite, a.modulus))
    by_rank = [r for group in _sharing(parts) for r in _analysed(group)]
    if _only_nearby(reduced, setting, outcome, by_rank):
        return found + _over_branches(reduced, setting, outcome)
    return found + by_rank


def _only_nearby(
    reduced: Sequence[Reduced], setting: Setting, outcome: Outcome, by_rank: Sequence[Redundancies]
) -> bool:
    """Is a written equation called redundant by its differential that does not hold wherever the others do?

    x^2 + y^2 = 1, x = 1, y = 0: the first two have one gradient at the solution, but without x = 1 there is x = -1.
    """
    dropped = {i for r in by_rank for i in r.redundant}
    written = [i for i, r in enumerate(reduced) if r.normals and i not in outcome.copies]
    if not dropped or setting.reference is not None or len(written) > MAX_CHOICES:
        return False
    plain = all(reduced[i].constraint.type in ("equation", "on") for i in written)
    pieces = [p for i in written for n in reduced[i].normals for p in n.pieces]
    if not plain or not all(isinstance(p, Finite) and algebraic(p.expr) for p in pieces):
        return False
    kept = [i for i in written if i not in dropped]
    return not all(_follows(reduced, i, kept, setting) for i in dropped)


def _analysed(group: list[Rows]) -> list[Redundancies]:
    """One group's redundancies; none where there is no time left for them."""
    try:
        check()
        for part in group:
            bounded(len(part.matrix), len(part.matrix[0]) if part.matrix else 0)
        return [analyse(group)]
    except OutOfTimeError:
        return []


def _over_branches(reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> list[Redundancies]:
    """With several branches a constraint is redundant where it holds on every branch of the others."""
    numbers = [i for i, r in enumerate(reduced) if r.normals and i not in outcome.copies]
    independent = {i: reduced[i].equations for i in numbers}
    if len(numbers) > MAX_CHOICES:
        return [Redundancies(independent, [], [], {})]
    kept, circuits = list(numbers), {}
    for i in reversed(numbers):
        others = [j for j in kept if j != i]
        if _follows(reduced, i, others, setting):
            kept = others
            independent[i] = 0
            circuits[i] = _needed(reduced, i, others, setting)
    redundant = sorted(circuits)
    groups = [
        (sum(reduced[i].equations for i in redundant), sorted({*redundant, *(j for c in circuits.values() for j in c)}))
    ]
    return [Redundancies(independent, redundant, groups if redundant else [], circuits)]


def _follows(reduced: Sequence[Reduced], i: int, others: Sequence[int], setting: Setting) -> bool:
    known = [through_reference(n, setting) for j in others for n in reduced[j].normals]
    return all(follows(through_reference(n, setting), known, setting) for n in reduced[i].normals)


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


def _copied(reduced: Sequence[Reduced], outcome: Outcome) -> list[Redundancies]:
    """What was written before is redundant."""
    return [
        Redundancies({i: 0}, [i], [(reduced[i].equations, sorted((i, j)))], {i: [j]}) for i, j in outcome.copies.items()
    ]


def _merged(found: Sequence[Redundancies]) -> list[tuple[int, list[int]]]:
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
    owners = list(dict.fromkeys(r.constraint for r in block.rows))
    differential = {r.constraint for r in block.rows if not isinstance(r.piece, Finite)}
    order = [o for o in owners if o not in differential] + [o for o in owners if o in differential]
    kept = list(order)
    until = time.monotonic() + CONFLICT_SECONDS
    for owner in reversed(order):
        if time.monotonic() > until or len(kept) < 2:
            break
        fewer = [r for r in block.rows if r.constraint in kept and r.constraint != owner]
        if _same_freedom(block, fewer, setting, a):
            kept.remove(owner)
    redundant = sorted(set(order) - set(kept))
    members = sorted(order) if redundant else []
    groups = [(nullity, members)] if redundant else []
    independent = {o: 0 if o in redundant else sum(r.constraint == o for r in block.rows) for o in order}
    return Redundancies(independent, redundant, groups, {o: sorted(kept) for o in redundant})


def _same_freedom(block: Block, rows: Sequence[Row], setting: Setting, a: Answer) -> bool:
    blocks, untouched = split(block.coordinates, rows)
    answers = [answer(b, setting) for b in blocks]
    if any(x.dof is None or x.velocity_dof is None for x in answers):
        return False
    dof = len(untouched) + sum(x.dof or 0 for x in answers)
    velocity = len(untouched) + sum(x.velocity_dof or 0 for x in answers)
    had_finite = {g for x in answers for g in x.hidden} >= set(a.hidden)
    return dof == a.dof and velocity == a.velocity_dof and had_finite


def _without_hidden(block: Block, a: Answer) -> list[list[int]]:
    """The matrix without the rows of hidden relations."""
    first = len(block.finite)
    return a.matrix[:first] + a.matrix[first + len(a.hidden) :]


def _entries(
    reduced: Sequence[Reduced], setting: Setting, outcome: Outcome, redundancies: list[Redundancies], names: list[str]
) -> list[ConstraintEntry]:
    independent: dict[int, int] = {}
    for found in redundancies:
        for i, k in found.independent.items():
            independent[i] = independent.get(i, 0) + k
    circuits = {i: c for found in redundancies for i, c in found.circuits.items()}
    told: dict[int, list[Told]] = {i: [] for i in range(len(reduced))}
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        linear = [r for r in block.rows if not isinstance(r.piece, Nonlinear)]
        for i, row in enumerate(linear):
            told[row.constraint].append(Told(row, a.labels.get(i), a))
        for row in block.rows:
            if isinstance(row.piece, Nonlinear):
                told[row.constraint].append(Told(row, None, a))
    for i, original in outcome.copies.items():
        told[i] = [Told(Row(i, t.row.piece), t.label, t.answer) for t in told[original]]
    entries = []
    for i, r in enumerate(reduced):
        own = [t.row for t in told[i]]
        by_itself = None
        written = [Row(i, p) for normal in r.normals for p in normal.pieces if not isinstance(p, Inequality)]
        if any(isinstance(row.piece, Nonlinear) for row in written):
            by_itself = _curved(told[i]) or _alone_in_time(written, setting)
        elif any(isinstance(row.piece, Pfaffian) for row in own):
            by_itself = _inherited(told[i]) or _alone_in_time(own, setting)
        circuit = circuits.get(i)
        entries.append(
            entry(
                r.constraint,
                r.normals,
                r.inequalities,
                told[i],
                by_itself,
                setting.positive,
                independent.get(i, 0 if not told[i] else None),
                None if circuit is None else [names[j] for j in circuit],
                outcome.consistent,
            )
        )
    return entries


def _curved(told: Sequence[Told]) -> Answer | None:
    """Velocities that bend under the other constraints bend without them."""
    return next((t.answer for t in told if isinstance(t.row.piece, Nonlinear) and t.answer.curved), None)


def _alone_in_time(own: Sequence[Row], setting: Setting) -> Answer:
    mentioned = {name for row in own for name in coordinates_of(row.piece)}
    coordinates = (
        [c.name for c in setting.roles if c.name in mentioned] if len(setting.roles) < FEW else sorted(mentioned)
    )
    try:
        check()
        return alone(own, setting, coordinates)
    except (OutOfTimeError, ArithmeticError, NoPointError):
        return Answer(None, verdict="undecided")


def _inherited(told: Sequence[Told]) -> Answer | None:
    """A single form that is non-holonomic in the system is so alone: what integrates alone integrates in any system."""
    if len(told) != 1 or told[0].label is None or told[0].label.holonomic is not False:
        return None
    return Answer(labels={0: told[0].label})


def _generalized(system: System, setting: Setting, outcome: Outcome) -> list[str] | None:
    """An independent choice of ``dof`` coordinates: those that are not pivots of what integrates."""
    if outcome.dof is None:
        return None
    chosen = set(outcome.untouched)
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        own = generalized(block, a, setting, system.rotations)
        if own is None:
            return None
        chosen |= set(own)
    return [c.name for c in system.coordinates if c.name in chosen]


def _growth(outcome: Outcome, entries: Sequence[ConstraintEntry]) -> list[int] | None:
    """Dimensions of D, D + [D, D], ... for the whole: blocks do not bracket with each other; they share only time."""
    if not outcome.consistent or not any(b.forms for b in outcome.blocks):
        return None
    growths: list[tuple[int, ...]] = []
    timed = timeless = 0
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        shared = uses_time(block)
        timed += shared
        owners = {r.constraint for r in block.rows}
        timeless += shared and all(entries[i].scleronomic and entries[i].catastatic is not False for i in owners)
        if block.nonlinear or (a.growth is None and block.forms) or a.velocity_dof is None:
            return None
        growths.append(a.growth if a.growth is not None else (a.velocity_dof + shared,))
    length = max(len(g) for g in growths)
    base = len(outcome.untouched) - (timed if timed == timeless else max(0, timed - 1))
    return [base + sum(g[min(k, len(g) - 1)] for g in growths) for k in range(length)]


def _modelled(system: System, outcome: Outcome) -> str:
    parts = []
    touched = len(system.coordinates) - len(outcome.untouched)
    if outcome.blocks:
        many = len(outcome.blocks)
        parts.append(f"{touched} coordinates in {many} independent part{'s' if many > 1 else ''}")
    if outcome.untouched:
        shown = ", ".join(outcome.untouched[:12]) + (", ..." if len(outcome.untouched) > 12 else "")
        parts.append(f"counted but not computed with, because nothing constrains them: {shown}")
    finite = sum(not b.forms and not b.nonlinear for b in outcome.blocks)
    if finite:
        parts.append("no integrability test where all relations are finite (d(dg) = 0)")
    if system.forces:
        parts.append("forces are left out: they do not constrain")
    return "; ".join(parts) or "nothing constrains anything"


def _warnings(system: System, reduced: Sequence[Reduced], outcome: Outcome) -> list[str]:
    found = list(system.warnings)
    for r in reduced:
        for normal in r.normals:
            found += [f"'{r.constraint.name}': {note}" for note in normal.notes]
            if len(normal.branches) > 1:
                found.append(_BRANCH_WARNING.format(name=r.constraint.name))
        found += [f"'{r.constraint.name}': {note}" for note in r.constraint.notes]
    for a in outcome.answers:
        found += a.reasons
        found += [f"hidden finite relation: {shown(g)} = 0" for g in a.hidden]
    return list(dict.fromkeys(found))


def shown(e: Expr) -> str:
    """An expression as text."""
    from dofkit.text import to_text

    return to_text(e)


# -- conflicts -------------------------------------------------------------------------------------------


def _conflict(system: System, reduced: Sequence[Reduced], setting: Setting, outcome: Outcome) -> list[int]:
    """A minimal set of constraints that cannot hold together: leaving one out at a time, the last written first."""
    if outcome.impossible:
        return [outcome.impossible[0]]
    guilty = next(b for b, a in zip(outcome.blocks, outcome.answers, strict=True) if a.consistent is False)
    kept = sorted({row.constraint for row in guilty.rows})
    if not _inconsistent(system, reduced, setting, kept):
        kept = [i for i, r in enumerate(reduced) if r.normals]
    if len(kept) > MAX_CONFLICT:
        return kept
    until = time.monotonic() + CONFLICT_SECONDS
    for i in reversed(list(kept)):
        if time.monotonic() > until:
            break
        fewer = [j for j in kept if j != i]
        if fewer and _inconsistent(system, reduced, setting, fewer):
            kept = fewer
    return kept


def _inconsistent(system: System, reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int]) -> bool:
    some = [r if i in set(numbers) else Reduced(r.constraint, (), ()) for i, r in enumerate(reduced)]
    return solve(system, some, setting).consistent is False


__all__ = ["Verdict", "classify"]
