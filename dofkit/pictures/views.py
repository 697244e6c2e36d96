"""From the world to the plane of the paper: a view along a direction, without perspective."""

from __future__ import annotations

import math
from itertools import combinations
from typing import NamedTuple

import numpy as np

from dofkit.pictures.shapes import Array, Sketch

#: Directions from which scenes of space are looked at: azimuth and elevation in degrees.
DIRECTIONS = ((-55.0, 24.0), (-35.0, 24.0), (-70.0, 20.0), (35.0, 24.0), (60.0, 20.0), (-50.0, 42.0), (-20.0, 30.0))
#: More points than this, and the usual direction is taken.
MOST_POINTS = 40


class View(NamedTuple):
    """A view; ``rows``: to the right, up, and towards who looks."""

    rows: Array
    azimuth: float
    elevation: float

    def seen(self, point: Array) -> Array:
        """To the right, up, and how near."""
        return np.asarray(self.rows @ point)


def view_from(azimuth: float, elevation: float) -> View:
    """The view from a direction, z upwards."""
    a, e = math.radians(azimuth), math.radians(elevation)
    right = np.array([-math.sin(a), math.cos(a), 0.0])
    near = np.array([math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)])
    return View(np.array([right, np.cross(near, right), near]), azimuth, elevation)


#: The plane, seen from above.
FLAT = View(np.eye(3), 0.0, 90.0)


def view_of(sketch: Sketch) -> View:
    """The view in which the points of a sketch are furthest apart."""
    if sketch.dimension < 3:
        return FLAT
    points = {tuple(np.round(sketch.at(v), 6)) for s in sketch.shapes if s.kind in ("ball", "hull") for v in s.vertices}
    points |= {tuple(np.round(sketch.at(s.vertices[0]), 6)) for s in sketch.shapes if s.role == "bar"}
    views = [view_from(*direction) for direction in DIRECTIONS]
    if not 1 < len(points) <= MOST_POINTS:
        return views[0]

    def spread(view: View) -> float:
        seen = [view.seen(np.array(p))[:2] for p in points]
        return min(float(np.linalg.norm(a - b)) for a, b in combinations(seen, 2))

    best = max(map(spread, views))
    return next(view for view in views if spread(view) > 0.8 * best - 1e-12)
