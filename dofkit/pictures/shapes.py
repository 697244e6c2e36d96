"""The elements of a sketch: shapes whose vertices move with bodies and particles, and their colours and lines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from typing import Any, Literal, NamedTuple

import numpy as np
import yaml

from dofkit.expressions.tree import Expr
from dofkit.system import GROUND

Array = np.ndarray[Any, Any]
Place = tuple[float, float, float]

#: ``line`` and ``area``: through the vertices; ``curve``: a smooth line through them; ``hull``: around them, rounded by
#: ``size``; ``ball``: a disc on paper of radius ``size``; ``coil``: a spring between two; ``bow``: an arc between two,
#: as high as ``size`` of its length; ``arrow``: from one to another, with a head of ``size``; ``words``: a text there.
Kind = Literal["line", "area", "curve", "hull", "ball", "coil", "bow", "arrow", "words"]
#: The part of the picture to which a shape belongs.
Role = Literal[
    "body", "joint", "guide", "bar", "rope", "ground", "hatch", "axis", "locus", "trace", "tie", "force", "point",
    "name", "field", "bracket", "further", "surface", "mesh", "arrow", "node", "plane", "ghost",
]  # fmt: skip
#: The state of what a shape shows, according to the report.
State = Literal["plain", "moving", "redundant", "conflicting"]
#: The corners of a square about the origin.
SQUARE = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))


class Vertex(NamedTuple):
    """A point that moves with a carrier (body, particle, ground), by its position in the reference configuration."""

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
    """A displacement of a carrier: a point at a is moved to ``turn`` a + ``shift``."""

    turn: Array
    shift: Array

    def moved(self, at: Sequence[float] | Array) -> Array:
        """Return where a point is after the displacement."""
        return np.asarray(self.turn @ np.asarray(at, dtype=float) + self.shift)

    def back(self, point: Sequence[float] | Array) -> Place:
        """Return where the point was before the displacement."""
        return place(self.turn.T @ (np.asarray(point, dtype=float) - self.shift))


#: The displacement of the ground.
AT_REST = Displacement(np.eye(3), np.zeros(3))
Poses = Mapping[str, Displacement]


class Clip(NamedTuple):
    """A motion: the poses of all carriers, frame by frame, and the ``path`` of the symbols.

    ``closed``: the first frame follows the last. Clips of the same name differ by their ``size``. ``text``: a
    description; ``loop``: two coordinates move around a loop, and the others may end displaced. ``arrows`` show
    velocities; ``dropped``: the constraint that is left out.
    """

    name: str
    frames: tuple[Poses, ...]
    path: tuple[Mapping[Expr, float], ...]
    closed: bool = False
    size: float = 0.0
    text: str = ""
    loop: bool = False
    arrows: tuple[tuple[Array, Array], ...] = ()
    dropped: str = ""


class Switch(NamedTuple):
    """A constraint that can be left out, and the effect; ``free``: all such constraints together change nothing."""

    name: str
    text: str
    free: bool = False


@dataclass(frozen=True)
class Sketch:
    """A picture before it is projected to a page.

    ``dimension`` of the world drawn; ``poses`` of the carriers; ``size``: its extent; ``notes``: texts below it;
    ``alternative``: a description in words. ``axes``: names of the directions; ``measurable``: whether lengths mean
    something. ``meanings``: the legend's text for each state (None: no legend). ``traced``: the vertices whose paths
    can be shown.
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
    traced: tuple[Vertex, ...] = ()

    def at(self, vertex: Vertex, poses: Poses | None = None) -> Array:
        """Return the position of a vertex in ``poses``, by default those of the sketch."""
        return (self.poses if poses is None else poses).get(vertex.carrier, AT_REST).moved(vertex.at)


def place(values: Iterable[float]) -> Place:
    """Return a point of up to three numbers as one of space."""
    x, y, z = (*(float(v) for v in values), 0.0, 0.0, 0.0)[:3]
    return x, y, z


def carried_by(carrier: str, points: Iterable[Iterable[float]]) -> tuple[Vertex, ...]:
    """Return points as vertices of a carrier."""
    return tuple(Vertex(carrier, place(point)) for point in points)


def fixed(*points: Iterable[float]) -> tuple[Vertex, ...]:
    """Return points of the world as vertices."""
    return carried_by(GROUND, points)


def circle(count: int, closed: bool = False) -> Array:
    """Return ``count`` points of the unit circle as rows (x, y, 0); ``closed``: the first is repeated at the end."""
    angles = 2 * np.pi * np.arange(count + closed) / count
    return np.column_stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))])


def quaternion(turn: Array) -> Array:
    """Return the unit quaternion (w, x, y, z) of a rotation, with w at least 0."""
    products = np.array([
        [np.trace(turn), turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]],
        *np.hstack([[[0.0]] * 3, turn + turn.T - np.trace(turn) * np.eye(3)]),
    ])  # fmt: skip
    values, vectors = np.linalg.eigh(products, UPLO="U")
    largest = vectors[:, int(np.argmax(values))]
    return np.asarray(largest if largest[0] >= 0 else -largest)


# Looks

SKY, BLUE, GREY, INK = "#56B4E9", "#0072B2", "#6E6E6E", "#222222"


class Ink(NamedTuple):
    """A line's colour, width and dashes in points; a fill, its opacity and hatching; higher layers cover lower ones."""

    line: str = INK
    width: float = 1.2
    dash: tuple[float, ...] = ()
    fill: str | None = None
    dense: float = 1.0
    hatch: bool = False
    layer: int = 3


def _ink(row: Mapping[str, Any]) -> Ink:
    return Ink(**{**row, "dash": tuple(row.get("dash", ()))})


_LOOKS: Mapping[str, Any] = yaml.safe_load(files(__package__).joinpath("looks.yaml").read_bytes())
_PLAIN: Mapping[Role, Ink] = {role: _ink(row) for role, row in _LOOKS["roles"].items()}
_LOUD: Mapping[State, Ink] = {state: _ink(row) for state, row in _LOOKS["states"].items()}
#: {colour on light paper: colour on dark paper}.
ON_DARK: Mapping[str, str] = _LOOKS["dark"]
#: The roles that show the state of a constraint, and those of them with thin lines.
_OF_CONSTRAINTS = ("joint", "guide", "bar", "rope", "locus", "tie", "surface")
_THIN = ("guide", "joint", "surface")


def ink_of(shape: Shape) -> Ink:
    """Return the ink of a shape, by its role, kind and state."""
    plain = _PLAIN[shape.role]
    if shape.kind == "ball" and shape.role == "joint":
        plain = plain._replace(layer=7)
    if shape.state == "moving" and shape.role == "body":
        return plain._replace(line=BLUE, fill=SKY, dense=0.35, hatch=False)
    if shape.state == "moving" and shape.role == "point":
        return plain._replace(line=BLUE, fill=BLUE)
    if shape.state in _LOUD and shape.role in _OF_CONSTRAINTS:
        loud = _LOUD[shape.state]
        width = 1.9 if shape.role in _THIN else loud.width
        return loud._replace(fill=loud.fill if plain.fill else None, layer=plain.layer, width=width)
    if shape.state in _LOUD and shape.role == "name":
        return plain._replace(line=_LOOKS["names"][shape.state])
    return plain


def keys_of(shapes: Iterable[Shape], meanings: Mapping[State, str] | None) -> list[tuple[Ink, str]]:
    """Return the lines of the legend: roles and states that occur and have a meaning; none without meanings."""
    if meanings is None:
        return []
    keys: dict[str, Ink] = {}
    for shape in shapes:
        ink = ink_of(shape)
        if shape.role in ("body", "point") and shape.state in ("moving", "plain"):
            if shape.state in meanings:
                sample = _PLAIN["body"] if shape.state == "plain" else ink._replace(dense=0.5)
                keys.setdefault(meanings[shape.state], sample)
        elif shape.state in meanings and shape.state in _LOUD and ink.dash == _LOUD[shape.state].dash:
            keys.setdefault(meanings[shape.state], ink._replace(fill=None, width=2.4))
        elif shape.role in _LOOKS["legend"] and (shape.state == "plain" or shape.role in ("bracket", "force")):
            keys.setdefault(_LOOKS["legend"][shape.role], _PLAIN["locus"] if shape.role == "surface" else ink)
    return [(ink, text) for text, ink in keys.items()]
