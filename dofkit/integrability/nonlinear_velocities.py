"""Relations nonlinear in the velocities: velocity freedom, and curvature of the set of velocities.

At a configuration the admissible velocities are a set C inside the solutions D of the linear relations. C is called
curved if its affine hull is D. Then C and D generate the same Lie algebra, which decides which relations are
integrable, and no nonlinear relation is equivalent to a linear one, because C would then lie in a smaller space.
"""

from __future__ import annotations

from dataclasses import replace

from flint import arb

from dofkit.base.verdicts import weakest
from dofkit.configuration.local.manifold import Manifold
from dofkit.configuration.states import States, rows_at, state_relations
from dofkit.configuration.variety import of_real_point
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import Pivots
from dofkit.exact.points.balls import BallPoint, RealPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import kernel
from dofkit.exact.ring.program import false_without_value, raising_no_value
from dofkit.exact.zero import is_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.setting import Setting

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


@false_without_value
def _moves_at_reference(block: Block, setting: Setting, result: Answer, by_velocity: int) -> bool:
    """Return whether real velocities at the reference configuration have the generic rank ``by_velocity``.

    True if there is no reference or it is not on the set. Example: xdot^2 + ydot^2 = z zdot^2 can move only if z > 0.
    """
    configuration = {**(setting.reference or {}), ex.TIME: ex.ZERO}
    relations = [e for kind in state_relations(block.rows, result.hidden) for e in kind]
    finite = (substitute(g, configuration) for g in relations if not velocities_of(g))
    if setting.reference is None or any(not is_zero(g, setting.positive) for g in finite):
        return True
    rows = rows_at(relations, configuration)
    states = States(block.coordinates, rows, (), replace(setting, reference=None))
    return bool(rows) and any(states.ranks(point)[1] == by_velocity for point in states.certain(SEEDS))


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
        result.reasons.append("an unknown function was chosen such that real velocities exist")
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
