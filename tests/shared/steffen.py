"""Steffen's flexible polyhedron: two crinkles of Bricard's octahedra on a tetrahedron, 9 corners and 21 edges.

P and R are 11 apart, S and T 12 from both and 17 from each other, and Q 10 from P and R: it turns about PR. Between Q
and S stands an octahedron of the first kind without the triangles at PR: its other two corners are 12, 10 and 5 from
Q, S and R or P, and 11 from each other; so between Q and T. Each is found from three distances.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

#: From their corners, the others' distances.
WIDE, MIDDLE, NARROW, ACROSS, TOP = 12.0, 10.0, 5.0, 11.0, 17.0


def polyhedron() -> list[str]:
    """The edges."""
    edges = ["PS", "RS", "PT", "RT", "PQ", "RQ", "ST"]
    for end, one, other in (("S", "A", "B"), ("T", "C", "D")):
        edges += [f"{one}{x}" for x in ("Q", end, "R", other)] + [f"{other}{x}" for x in ("Q", end, "P")]
    return edges


def flexes(turn: float) -> tuple[list[str], list[dict[str, tuple[float, ...]]]]:
    """The edges, and the places of the corners where Q has turned so far, in all ways that close."""
    half = ACROSS / 2
    arm, side = math.sqrt(MIDDLE**2 - half**2), math.sqrt(WIDE**2 - half**2)
    fixed = {"P": np.array([0, 0, half]), "R": np.array([0, 0, -half])}
    depth = math.sqrt(side**2 - (TOP / 2) ** 2)
    fixed |= {"S": np.array([TOP / 2, depth, 0]), "T": np.array([-TOP / 2, depth, 0])}
    fixed["Q"] = np.array([arm * math.sin(turn), arm * math.cos(turn), 0])
    ways = []
    for a, b in _crinkles(fixed, "S"):
        for c, d in _crinkles(fixed, "T"):
            places = {**fixed, "A": a, "B": b, "C": c, "D": d}
            ways.append({name: tuple(map(float, p)) for name, p in places.items()})
    return polyhedron(), ways


def _crinkles(at: dict[str, Any], end: str) -> list[tuple[Any, Any]]:
    """Both inner corners of a crinkle, in all ways in which they are `ACROSS` apart."""
    to_r = _meeting((at["Q"], WIDE), (at[end], MIDDLE), (at["R"], NARROW))
    to_p = _meeting((at["Q"], WIDE), (at[end], MIDDLE), (at["P"], NARROW))
    return [(a, b) for a in to_r for b in to_p if abs(float(np.linalg.norm(a - b)) - ACROSS) < 1e-9]


def _meeting(*spheres: tuple[Any, float]) -> list[Any]:
    """The points at given distances from three others."""
    (p, rp), (q, rq), (r, rr) = spheres
    d = float(np.linalg.norm(q - p))
    ex = (q - p) / d
    i = float(ex @ (r - p))
    ey = (r - p - i * ex) / float(np.linalg.norm(r - p - i * ex))
    j = float(ey @ (r - p))
    x = (rp**2 - rq**2 + d**2) / (2 * d)
    y = (rp**2 - rr**2 + i**2 + j**2 - 2 * i * x) / (2 * j)
    z = rp**2 - x**2 - y**2
    return [] if z < 0 else [p + x * ex + y * ey + s * math.sqrt(z) * np.cross(ex, ey) for s in (1, -1)]
