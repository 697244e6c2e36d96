"""Finite against instantaneous freedom: the dimension of {g = 0} near one of its points, by the table of criteria."""

from __future__ import annotations

from flint import ctx

from dofkit.configuration.local.criteria import decision
from dofkit.configuration.local.germ import Germ
from dofkit.configuration.local.manifold import LocalDimension, Manifold
from dofkit.exact.points.balls import precision


def local_dimension(field: Manifold, ball: Manifold | None, rigid: int, time: int | None = None) -> LocalDimension:
    """The local dimension at the point; ``rigid`` is the dimension of the motions that move everything as one body.

    ``field`` is over GF(p), where a coefficient that is not 0 proves that the function is not; ``ball`` at the
    same point decides signs. ``time`` is the number of its column, if it is one. Raises ZeroDivisionError.
    """
    with ctx.workprec(max(ctx.prec, precision())):
        return decision(Germ(field, ball, rigid, time))[1]


def numeric_dimension(ball: Manifold, rigid: int, time: int | None = None) -> LocalDimension:
    """The same from an approximate point: where a tiny ball contains 0 it is taken for 0; the verdict is numeric."""
    return decision(Germ(None, ball, rigid, time))[1]
