"""Projection to a page: views, outlines of shapes, marks in points, and wrapped lines of text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations, pairwise
from textwrap import wrap
from typing import Literal, NamedTuple

import numpy as np

from dofkit.pictures.shapes import Array, Ink, Poses, Shape, Sketch, circle

#: Directions from which spatial scenes are seen: azimuth and elevation in degrees.
DIRECTIONS = ((-55.0, 24.0), (-35.0, 24.0), (-70.0, 20.0), (35.0, 24.0), (60.0, 20.0), (-50.0, 42.0), (-20.0, 30.0))
#: The most points for which the best direction is searched.
MOST_POINTS = 40
#: Turns of a coil, points of a bow, and of a circle.
TURNS, BOW, ROUND = 6, 17, 32
#: A line through this many points is not smoothed.
ENOUGH = 40
#: A character's width and a line's height, by the size of the text.
WIDE, HIGH = 0.56, 1.25

Spot = tuple[float, float]


class Mark(NamedTuple):
    """A line or area through positions, or a text at one, in points with y upwards; ``owner``: what it shows."""

    positions: tuple[Spot, ...]
    ink: Ink
    closed: bool = False
    text: str = ""
    size: float = 9.0
    align: Literal["start", "middle", "end"] = "middle"
    bold: bool = False
    owner: str = ""


class Page(NamedTuple):
    """Marks on a sheet of a width and height in points, with its title and its description in words."""

    width: float
    height: float
    marks: tuple[Mark, ...]
    title: str
    alternative: str


def width_of(text: str, size: float) -> float:
    """Return the approximate width of a text."""
    return WIDE * size * max((len(line) for line in text.split("\n")), default=0)


def wrapped(text: str, size: float, width: float) -> list[str]:
    """Return a text as lines that fit into a width."""
    most = max(12, int(width / (WIDE * size * 0.92)))
    return wrap(" ".join(text.split()), most, break_long_words=False, break_on_hyphens=False)


# Views


class View(NamedTuple):
    """A view without perspective; ``rows``: to the right, up, and towards the viewer."""

    rows: Array
    azimuth: float
    elevation: float

    def seen(self, point: Array) -> Array:
        """Return the components of a point to the right, upwards and towards the viewer."""
        return np.asarray(self.rows @ point)


#: The plane, seen from above.
FLAT = View(np.eye(3), 0.0, 90.0)


def view_from(azimuth: float, elevation: float) -> View:
    """Return the view from a direction, z upwards."""
    a, e = math.radians(azimuth), math.radians(elevation)
    right = np.array([-math.sin(a), math.cos(a), 0.0])
    near = np.array([math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)])
    return View(np.array([right, np.cross(near, right), near]), azimuth, elevation)


def view_of(sketch: Sketch) -> View:
    """Return the view in which the least distance between points of a sketch is (nearly) largest."""
    if sketch.dimension < 3:
        return FLAT
    vertices = [v for s in sketch.shapes if s.kind in ("ball", "hull") for v in s.vertices]
    vertices += [s.vertices[0] for s in sketch.shapes if s.role == "bar"]
    points = {tuple(np.round(sketch.at(v), 6)) for v in vertices}
    views = [view_from(*direction) for direction in DIRECTIONS]
    if not 1 < len(points) <= MOST_POINTS:
        return views[0]

    def spread(view: View) -> float:
        seen = [view.seen(np.array(p))[:2] for p in points]
        return min(float(np.linalg.norm(a - b)) for a, b in combinations(seen, 2))

    best = max(map(spread, views))
    return next(view for view in views if spread(view) > 0.8 * best - 1e-12)


# Outlines


def outline(sketch: Sketch, shape: Shape, poses: Poses, view: View) -> Array:
    """Return the outline of a shape as rows (right, up, towards the viewer)."""
    seen = np.array([view.seen(sketch.at(v, poses)) for v in shape.vertices])
    match shape.kind:
        case "hull":
            flat = np.vstack([p + shape.size * circle(ROUND) for p in seen])
            hull = np.array(convex_hull(flat[:, :2]))
            return np.column_stack([hull, np.full(len(hull), float(np.mean(seen[:, 2])))])
        case "ball":
            return np.asarray(seen[0] + shape.size * circle(ROUND))
        case "coil":
            return _coil(seen[0], seen[1], shape.size)
        case "arrow":
            return _arrow(seen[0], seen[1], shape.size)
        case "bow":
            return _bow(seen[0], seen[1], shape.size)
        case "curve":
            return _smooth(seen)
    return seen


def convex_hull(points: Array) -> list[Spot]:
    """Return the corners of the convex hull, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted({(float(x), float(y)) for x, y in points})
    if len(ordered) < 3:
        return ordered

    def half(positions: Sequence[Spot]) -> list[Spot]:
        chain: list[Spot] = []
        for p in positions:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2:]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > 0:
                    break
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(ordered) + half(ordered[::-1])


def _across(first: Array, last: Array) -> tuple[Array, Array]:
    """Return (vector from one point to another, unit vector perpendicular to it on the paper)."""
    arm = last - first
    length = math.hypot(arm[0], arm[1])
    return arm, np.array([-arm[1], arm[0], 0.0]) / (length if length > 1e-12 else 1.0)


def _coil(first: Array, last: Array, wide: float) -> Array:
    """Return a zigzag between straight ends."""
    arm, side = _across(first, last)
    inner = [first + arm * (0.2 + 0.6 * (k + 0.5) / (2 * TURNS)) + side * wide * (-1) ** k for k in range(2 * TURNS)]
    return np.array([first, first + 0.2 * arm, *inner, first + 0.8 * arm, last])


def _arrow(first: Array, last: Array, head: float) -> Array:
    """Return a line with a head at its end, no longer than half of it."""
    arm, side = _across(first, last)
    length = math.hypot(arm[0], arm[1])
    back = arm * min(head / max(length, 1e-12), 0.5)
    barb = side * float(np.linalg.norm(back)) * 0.45
    return np.array([first, last, last - back + barb, last, last - back - barb])


def _smooth(points: Array) -> Array:
    """Return points of a smooth line through points: the spline of Catmull and Rom."""
    if not 2 < len(points) < ENOUGH:
        return points
    slopes = np.gradient(points, axis=0)
    if np.allclose(points[0], points[-1]):
        slopes[0] = slopes[-1] = (points[1] - points[-2]) / 2
    positions = []
    for (p, q), (u, v) in zip(pairwise(points), pairwise(slopes), strict=True):
        arm = q - p
        positions += [p + t * (u + t * (3 * arm - 2 * u - v + t * (u + v - 2 * arm))) for t in (0.0, 0.25, 0.5, 0.75)]
    return np.array([*positions, points[-1]])


def _bow(first: Array, last: Array, high: float) -> Array:
    """Return half an ellipse, as high as ``high`` of its length."""
    arm, side = _across(first, last)
    up = side * float(np.linalg.norm(arm)) * high * (1 if side[1] >= 0 else -1)
    angles = np.pi * np.arange(BOW) / (BOW - 1)
    return np.array([first + arm * (1 - np.cos(a)) / 2 + up * np.sin(a) for a in angles])
