"""Relations that are nearly dependent at an exact drawing, as where positions were rounded.

A few digits lost make an exact rank full where the true one is not. Relations between twists have their rows scaled to
length 1, as for measured geometry, and their singular values are looked at for a gap. A body turns about the middle of
its points, its turn measured by how far they reach, so that a small body in a large scene is taken for no such thing.
"""

from __future__ import annotations

from itertools import pairwise
from math import ceil, floor, log10
from typing import Any

from dofkit.base.libraries import np
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
    j = np.zeros((len(rows), columns))
    for i, row in enumerate(rows):
        for c, v in row.items():
            j[i, c] = v
    by_size = _gap(_rows_of_length_1(j), rank)
    if by_size is None or _gap(_rows_of_length_1(_about_middles(j, placement, dimension)), rank) is None:
        return None
    small, large = by_size
    return (
        f"the equations are nearly dependent at the reference configuration (singular values of {small:.1e} "
        f"beside {large:.1e}): if "
        f"its positions are rounded or measured, `tolerance: {_rounded_up(max(small, 1e-12)):g}` states their accuracy"
    )


def _about_middles(j: Any, placement: Placement, dimension: int) -> Any:
    """Return the rows by velocities v' of the middles and w' = reach w: v = v' - w x (middle - start)."""
    j = j.copy()
    for member, points in _points(placement).values():
        first, start = member.column, member.start
        if first is None or start is None:
            continue
        middle = np.mean(points, axis=0)
        reach = max(float(np.max(np.linalg.norm(points - middle, axis=1))), 1e-9) if len(points) > 1 else 1.0
        arm = middle - np.array(start, dtype=float)
        v, turn = j[:, first : first + dimension], slice(first + dimension, first + dimension + TURNS[dimension])
        if dimension == 2:
            j[:, turn.start] = (j[:, turn.start] + arm[1] * v[:, 0] - arm[0] * v[:, 1]) / reach
        elif dimension == 3:
            j[:, turn] = (j[:, turn] - np.cross(arm, v)) / reach
    return j


def _points(placement: Placement) -> dict[int, tuple[Member, Any]]:
    """Return the places at which each member is held, by its first column."""
    held: dict[int, tuple[Member, list[Any]]] = {}
    for connection in placement.located:
        joined = ((member, at) for at in connection.places for member in connection.members)
        for member, at in (*connection.points, *joined):
            if member.column is not None:
                held.setdefault(member.column, (member, []))[1].append(at)
    return {column: (member, np.array(points, dtype=float)) for column, (member, points) in held.items()}


def _rows_of_length_1(j: Any) -> Any:
    norms = np.linalg.norm(j, axis=1, keepdims=True)
    return j / np.where(norms > 0, norms, 1.0)


def _gap(j: Any, rank: int) -> tuple[float, float] | None:
    """The largest of the singular values that are nearly 0, and the next above; None where there are none such."""
    singular = np.linalg.svd(j, compute_uv=False)[:rank]
    for above, below in pairwise(singular):
        if below < NEAR and above > GAP * below:
            return float(below), float(above)
    return None


def _rounded_up(value: float) -> float:
    """To one digit: 1, 2 or 5 times a power of ten.

    >>> _rounded_up(0.0031)
    0.005
    """
    power = 10.0 ** floor(log10(value))
    digit = next(d for d in (1, 2, 5, 10) if d >= ceil(value / power * (1 - 1e-9)))
    return digit * power
