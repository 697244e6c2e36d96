"""Shapes as lines and areas of the paper's plane: hulls, springs, bows."""

from __future__ import annotations

import math

import numpy as np

from dofkit.pictures.shapes import Array, Poses, Shape, Sketch
from dofkit.pictures.views import View

#: Turns of a coil, points of a bow, and of a circle.
TURNS, BOW, ROUND = 6, 17, 32


def outline(sketch: Sketch, shape: Shape, poses: Poses, view: View) -> Array:
    """The points of a shape as seen: to the right, up, and how near."""
    seen = np.array([view.seen(sketch.at(v, poses)) for v in shape.vertices])
    if shape.kind == "hull":
        return _rounded_hull(seen, shape.size)
    if shape.kind == "ball":
        return np.asarray(seen[0] + shape.size * _circle())
    if shape.kind == "coil":
        return _coil(seen[0], seen[1], shape.size)
    if shape.kind == "bow":
        return _bow(seen[0], seen[1], shape.size)
    return seen


def _circle() -> Array:
    angles = 2 * np.pi * np.arange(ROUND) / ROUND
    return np.column_stack([np.cos(angles), np.sin(angles), np.zeros(ROUND)])


def _rounded_hull(points: Array, pad: float) -> Array:
    """The convex hull of circles about the points."""
    flat = np.vstack([p + pad * _circle() for p in points])
    near = float(np.mean(points[:, 2]))
    hull = np.array(convex_hull(flat[:, :2]))
    return np.column_stack([hull, np.full(len(hull), near)])


def convex_hull(points: Array) -> list[tuple[float, float]]:
    """The corners of the convex hull, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted({(float(x), float(y)) for x, y in points})
    if len(ordered) < 3:
        return ordered

    def half(spots: list[tuple[float, float]]) -> list[tuple[float, float]]:
        found: list[tuple[float, float]] = []
        for p in spots:
            while len(found) > 1:
                (ax, ay), (bx, by) = found[-2:]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > 0:
                    break
                found.pop()
            found.append(p)
        return found[:-1]

    return half(ordered) + half(ordered[::-1])


def _across(first: Array, last: Array) -> tuple[Array, Array]:
    arm = last - first
    size = math.hypot(arm[0], arm[1])
    return arm, np.array([-arm[1], arm[0], 0.0]) / (size if size > 1e-12 else 1.0)


def _coil(first: Array, last: Array, wide: float) -> Array:
    """A zigzag between straight ends."""
    arm, side = _across(first, last)
    inner = [first + arm * (0.2 + 0.6 * (k + 0.5) / (2 * TURNS)) + side * wide * (-1) ** k for k in range(2 * TURNS)]
    return np.array([first, first + 0.2 * arm, *inner, first + 0.8 * arm, last])


def _bow(first: Array, last: Array, high: float) -> Array:
    """A half of an ellipse, as high as ``high`` of its length."""
    arm, side = _across(first, last)
    up = side * float(np.linalg.norm(arm)) * high * (1 if side[1] >= 0 else -1)
    angles = np.pi * np.arange(BOW) / (BOW - 1)
    return np.array([first + arm * (1 - np.cos(a)) / 2 + up * np.sin(a) for a in angles])
