"""Recognition of an upright rolling disc or a knife edge from constraints on two positions and a heading."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import product

import numpy as np

from dofkit.expressions.tree import PI, ZERO, coordinate, num
from dofkit.pictures.arrangement import velocity_rows
from dofkit.pictures.evaluation import kernel
from dofkit.pictures.shapes import Array
from dofkit.scene.picture import PlacedPicture, PlacedShape
from dofkit.system import System

#: The number of random configurations at which constraints are examined, and the difference that counts as 0.
SAMPLES, SAME = 5, 1e-6


def recognised(system: System) -> PlacedPicture | None:
    """Return the picture of a disc or blade at (x, y) if all admissible directions move it along a heading, or None."""
    names = [c.name for c in system.coordinates]
    if not {"x", "y"} <= set(names) or len(names) < 3:
        return None
    samples = _samples(system, names)
    headings = product([n for n in names if n not in ("x", "y")], (1, -1), (0, 1))
    heading = next((h for h in headings if _fits(samples, names, h)), None)
    if heading is None:
        return None
    name, sign, quarter = heading
    angle = num(sign) * coordinate(name) + num(Fraction(quarter, 2)) * PI
    x, y = coordinate("x"), coordinate("y")
    for turning in names:
        radius = _radius(samples, names, heading, turning)
        if radius:
            size, turn = num(Fraction(abs(radius)).limit_denominator(10**6)), num(1 if radius > 0 else -1)
            disc = PlacedShape("disc", "", ((x, y, size),), None, angle, turn * coordinate(turning), size, (), ())
            floor = PlacedShape("plane", "", ((ZERO, ZERO, ZERO),), None, None, None, None, (num(6) * size,), ())
            contact = PlacedShape("point", "", ((x, y, ZERO),), None, None, None, None, (), ())
            return PlacedPicture((floor, disc, contact), 3, frozenset())
    blade = PlacedShape("blade", "", ((x, y),), None, angle, None, None, (), ())
    return PlacedPicture((blade,), 2, frozenset())


def _samples(system: System, names: list[str]) -> list[tuple[Array, Array]]:
    """Return (random configuration, basis of the admissible directions there) several times."""
    random = np.random.default_rng(5)
    samples = []
    for _ in range(SAMPLES):
        q = random.uniform(-1.5, 1.5, len(names))
        rows, _ = velocity_rows(system, dict(zip(map(coordinate, names), map(float, q), strict=True)))
        samples.append((q, kernel(rows[:, : len(names)], len(names))))
    return samples


def _along(q: Array, basis: Array, names: list[str], heading: tuple[str, int, int]) -> tuple[Array, Array]:
    """Return (along, across): the velocity of (x, y) relative to a heading, for each admissible direction."""
    name, sign, quarter = heading
    angle = sign * q[names.index(name)] + quarter * math.pi / 2
    x, y = basis[:, names.index("x")], basis[:, names.index("y")]
    return x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle)


def _fits(samples: list[tuple[Array, Array]], names: list[str], heading: tuple[str, int, int]) -> bool:
    """Return whether (x, y) moves, and only along the heading."""
    pairs = [_along(q, basis, names, heading) for q, basis in samples]
    return all(
        float(np.max(np.abs(along), initial=0.0)) > SAME > float(np.max(np.abs(across), initial=0.0))
        for along, across in pairs
    )


def _radius(samples: list[tuple[Array, Array]], names: list[str], heading: tuple[str, int, int], name: str) -> float:
    """Return the constant ratio of the velocity along the heading to that of a coordinate; 0 if there is none."""
    distances, turns = [], []
    for q, basis in samples:
        distances.append(_along(q, basis, names, heading)[0])
        turns.append(basis[:, names.index(name)])
    distance, turn = np.concatenate(distances), np.concatenate(turns)
    ratio = float(distance @ turn / max(turn @ turn, SAME))
    return ratio if name not in ("x", "y", heading[0]) and np.max(np.abs(distance - ratio * turn)) < SAME else 0.0
