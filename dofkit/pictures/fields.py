"""Fields of directions: what differential constraints allow at each point of some coordinates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from dofkit.expressions.tree import TIME, Expr, coordinate
from dofkit.pictures.arrangement import Arrangement
from dofkit.pictures.evaluation import kernel
from dofkit.pictures.rates import velocity_rows
from dofkit.pictures.shapes import Array, Role, Shape, Vertex, place
from dofkit.system import GROUND

#: Elements of a field along each direction, in the plane and in space; corners of an element.
PLANE, SPACE, CORNERS = 11, (5, 5, 3), 12


class Distribution:
    """The directions that all constraints allow at a point, as smooth vector fields near one.

    ``names`` are the coordinates, in order. ``fields`` is the number of independent ones there.
    ``timed``: does time occur? It stands still.
    """

    def __init__(self, arrangement: Arrangement) -> None:
        self.arrangement = arrangement
        self.names = [c.name for c in arrangement.system.coordinates]
        self.symbols = [coordinate(n) for n in self.names]
        self.start = np.array([arrangement.numbers.get(s, 0.0) for s in self.symbols])
        self.timed = TIME in velocity_rows(arrangement.system, arrangement.numbers)[1]
        found = self.basis(self.start)
        self.pivots = _pivots(found)
        self.fields = len(found)

    def known(self, q: Array) -> Mapping[Expr, float]:
        """All numbers, with the coordinates at q."""
        return {**self.arrangement.numbers, **dict(zip(self.symbols, map(float, q), strict=True))}

    def basis(self, q: Array) -> Array:
        """An orthonormal basis of the allowed directions at q, as rows; time stands still."""
        rows, columns = velocity_rows(self.arrangement.system, self.known(q))
        moving = [k for k, c in enumerate(columns) if c != TIME]
        return kernel(rows[:, moving], len(self.names))

    def at(self, q: Array) -> Array:
        """The vector fields at q: each moves one of the pivots at unit speed and no other pivot."""
        basis = self.basis(q)[: self.fields]
        square = basis[:, self.pivots]
        return np.asarray(np.linalg.lstsq(square, basis, rcond=1e-6)[0])


def _pivots(basis: Array) -> list[int]:
    """Columns on which a basis is clearly of full rank, each the largest less what those before span."""
    found: list[int] = []
    left = basis.copy()
    for _ in range(len(basis)):
        sizes = np.linalg.norm(left, axis=0)
        column = int(np.argmax(np.round(sizes, 6)))
        way = left[:, column] / max(float(sizes[column]), 1e-12)
        left = left - np.outer(way, way @ left)
        found.append(column)
    return sorted(found)


def element(q: Iterable[float], directions: Array, size: float, role: Role = "field") -> Iterator[Shape]:
    """The allowed directions at a point: a short line, or a small disc."""
    middle = np.array(place(q))
    spanned = _orthonormal(directions)
    if len(spanned) == 1:
        ends = (middle - size * spanned[0], middle + size * spanned[0])
        yield Shape("line", tuple(Vertex(GROUND, place(p)) for p in ends), role)
    elif len(spanned) == 2:
        angles = 2 * np.pi * np.arange(CORNERS) / CORNERS
        rim = (middle + size * (np.cos(a) * spanned[0] + np.sin(a) * spanned[1]) for a in angles)
        yield Shape("area", tuple(Vertex(GROUND, place(p)) for p in rim), role)
    else:
        yield Shape("ball", (Vertex(GROUND, place(middle)),), role, size=0.35 * size)


def _orthonormal(directions: Array) -> Array:
    """A basis of length 1 of what some directions of space span, as rows."""
    padded = np.zeros((len(directions), 3))
    padded[:, : directions.shape[1]] = directions
    _, singular, right = np.linalg.svd(padded)
    return np.asarray(right[: int(np.sum(singular > 1e-3))])


def elements(distribution: Distribution, shown: Sequence[int], half: float) -> Iterator[Shape]:
    """The field over a grid of the coordinates that are shown, about where the scene stands."""
    counts = (PLANE,) * 2 if len(shown) == 2 else SPACE
    centre = distribution.start[list(shown)]
    grids = [np.linspace(c - half, c + half, n) for c, n in zip(centre, counts, strict=False)]
    size = (0.75 if len(shown) == 2 else 0.6) * half / (counts[0] - 1)
    for spot in product(*grids):
        q = distribution.start.copy()
        q[list(shown)] = spot
        directions = distribution.basis(q)[:, list(shown)]
        if np.all(np.isfinite(directions)) and 0 < len(_orthonormal(directions)) < 3:
            yield from element(spot, directions, size)
