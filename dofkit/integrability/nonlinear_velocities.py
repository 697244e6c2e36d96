"""Relations nonlinear in the velocities: the velocity freedom, and whether the allowed velocities bend.

At a configuration the allowed velocities are a set C inside the solutions D of the linear relations. What they
generate by brackets is what the smallest affine space around C generates: where that is all of D, the Lie algebra of D
tells what integrates, and no relation in use is linear in disguise, because C would then lie in less.
"""

from __future__ import annotations

from dataclasses import replace

from flint import arb

from dofkit.base.errors import NoValueError
from dofkit.base.verdicts import weakest
from dofkit.configuration.local.manifold import Manifold
from dofkit.configuration.states import States, rows_at, state_relations
from dofkit.exact.errors import raising_no_value
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import Pivots, certified_rank, kernel
from dofkit.exact.points.real_search import RealPoint
from dofkit.exact.zero import is_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block, Row
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.setting import Setting

#: Derivatives of curves are taken up to this order.
MAX_ORDER = 8
#: Real states that are looked for, until one agrees with that over GF(p).
SEEDS = 4

NO_VELOCITIES = "no velocities satisfying the constraints were found"
SINGULAR = "the velocities that satisfy the constraints form a singular set"
PARTS = (
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
    """The velocity freedom: a Jacobian's rank by the velocities, at states of motion."""
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
    whole, moving, finite = states.ranks(sample)
    if not _moves_at_reference(block, setting, result, moving):
        _undecided(result, AT_REFERENCE)
    elif not real.certified or not real.consistent:
        _undecided(result, SINGULAR)
    elif states.ranks(real.point) != (whole, moving, finite):
        _undecided(result, PARTS)
    elif whole - moving != finite:
        _undecided(result, HIDDEN)
    elif not _bends(states, real.point):
        _undecided(result, FLAT)
    else:
        result.curved, result.argument = True, "states of motion"
        result.velocity_dof = len(block.coordinates) - moving
        full = certified_rank(states.by_velocity(real.point, states.moving)) == len(block.rows)
        result.verdict = weakest(result.verdict, "numeric" if point is None else "proved" if full else "probable")


def first_order_beside_bends(block: Block, setting: Setting, result: Answer) -> tuple[int | None, bool]:
    """The velocities that the constraints allow at the reference, and whether that is proved.

    Regular ones were found there, and one relation that bends holds nowhere on all that the linear ones leave.
    """
    regular = result.curved and len(block.nonlinear) == 1 and not result.hidden
    if not regular or _rows_at_reference(block, setting, result) is None:
        return None, False
    return result.velocity_dof, result.verdict == "proved"


def _rows_at_reference(block: Block, setting: Setting, result: Answer) -> tuple[Row, ...] | None:
    """What the relations say of velocities at the reference; None where that is not on the set now.

    Raises NoValueError.
    """
    known = {**(setting.reference or {}), ex.TIME: ex.ZERO}
    relations = [e for kind in state_relations(block.rows, result.hidden) for e in kind]
    if any(not is_zero(substitute(g, known), setting.positive) for g in relations if not velocities_of(g)):
        return None
    return rows_at(relations, known)


def _moves_at_reference(block: Block, setting: Setting, result: Answer, moving: int) -> bool:
    """Are there real velocities at the reference, regular as those are elsewhere? True where none is given or is met.

    xdot^2 + ydot^2 = z zdot^2 has them where z > 0, and leaves all at rest where z < 0.
    """
    if setting.reference is None:
        return True
    try:
        rows = _rows_at_reference(block, setting, result)
        if not rows:
            return rows is None
        there = States(block.coordinates, rows, (), replace(setting, reference=None))
    except NoValueError:
        return False
    return any(there.ranks(point)[1] == moving for point in there.certain(SEEDS))


def _real(states: States, point: FieldPoint | None, result: Answer) -> RealPoint | None:
    """A real state, on the same part of the set as the one over GF(p) where one is found.

    Unknown functions may be chosen so that there is one.
    """
    calls = any(v.kind == "call" for v in states.ring.vars)
    ranks = None if point is None else states.ranks(point)
    best: RealPoint | None = None
    for seed in range(SEEDS):
        found = states.real(3 + seed)
        if found is None and not calls:
            break
        if found is not None and (best is None or not best.certified):
            best = found
        if found is not None and found.certified and ranks in (None, states.ranks(found.point)):
            best = found
            break
    if calls and best is not None:
        result.verdict = weakest(result.verdict, "probable")
        result.reasons.append("for an unknown function that allows real velocities")
    return best


def _undecided(result: Answer, why: str) -> None:
    """Nothing is known of the freedom; of the constraints, only that real velocities satisfy them where they do."""
    result.velocity_dof, result.dof, result.verdict = None, None, "undecided"
    result.consistent = result.consistent if why == FLAT else None
    result.reasons.append(why)
    _open_labels(result, why)


def _open_labels(result: Answer, why: str) -> None:
    """Allowed velocities that may lie in less than the linear relations leave may make more integrable, never less."""
    for i, label in result.labels.items():
        if label.holonomic is False:
            result.labels[i] = HolonomyLabel(None, "undecided", why)


def _bends(states: States, point: BallPoint) -> bool:
    """Does no affine space hold the allowed velocities but the one that the linear relations cut out?

    The derivatives of curves through a velocity lie in the smallest affine space around them; balls prove how many are
    independent.
    """
    try:
        rows = states.by_velocity(point, states.moving)
        wanted = len(states.velocities) - certified_rank(rows[: len(states.linear)])
        return certified_rank(_derivatives(states, rows, point, wanted)) == wanted
    except NoValueError:
        return False


@raising_no_value
def _derivatives(states: States, rows: list[list[arb]], point: BallPoint, wanted: int) -> list[list[arb]]:
    """Tangents, and higher derivatives of curves in random directions, at the allowed velocity of a state."""
    part = ball_part(rows)
    columns = [-1 if c is None else c for c in states.velocities]
    frame = Pivots(
        tuple(part.rows), tuple(part.columns), tuple(c for c in range(len(columns)) if c not in set(part.columns))
    )
    free, zero = len(frame.free), arb(0)
    found: list[list[arb]] = kernel(rows, frame, zero)
    missing = wanted - free
    if not free or missing <= 0:
        return found
    manifold = Manifold(states.ring, states.moving, columns, frame, point)
    order = min(missing + 2, MAX_ORDER)
    for _ in range(min(free, missing) + 1):
        direction = [arb(point.rng.randrange(64, 512)) / 256 for _ in range(free)]
        path = manifold.line(direction, order).path
        found += [[s.coefficient(k) for s in path] for k in range(2, order)]
    return found
