"""Ranks over GF(p), and random points of the ambient space."""

from __future__ import annotations

from dofkit.exact.errors import NoValueError
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.ring.program import values
from dofkit.relations.chart import Chart


def free_point(chart: Chart, seed: int) -> FieldPoint | None:
    """A random point of the ambient space at which the program runs."""
    for attempt in range(60):
        point = field_point([chart.ring], 1000 * seed + attempt)
        try:
            values(chart.ring, point)
        except NoValueError:
            continue
        return point
    return None
