"""Relations that others rewrite: whether they are still equivalent, and whether they are holonomic in the system.

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
from dofkit.configuration.search import find
from dofkit.configuration.states import States, moves, value_at
from dofkit.configuration.variety import Variety
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import vanishes
from dofkit.exact.ring.program import Scalar, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.integrability.lie_algebra import Span, ball_span, span_at
from dofkit.integrability.pfaffian_system import Codistribution, codistribution
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block, coordinates_of, joined
from dofkit.relations.normal.pieces import Nonlinear, Pfaffian
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import RewrittenRow

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
