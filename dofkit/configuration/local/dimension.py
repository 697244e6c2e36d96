"""Finite against instantaneous freedom: the local dimension of {g = 0} at one of its points.

Let J be the Jacobian at P, of rank r, on n columns; T = ker J has dimension m = n - r. Where all rows are
independent the set is a manifold of dimension m (implicit function theorem). Else r independent relations
give a manifold M through P, and the others are functions on it without linear part: they are followed along
a random curve of M as power series. All zero, and zero at a distance too: the set is M, dimension m. Not zero, and

- m exceeds the dimension mu of the rigid motions of the whole by one: an analytic function of one variable has
  isolated zeros, so only the rigid motions are left: mu;
- else their lowest order decides where it can (`crossing`).

Where time is a column it is held against the set: if it is constant there, nothing moves through it (``confined``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flint import arb, ctx

from dofkit.configuration.local.degrees import degree as degree_of
from dofkit.configuration.local.manifold import LocalDimension, Manifold, is_zero
from dofkit.configuration.local.neighbourhood import holds_away
from dofkit.configuration.local.second_order import UNDECIDED, by_signs, decide
from dofkit.exact.errors import raising_no_value
from dofkit.exact.points.balls import precision
from dofkit.exact.ring.instructions import Scalar

#: Orders to which the other relations are followed; the second where one motion is in question.
ORDER, LONG_ORDER = 8, 16
#: Relations of this degree are not followed, over balls beyond the long order: their series may begin later.
LONGEST = 64
INDEPENDENT = "all relations are independent here (implicit function theorem)"
UNSEEN = {False: "and yet not at a distance", None: "which could not be followed to a distance"}
FLAT = "may be flat here to a higher order than is followed"
WHOLE = "nothing but motions of the whole is possible to first order"


@raising_no_value
def local_dimension(field: Manifold, ball: Manifold | None, rigid: int, time: int | None = None) -> LocalDimension:
    """The local dimension at the point; ``rigid`` is the dimension of the motions that move everything as one body.

    ``field`` is over GF(p), where a coefficient that is not 0 proves that the function is not; ``ball`` at the
    same point decides signs. ``time`` is the number of its column, if it is one.
    """
    with ctx.workprec(max(ctx.prec, precision())):
        return _local_dimension(field, ball, rigid, time)


def _local_dimension(field: Manifold, ball: Manifold | None, rigid: int, time: int | None) -> LocalDimension:
    m = field.dimension
    if not field.others:
        return _timed(field, LocalDimension(m, "proved", INDEPENDENT), time)
    if m == rigid:
        return LocalDimension(m, "proved", WHOLE, time is not None)
    degree = degree_of(field)
    if degree >= LONGEST:
        return LocalDimension(None, "undecided", f"a relation of degree {degree} {FLAT}")
    order = max(LONG_ORDER if m - rigid <= 1 else ORDER, degree + 1)
    along = field.follow([field.base.random() for _ in range(m)], order)
    if all(s.poly.degree() < 0 for s in along):
        seen = True if ball is None else holds_away(ball, _away(ball), True)
        if not seen:
            why = f"the dependent relations hold along a random curve to order {order - 1}, {UNSEEN[seen]}"
            return LocalDimension(None, "undecided", why)
        why = f"the dependent relations hold along a random curve to order {order - 1}: the motion is finite"
        return _timed(field, LocalDimension(m, "probable", why), time)
    if m - rigid == 1:
        first = min(k for s in along for k in range(order) if s.coefficient(k) != 0)
        why = f"the one motion left to first order breaks a relation at order {first}"
        return LocalDimension(rigid, "proved", why, time is not None)
    if time is None:
        return decide(field, ball, rigid)
    return _signs_in_time(ball, rigid, time)


@raising_no_value
def numeric_dimension(ball: Manifold, rigid: int, time: int | None = None) -> LocalDimension:
    """The same from an approximate point: where a tiny ball contains 0 it is taken for 0; the verdict is numeric."""
    m = ball.dimension
    if not ball.others:
        return _numeric(
            _timed(ball, LocalDimension(m, "numeric", "the relations kept are independent within the precision"), time)
        )
    if m == rigid:
        return LocalDimension(m, "numeric", WHOLE, time is not None)
    order = max(ORDER, degree_of(ball) + 1)
    if order > LONG_ORDER:
        return LocalDimension(None, "undecided", f"a relation {FLAT}")
    along = ball.follow(_random(ball), order)
    if all(s.coefficient(k).contains(0) for s in along for k in range(order)):
        seen = holds_away(ball, _away(ball), False)
        if not seen:
            return LocalDimension(
                None, "undecided", f"the dependent relations hold along a random curve, {UNSEEN[seen]}"
            )
        why = "the dependent relations hold along a random curve within the precision"
        return _numeric(_timed(ball, LocalDimension(m, "numeric", why), time))
    if m - rigid == 1:
        return LocalDimension(
            rigid, "numeric", "the one motion left to first order breaks a relation", time is not None
        )
    if time is not None:
        return _numeric(_signs_in_time(ball, rigid, time))
    return _numeric(by_signs(ball.quadratic_forms(), rigid) or UNDECIDED)


def _numeric(told: LocalDimension) -> LocalDimension:
    return replace(told, verdict="numeric" if told.dimension is not None else "undecided")


def _random(ball: Manifold) -> list[Scalar]:
    return [arb(ball.base.rng.randrange(64, 512)) / 256 for _ in range(ball.dimension)]


def _away(ball: Manifold) -> list[float]:
    return [ball.base.rng.choice((-1, 1)) * ball.base.rng.randrange(128, 256) / 256 for _ in range(ball.dimension)]


def _timed(manifold: Manifold, told: LocalDimension, time: int | None) -> LocalDimension:
    """``told`` of the whole manifold, with time held against a random curve of it."""
    if time is None or _moves(manifold, time, 2):
        return told
    if _moves(manifold, time, LONG_ORDER):
        return told
    verdict = "probable" if told.verdict == "proved" else told.verdict
    return replace(told, verdict=verdict, confined=True)


def _moves(manifold: Manifold, time: int, order: int) -> bool:
    """Does time change along a random curve, to the order?"""
    m = manifold.dimension
    exact = not isinstance(manifold.sample, arb)
    direction: Sequence[Scalar] = [manifold.base.random() for _ in range(m)] if exact else _random(manifold)
    path = manifold.line(direction, order).path[time]
    return any(not is_zero(path.coefficient(k)) for k in range(1, order))


def _signs_in_time(ball: Manifold | None, rigid: int, time: int) -> LocalDimension:
    """By the second order's signs: a definite form stops time; an indefinite one's cone is in no hyperplane dt = 0."""
    told = None if ball is None else by_signs(ball.quadratic_forms(), rigid)
    if ball is None or told is None:
        return UNDECIDED
    if told.dimension == rigid:
        return replace(told, confined=True)
    return told if _moves(ball, time, 2) else UNDECIDED
