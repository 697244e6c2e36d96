"""Relations that are nearly dependent at an exact drawing, as where positions were rounded.

A few digits lost make an exact rank full where the true one is not. Relations between twists have their rows scaled to
length 1, as for measured geometry, and their singular values are looked at for a gap. A body turns about the middle of
its points, its turn measured by how far they reach, so that a small body in a large scene is taken for no such thing.
"""

from __future__ import annotations

from itertools import pairwise
from math import ceil, log10

from dofkit.exact.matrices.dense import length, plus, singular_values, unit_rows
from dofkit.exact.matrices.sparse import cross
from dofkit.mobility.placement import TURNS, Member, Placement, rows_of

#: More columns than this are not looked at.
MOST = 200
#: Nearly 0: below the first, and less by the second than what comes next.
NEAR, GAP = 2e-3, 100.0


def nearly_dependent(placement: Placement, dimension: int, columns: int, rank: int) -> str | None:
    """What to say of a near-dependence, with a `tolerance` to set; None where there is none, or too much to look at.

    ``placement`` in floating point, lengths in units of the scene's size; ``rank``: the exact one.
    """
    if not 1 < rank <= columns <= MOST:
        return None
    rows = []
    for connection in placement.located:
        conditions = rows_of(connection)
        if conditions is None:
            return None
        rows += conditions
    j = [[float(row.get(c, 0.0)) for c in range(columns)] for row in rows]
    by_size = _gap(j, rank)
    if by_size is None or _gap(_about_centroids(j, placement, dimension), rank) is None:
        return None
    small, large = by_size
    tolerance = 10.0 ** ceil(log10(max(small, 1e-12)))
    return (
        f"the equations are nearly dependent at the reference configuration (singular values of {small:.1e} "
        f"beside {large:.1e}): if "
        f"its positions are rounded or measured, `tolerance: {tolerance:g}` states their accuracy"
    )


def _about_centroids(j: list[list[float]], placement: Placement, dimension: int) -> list[list[float]]:
    """Return the rows by velocities v' of the centroids and w' = reach w: v = v' - w x (middle - start).

    So rows can be compared whatever the unit of length and wherever the origin.
    """
    j = [list(row) for row in j]
    for member, points in _points(placement).values():
        first, start = member.column, member.start
        if first is None or start is None:
            continue
        middle = [sum(places) / len(points) for places in zip(*points, strict=True)]
        reach = max(*(length(plus(at, -1.0, middle)) for at in points), 1e-9) if len(points) > 1 else 1.0
        arm = plus(middle, -1.0, list(map(float, start)))
        turn = slice(first + dimension, first + dimension + TURNS[dimension])
        for row in j:
            v, w = row[first : turn.start], row[turn]
            if dimension == 2:
                row[turn] = [(w[0] + arm[1] * v[0] - arm[0] * v[1]) / reach]
            elif dimension == 3:
                row[turn] = [a / reach for a in plus(w, -1.0, cross(arm, v))]
    return j


def _points(placement: Placement) -> dict[int, tuple[Member, list[list[float]]]]:
    """Return the places at which each member is held, by its first column."""
    held: dict[int, tuple[Member, list[list[float]]]] = {}
    for connection in placement.located:
        joined = ((member, at) for at in connection.places for member in connection.members)
        for member, at in (*connection.points, *joined):
            if member.column is not None:
                held.setdefault(member.column, (member, []))[1].append(list(map(float, at)))
    return held


def _gap(j: list[list[float]], rank: int) -> tuple[float, float] | None:
    """The largest of the singular values that are nearly 0, and the next above; None where there are none such."""
    for above, below in pairwise(singular_values(unit_rows(j))[:rank]):
        if below < NEAR and above > GAP * below:
            return below, above
    return None
