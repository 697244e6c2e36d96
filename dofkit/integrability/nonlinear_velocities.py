"""Relations nonlinear in the velocities: velocity freedom, curvature of the set of velocities, and holonomy labels.

At a configuration the admissible velocities are a set C inside the solutions D of the linear relations. C is called
curved if its affine hull is D. Then C and D generate the same Lie algebra, which decides which relations are
integrable, and no nonlinear relation is equivalent to a linear one, because C would then lie in a smaller space.

Modulo the other relations, a relation f(q, qdot, t) = 0 may be equivalent to a linear form. With I^(inf) the largest
integrable subsystem, f is holonomic in the system iff it vanishes on every velocity (dt = 1) in the kernel of I^(inf)
at a generic configuration, which is the Lie algebra of the admissible velocities [HermannNagano]; for a linear f this
means that its form lies in I^(inf).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from flint import arb

from dofkit.base.deadline import OutOfTimeError
from dofkit.base.errors import NoValueError
from dofkit.base.verdicts import VERDICTS, weakest
from dofkit.configuration.local.manifold import Manifold
from dofkit.configuration.search import find
from dofkit.configuration.states import States, moves, rows_at, state_relations, value_at
from dofkit.configuration.variety import Variety, of_real_point
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import Pivots
from dofkit.exact.points.balls import BallPoint, RealPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import kernel, vanishes
from dofkit.exact.ring.program import Scalar, false_without_value, raising_no_value, values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.integrability.lie_algebra import Span, ball_span, span_at
from dofkit.integrability.pfaffian_system import Codistribution, codistribution
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block, Row, coordinates_of, joined
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Nonlinear, Pfaffian
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import RewrittenRow

#: Derivatives of curves are taken up to this order.
MAX_ORDER = 8
#: Random starts of the search for a real state whose ranks are those over GF(p).
SEEDS = 4

NO_VELOCITIES = "no velocities satisfying the constraints were found"
SINGULAR = "the velocities that satisfy the constraints form a singular set"
DIFFERENT_RANKS = (
    "real velocities and those over GF(p) disagree about the rank: the set of admissible velocities has "
    "several components"
)
HIDDEN = "the constraints that are nonlinear in the velocities imply an equation that could not be written explicitly"
AT_REFERENCE = (
    "at the reference configuration no regular admissible velocities were found, although they exist elsewhere"
)
COMPLEX = "real velocities are needed to decide the velocity freedom and whether the admissible velocities are curved"
KINKED = "velocities occur in absolute values, so that the admissible velocities may be one-sided"
FLAT = "the admissible velocities form linear subspaces, which were not written as linear forms"


def set_velocity_freedom(block: Block, setting: Setting, result: Answer) -> None:
    """Set in ``result`` the velocity freedom, n minus the rank of the Jacobian by the velocities at a generic state.

    Also set whether the set of velocities is curved, the witness and the verdict; all undecided, with a reason, where
    a test fails. Constraints that determine the direction of motion are integrable: freedom 0, all labels holonomic.
    """
    if not block.nonlinear or result.velocity_dof is None:
        return
    states = States(block.coordinates, block.rows, result.hidden, setting)
    if states.kinked or "balls" not in setting.engines:
        _undecided(result, KINKED if states.kinked else COMPLEX)
        return
    point = states.draw(7)
    real = _real(states, point, result)
    sample = point if point is not None else None if real is None or not real.certified else real.point
    if real is None or sample is None:
        _undecided(result, NO_VELOCITIES)
        return
    by_all, by_velocity, finite = states.ranks(sample)
    if not _moves_at_reference(block, setting, result, by_velocity):
        _undecided(result, AT_REFERENCE)
    elif not real.certain:
        _undecided(result, SINGULAR)
    elif states.ranks(real.point) != (by_all, by_velocity, finite):
        _undecided(result, DIFFERENT_RANKS)
    elif by_all - by_velocity != finite:
        _undecided(result, HIDDEN)
    elif not (curved := _are_curved(states, real.point)) and by_velocity < len(block.coordinates):
        _undecided(result, FLAT)
    else:
        result.curved, result.argument = curved, "states of motion" if curved else "line field"
        result.witness = of_real_point(states.places, real)
        result.velocity_dof = len(block.coordinates) - by_velocity
        full = ball_part(states.by_velocity(real.point, states.moving)).rank == len(block.rows)
        result.verdict = weakest(result.verdict, "numeric" if point is None else "proved" if full else "probable")
        if not curved:
            result.dof, result.about = 0, "component" if len(block.nonlinear) > 1 else result.about
            result.labels = dict.fromkeys(result.labels, HolonomyLabel(True, result.verdict, "line"))


def _rows_at_reference(block: Block, setting: Setting, result: Answer) -> tuple[Row, ...] | None:
    """Return the relations between velocities at the reference; None if it does not satisfy the geometric equations."""
    configuration = {**(setting.reference or {}), ex.TIME: ex.ZERO}
    relations = [e for kind in state_relations(block.rows, result.hidden) for e in kind]
    if any(not is_zero(substitute(g, configuration), setting.positive) for g in relations if not velocities_of(g)):
        return None
    return rows_at(relations, configuration)


@false_without_value
def _moves_at_reference(block: Block, setting: Setting, result: Answer, by_velocity: int) -> bool:
    """Return whether real velocities at the reference configuration have the generic rank ``by_velocity``.

    True if there is no reference or it is not on the set. Example: xdot^2 + ydot^2 = z zdot^2 can move only if z > 0.
    """
    if setting.reference is None:
        return True
    rows = _rows_at_reference(block, setting, result)
    if not rows:
        return rows is None
    states = States(block.coordinates, rows, (), replace(setting, reference=None))
    return any(states.ranks(point)[1] == by_velocity for point in states.certain(SEEDS))


def _real(states: States, point: FieldPoint | None, result: Answer) -> RealPoint | None:
    """Return a real state, if possible a certified one with the ranks of ``point``, the state over GF(p); or None.

    Where an unknown function occurs, also lower the verdict in ``result`` and add a reason.
    """
    calls = any(v.kind == "call" for v in states.ring.vars)
    ranks = None if point is None else states.ranks(point)
    best: RealPoint | None = None
    for seed in range(SEEDS):
        state = states.real(3 + seed)
        if state is None and not calls:
            break
        if state is not None and (best is None or not best.certified):
            best = state
        if state is not None and state.certified and ranks in (None, states.ranks(state.point)):
            best = state
            break
    if calls and best is not None:
        result.verdict = weakest(result.verdict, "probable")
        result.reasons.append("for an unknown function that allows real velocities")
    return best


def _undecided(result: Answer, why: str) -> None:
    """Set the freedoms, the verdict and all non-holonomic labels in ``result`` to undecided, and add the reason."""
    result.velocity_dof, result.dof, result.verdict = None, None, "undecided"
    result.consistent = result.consistent if why == FLAT else None
    result.reasons.append(why)
    # in a smaller space of velocities than D other constraints may become integrable, but none stops being so
    for i, label in result.labels.items():
        if label.holonomic is False:
            result.labels[i] = HolonomyLabel(None, "undecided", why)


@false_without_value
def _are_curved(states: States, point: BallPoint) -> bool:
    """Return whether the affine hull of the admissible velocities is the space D that the linear relations leave.

    Derivatives of curves of velocities are parallel to the hull; balls prove how many of them are independent.
    """
    rows = states.by_velocity(point, states.moving)
    dimension = len(states.velocities) - ball_part(rows[: len(states.linear)]).rank
    return ball_part(_derivatives(states, rows, point, dimension)).rank == dimension


@raising_no_value
def _derivatives(states: States, rows: list[list[arb]], point: BallPoint, dimension: int) -> list[list[arb]]:
    """Return tangents of the set of velocities at a state, and higher derivatives of curves in random directions.

    The curves are computed only if the tangents are fewer than ``dimension``.
    """
    part = ball_part(rows)
    columns = [-1 if c is None else c for c in states.velocities]
    frame = Pivots(
        tuple(part.rows), tuple(part.columns), tuple(c for c in range(len(columns)) if c not in set(part.columns))
    )
    free, zero = len(frame.free), arb(0)
    vectors: list[list[arb]] = kernel(rows, frame, zero)
    missing = dimension - free
    if not free or missing <= 0:
        return vectors
    manifold = Manifold(states.ring, states.moving, columns, frame, point)
    order = min(missing + 2, MAX_ORDER)
    for _ in range(min(free, missing) + 1):
        direction = [arb(point.rng.randrange(64, 512)) / 256 for _ in range(free)]
        path = manifold.line(direction, order).path
        vectors += [[s.coefficient(k) for s in path] for k in range(2, order)]
    return vectors


#: Random velocities of the Lie algebra used at a point, and the number of states at which a reduction is checked.
VECTORS, CHECKED = 3, 2

NOT_EQUIVALENT = (
    "a velocity was eliminated by dividing by a term that vanishes on the geometric equations: "
    "the remaining nonlinear constraint was not decided"
)
NO_VELOCITY = "no velocities were found at which it could be compared"


def blocks_of(slot: RewrittenRow, blocks: Sequence[Block]) -> list[int]:
    """Return the indices of the blocks that share a coordinate with a rewritten relation."""
    names = set(coordinates_of(slot.written.piece)).union(*(coordinates_of(r.piece) for r in slot.rows))
    return [k for k, block in enumerate(blocks) if names & set(block.coordinates)]


def _joint_block(slot: RewrittenRow, blocks: Sequence[Block], numbers: Sequence[int]) -> Block:
    """Return the blocks ``numbers`` joined into one, with the coordinates of the relation as written added."""
    names = dict.fromkeys(c for k in numbers for c in blocks[k].coordinates)
    names |= dict.fromkeys(sorted(coordinates_of(slot.written.piece)))
    return joined(names, [blocks[k] for k in numbers])


def with_reductions_checked(
    rewritten: Sequence[RewrittenRow], blocks: Sequence[Block], answers: Sequence[Answer], setting: Setting
) -> list[Answer]:
    """Return the answers, undecided for the blocks whose states do not satisfy a relation that was rewritten.

    Relations are rewritten more simply, such as (xdot - ydot)^2 = 0 as xdot = ydot; at states of the rewritten rows the
    relation as written must be 0. Blocks that are not consistent have no state, and are not checked.
    """
    checked = list(answers)
    for row in rewritten:
        numbers = blocks_of(row, blocks)
        if any(not checked[k].consistent for k in numbers) or _is_satisfied(row, blocks, numbers, checked, setting):
            continue
        for k in numbers:
            checked[k] = Answer(None, verdict="undecided", reasons=[*checked[k].reasons, NOT_EQUIVALENT])
    return checked


def _is_satisfied(
    slot: RewrittenRow, blocks: Sequence[Block], numbers: Sequence[int], answers: Sequence[Answer], setting: Setting
) -> bool:
    """Return whether the relation as written is 0 at states of its blocks, over GF(p) or else real; False without."""
    joint, f = _joint_block(slot, blocks, numbers), slot.written.piece
    if not isinstance(f, Nonlinear):
        return True
    hidden = [g for k in numbers for g in answers[k].hidden]
    try:
        states = States(joint.coordinates, joint.rows, hidden, setting, [f.expr])
        node = states.extra[f.expr]
        numbers_at = [value_at(states.ring, p, node) for k in range(CHECKED) if (p := states.draw(k + 1)) is not None]
        if not numbers_at or not all(v is not None and vanishes(v) for v in numbers_at):
            numbers_at = [value_at(states.ring, p, node) for p in states.certain(CHECKED)]
    except (OutOfTimeError, ArithmeticError):
        return False
    return bool(numbers_at) and all(v is not None and vanishes(v) for v in numbers_at)


def label_modulo_others(
    slot: RewrittenRow, blocks: Sequence[Block], answers: Sequence[Answer], setting: Setting
) -> tuple[HolonomyLabel, Answer]:
    """Return the label of a rewritten relation, and the combined answer of the blocks that share its coordinates."""
    numbers = blocks_of(slot, blocks)
    touched = [answers[k] for k in numbers]
    weak = max(touched, key=lambda a: VERDICTS.index(a.verdict), default=Answer(argument="nothing constrains"))
    together = Answer(verdict=weak.verdict, about=weak.about, argument=weak.argument, bits=weak.bits, gap=weak.gap)
    together.hidden, together.one_branch = [g for a in touched for g in a.hidden], any(a.one_branch for a in touched)
    f = slot.written.piece
    curved = all(answers[k].curved for k in numbers if blocks[k].nonlinear)
    impossible = any(a.consistent is False for a in answers)
    if not isinstance(f, Nonlinear) or not curved or impossible or any(a.dof is None for a in touched):
        return HolonomyLabel(None, "undecided"), together
    try:
        label = _on_the_kernel(f.expr, _joint_block(slot, blocks, numbers), together.hidden, setting)
    except (OutOfTimeError, ArithmeticError):
        return HolonomyLabel(None, "undecided"), together
    labels = [x for a in touched for x in a.labels.values()]
    if label.holonomic and all(x.holonomic for x in labels):
        label = replace(label, verdict=weakest(*(x.verdict for x in labels)))
    elif label.holonomic is False:
        label = replace(label, reason=_why_not_holonomic(slot, blocks, answers))
    return label, together


def _why_not_holonomic(slot: RewrittenRow, blocks: Sequence[Block], answers: Sequence[Answer]) -> str:
    """Return the reason, for the report, why a relation rewritten modulo others is not holonomic."""
    if not slot.rows:
        return (
            "It is implied by the other constraints, which are not integrable, and is not a consequence of "
            "geometric equations"
        )
    if not any(isinstance(row.piece, (Pfaffian, Nonlinear)) for row in slot.rows):
        return (
            "Together with the other constraints it restricts the configuration, but on its own it relates "
            "velocities, not positions"
        )
    rows = {id(row) for row in slot.rows}
    labels = [
        a.labels.get(i)
        for block, a in zip(blocks, answers, strict=True)
        for i, row in enumerate(r for r in block.rows if not isinstance(r.piece, Nonlinear))
        if id(row) in rows
    ]
    if all(x is not None and x.holonomic for x in labels):
        return (
            "It is integrable modulo the others, which are not integrable, and is not a consequence of geometric "
            "equations"
        )
    return "Together with the other constraints it is linear in the velocities, but not integrable"


def _on_the_kernel(f: Expr, joint: Block, hidden: Sequence[Expr], setting: Setting) -> HolonomyLabel:
    """Return the label of f: holonomic if it vanishes on the kernel of I^(inf) of the joint block."""
    forms = codistribution(joint, setting, hidden, [f])
    variety = find(forms.chart, setting.pose)
    ring = forms.chart.ring
    node = ring.node(f)
    sampled = [(p, s) for p in variety.samples if (s := span_at(forms, p)) is not None]
    numbers = [v for p, s in sampled for v in _values_on_span(forms, s.span, p, node)]
    if numbers and all(v == 0 for v in numbers):
        return HolonomyLabel(True, "probable")
    rank = len(sampled[0][1].frame.rows) if sampled else None
    if any(not v.contains(0) for v in _real_values(forms, variety, rank, node)):
        return HolonomyLabel(False, "proved")
    return HolonomyLabel(None, "undecided", NO_VELOCITY)


def _real_values(forms: Codistribution, variety: Variety, rank: int | None, node: int) -> Iterator[arb]:
    """Yield values of f at random velocities of the Lie algebra at a certified real point, if there is one."""
    real = variety.real
    if rank is None or real is None or not real.certain:
        return
    span = ball_span(forms, rank, real.point)
    if span is not None:
        yield from _values_on_span(forms, span[0], real.point, node)


def _values_on_span(forms: Codistribution, span: Span, point: FieldPoint | BallPoint, node: int) -> Iterator[Scalar]:
    """Yield values of a node at random velocities in the span, scaled to dt = 1 if time is a column."""
    symbols, zero = forms.chart.symbols, point.number(ex.ZERO.args[0])
    for _ in range(VECTORS):
        weights = [point.number(ex.num(point.rng.randrange(1, 1 << 12)).args[0]) for _ in span.vectors]
        vector = [sum((w * v[c] for w, v in zip(weights, span.vectors, strict=True)), zero)
                  for c in range(len(symbols))]  # fmt: skip
        if symbols[-1] == ex.TIME:
            if vanishes(vector[-1]):
                continue
            vector = [v / vector[-1] for v in vector[:-1]]
        moved = {ex.velocity(str(s.args[1])): v for s, v in zip(symbols, vector, strict=False)}
        try:
            yield values(forms.chart.ring, _moving(forms.chart.ring, point, moved), node + 1)[node]
        except NoValueError:
            continue


def _moving(ring: Ring, point: FieldPoint | BallPoint, moved: dict[Expr, Scalar]) -> FieldPoint | BallPoint:
    """Return the point with the velocities ``moved`` in place of its own."""
    if isinstance(point, BallPoint):
        return BallPoint({**point.symbols, **moved}, point.seed)
    other = point.copy()
    for var in ring.vars:
        if moves(ring, var.index):
            other.values.pop((var.kind, var.key), None)
    for s, value in moved.items():
        other.values["symbol", s] = value
    return other
