"""What a picture is made of before it is put on paper: shapes whose vertices are carried by bodies and particles."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np

Array = np.ndarray[Any, Any]
Place = tuple[float, float, float]

#: ``line`` and ``area``: through the vertices; ``hull``: around them, rounded by ``size``; ``ball``: a disc on paper of
#: radius ``size``; ``coil``: a spring between two; ``bow``: an arc between two, as high as ``size`` of its length;
#: ``words``: a text beside the vertex.
Kind = Literal["line", "area", "hull", "ball", "coil", "bow", "words"]
#: What a shape is part of.
Role = Literal[
    "body", "joint", "guide", "bar", "rope", "ground", "hatch", "axis", "locus", "trace", "tie", "force", "point",
    "name", "field", "bracket", "further", "surface", "node", "plane",
]  # fmt: skip
#: What the report says of it.
State = Literal["plain", "moving", "redundant", "conflicting"]


class Vertex(NamedTuple):
    """A point of what carries it, where it stands in the drawing."""

    carrier: str
    at: Place


class Shape(NamedTuple):
    """A shape; ``owner`` is the constraint, body or particle that it shows."""

    kind: Kind
    vertices: tuple[Vertex, ...]
    role: Role
    state: State = "plain"
    owner: str = ""
    size: float = 0.0
    text: str = ""


class Displacement(NamedTuple):
    """What stands at a in the drawing is at p + R (a - p0): here ``turn`` R, and ``shift`` p - R p0."""

    turn: Array
    shift: Array

    def moved(self, at: Sequence[float] | Array) -> Array:
        """Where a point of the drawing is."""
        return np.asarray(self.turn @ np.asarray(at, dtype=float) + self.shift)

    def back(self, point: Sequence[float] | Array) -> Place:
        """Where in the drawing the point stands that is now here."""
        x, y, z = self.turn.T @ (np.asarray(point, dtype=float) - self.shift)
        return float(x), float(y), float(z)


#: Of the ground, and of what nothing is known.
AT_REST = Displacement(np.eye(3), np.zeros(3))
Poses = Mapping[str, Displacement]


class Clip(NamedTuple):
    """A motion: the poses of everything, frame by frame; ``closed`` where the last is followed by the first."""

    name: str
    frames: tuple[Poses, ...]
    closed: bool = False


@dataclass(frozen=True)
class Sketch:
    """All of a picture but its paper.

    ``dimension`` of the world drawn; ``poses`` of what carries its shapes; ``size``: how far it reaches; ``notes`` are
    told below it, ``alternative`` to who cannot see it. ``axes``: names of the three directions; ``measurable``: do
    lengths mean something? ``meanings``: what the legend says of states; None: there is no legend.
    """

    title: str
    dimension: int
    shapes: tuple[Shape, ...]
    poses: Poses
    size: float
    answer: str
    alternative: str
    notes: tuple[str, ...] = ()
    axes: tuple[str, ...] = ("x", "y", "z")
    measurable: bool = False
    meanings: Mapping[State, str] | None = field(default_factory=dict)

    def at(self, vertex: Vertex, poses: Poses | None = None) -> Array:
        """Where a vertex is."""
        return (self.poses if poses is None else poses).get(vertex.carrier, AT_REST).moved(vertex.at)


def place(values: Iterable[float]) -> Place:
    """A point of one, two or three numbers as one of space."""
    x, y, z = (*(float(v) for v in values), 0.0, 0.0)[:3]
    return x, y, z
