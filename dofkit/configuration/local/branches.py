"""Branches of the set through a singular point, followed towards the point and confirmed in high precision."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any

from flint import arb

from dofkit.base.deadline import check
from dofkit.configuration.local.manifold import Form, Manifold
from dofkit.configuration.local.neighbourhood import FAULTS, SURE, Neighbourhood, independent
from dofkit.configuration.local.quadratic_cone import floats_of, scaled
from dofkit.exact.matrices.dense import (
    Matrix,
    Vector,
    damped,
    dot,
    largest,
    length,
    plus,
    singular_values,
    times,
    unit_rows,
)
from dofkit.exact.matrices.sparse import Pivots
from dofkit.exact.points.balls import BallPoint, jacobian
from dofkit.exact.ring.program import values
from dofkit.expressions.tree import Expr

#: Distances at which a branch must have points, number of random tangents, and iterations of each search.
DISTANCES, ATTEMPTS, ITERATIONS = (2.0**-3, 2.0**-7, 2.0**-11), 8, 60
#: Singular values up to `NOUGHT` count as 0, those above `SOME` as nonzero; between them nothing is decided.
NOUGHT, SOME = 1e-13, 1e-10
#: The order to which dependent relations are expanded on a branch, and the radius given to its point.
ORDER, RADIUS = 6, 2.0**-90


def largest_branch(ball: Manifold, forms: Sequence[Form], wanted: int) -> int | None:
    """Return the largest dimension of the branches found through the point, or None; ``wanted`` ends the search.

    A branch begins along a real zero of the second-order ``forms`` and is followed towards the point: at each distance
    a real point of the set is computed in high precision, the rank of all relations there is decided by a gap, and the
    dependent ones must vanish along a random curve.
    """
    try:
        here = Neighbourhood(ball)
        starts = _tangents(here, forms)
    except FAULTS:
        return None
    best = None
    for direction in starts:
        check()
        dimension = _dimension_along(here, direction)
        if dimension is not None and (best is None or dimension > best):
            best = dimension
        if best is not None and best >= wanted:
            return best
    return best


def _tangents(here: Neighbourhood, forms: Sequence[Form]) -> list[list[float]]:
    """Return unit tangent vectors of M at the point on which all forms are 0."""
    ball = here.ball
    _, j = here.floats([0.0] * len(here.place), ball.rows)
    scales = [ball.scales[c] for c in ball.frame.free]
    cut = [scaled(floats_of(f), scales) for f in forms]
    rng = random.Random(7)
    tangents = []
    for _ in range(ATTEMPTS):
        v = _null(cut, [rng.gauss(0.0, 1.0) for _ in range(ball.dimension)])
        if v is not None:
            free = [0.0] * len(here.place)
            for value, c in zip(v, ball.frame.free, strict=True):
                if c in here.number:
                    free[here.number[c]] = value
            tangents += unit_rows([here.onto_rows(j, free)])
    return tangents


def _null(forms: Sequence[Matrix], v: Vector) -> list[float] | None:
    """Return a unit vector near v on which all forms are 0, by damped steps orthogonal to v; None if none is near."""
    for _ in range(ITERATIONS):
        (v,) = unit_rows([v])
        slopes = [times(form, v) for form in forms]
        form_values = times(slopes, v)
        if largest(form_values) < 1e-13:
            return v
        v = plus(v, 1.0, damped([*([2 * s for s in slope] for slope in slopes), v], [*form_values, 0.0]))
    return unit_rows([v])[0] if largest([dot(times(form, v), v) for form in forms]) < 1e-10 else None


def _dimension_along(here: Neighbourhood, direction: Vector) -> int | None:
    """Return the dimension of the branch along a direction, if it is the same at all `DISTANCES`; else None."""
    dimension: int | None = None
    for distance in DISTANCES:
        try:
            u = _descend(here, [distance * v for v in direction])
            size = 0.0 if u is None else length(u)
            if u is None or not distance / 8 < size < distance * 8:
                return None
            dimension_here = _dimension_at(here, u)
        except FAULTS:
            return None
        if dimension_here is None or dimension not in (None, dimension_here):
            return None
        dimension, direction = dimension_here, [v / size for v in u]
    return dimension


def _descend(here: Neighbourhood, u: list[float]) -> list[float] | None:
    """Return a point of the set near ``u``, by damped steps; None if they do not converge."""
    for _ in range(ITERATIONS):
        check()
        f, j = here.floats(u, here.ball.nodes)
        if largest(f) < 1e-15:
            return u
        change = damped(j, f)
        u = plus(u, 1.0, change)
        if length(change) < 1e-14:
            return u
    return u if largest(here.floats(u, here.ball.nodes)[0]) < 1e-12 else None


def _dimension_at(here: Neighbourhood, u: Vector) -> int | None:
    """Return the dimension of the set near u; None if the rank there is unclear or a dependent relation is not 0."""
    ball = here.ball
    _, j = here.floats(u, ball.nodes)
    rows, columns = independent(j, SOME)
    moved = here.newton(here.exactly(u), [ball.nodes[r] for r in rows], columns)
    if moved is None or here.residual(moved, ball.nodes) > SURE:
        return None
    point = BallPoint(moved)
    at = values(here.ring, point)
    exact = jacobian(here.ring, at, point, ball.nodes, here.columns, arb(0))
    singular = singular_values([here.scaled(row, n) for n, row in zip(ball.nodes, exact, strict=True)])
    rank = sum(value > SOME for value in singular)
    if rank != len(rows) or (rank < len(singular) and singular[rank] > NOUGHT):
        return None
    return len(ball.columns) - rank if _stays(here, moved, rows, columns) else None


def _stays(here: Neighbourhood, moved: dict[Expr, arb], rows: Sequence[int], columns: Sequence[int]) -> bool:
    """Return whether the dependent equations are satisfied along a random curve through the point."""
    ball = here.ball
    columns_here = set(here.keys)
    point = BallPoint({s: arb(v, RADIUS) if s in columns_here else v for s, v in moved.items()})
    dependent = tuple(sorted(here.place[c] for c in columns))
    free = tuple(i for i in range(len(ball.columns)) if i not in set(dependent))
    there = Manifold(ball.ring, ball.nodes, ball.columns, Pivots(tuple(sorted(rows)), dependent, free), point)
    rng = random.Random(11)
    direction: list[Any] = [arb(rng.randrange(64, 512)) / 256 * ball.scales[c] for c in free]
    return all(s.coefficient(k).contains(0) for s in there.follow(direction, ORDER) for k in range(ORDER))
