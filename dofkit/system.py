"""The mathematics of a scene: coordinates, relations with their owners, and the reference pose.

Everything after this module works on `System` and never reads the scene again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Literal, NamedTuple

from dofkit.expressions.tree import Expr

Sense = Literal["=", ">=", ">"]
Sign = Literal["real", "positive", "nonzero"]


@dataclass(frozen=True)
class Coordinate:
    """A configuration coordinate q and what it belongs to.

    ``owner`` is a particle's or body's name, or None; ``role`` is ``x``, ``y``, ``z``, ``angle``
    (the angle of a planar body), ``phi``, ``theta``, ``psi`` (z-x-z Euler angles of a spatial
    body) or ``free``.
    """

    name: str
    owner: str | None = None
    role: str = "free"


@dataclass(frozen=True)
class Rotation:
    """How a spatial body's orientation is written in the relations.

    ``gibbs``: no text of the scene names its angles, so the three coordinate symbols ``names``
    stand for the Gibbs vector g of its rotation *from the reference pose*,
    R = I + 2 (g~ + g~ g~) / (1 + g.g): rational, and regular at g = 0, the reference.
    ``euler``: they are the z-x-z Euler angles themselves.
    ``initial`` holds the Euler angles of the reference pose, for both.
    """

    body: str
    names: tuple[str, str, str]
    chart: Literal["gibbs", "euler"]
    initial: tuple[Expr, Expr, Expr]


@dataclass(frozen=True)
class Relation:
    """One scalar relation ``expr sense 0``; ``part`` names it within its constraint (``point x``).

    ``vector`` is the place or direction in the drawing that it is about.
    """

    expr: Expr
    sense: Sense = "="
    part: str = ""
    vector: tuple[Expr, ...] = ()


@dataclass(frozen=True)
class Constraint:
    """A constraint of the scene and the scalar relations that it yields.

    ``notes`` are sentences for the report that only the constraint's type can know
    (a curve is two surfaces; every one of the m(m-1)/2 links of a rigid set).
    """

    name: str
    type: str
    text: str
    relations: tuple[Relation, ...]
    notes: tuple[str, ...] = ()


class Place(NamedTuple):
    """A point: of the body ``frame`` (``ground`` too), standing at ``reference``; or a particle, where that is None."""

    frame: str | None
    label: str
    reference: tuple[Expr, ...] | None = None


class Distance(NamedTuple):
    """|A - B|^2 = ``squared``, which holds neither coordinates nor time; ``at_most``: <= (the ends of a string)."""

    first: Place
    second: Place
    squared: Expr
    at_most: bool = False


@dataclass(frozen=True)
class DrawnPoint:
    """A point that a constraint mentions, where it stands in the drawing (None: in general position).

    ``carrier`` is the body that carries it (``ground`` too) or, with ``particle``, the particle it is.
    """

    carrier: str
    at: tuple[Expr, ...] | None
    particle: bool = False


@dataclass(frozen=True)
class Connection:
    """What the constraint number ``constraint`` connects, as given by its geometry and not by a text.

    ``members``: bodies (``ground`` too) and particles, in the order mentioned. ``points`` belong to members,
    ``places`` and ``directions`` to the drawing; what is in general position is None. ``number``: the screw's pitch,
    or the ratio of gears. ``driven``: one more relation prescribes the motion.
    """

    constraint: int
    type: str
    members: tuple[str, ...]
    points: tuple[DrawnPoint, ...] = ()
    places: tuple[tuple[Expr, ...] | None, ...] = ()
    directions: tuple[tuple[Expr, ...] | None, ...] = ()
    number: Expr | None = None
    driven: bool = False


@dataclass(frozen=True)
class ListedForce:
    """An entry of ``forces``: it never constrains, and ``reason`` says why."""

    name: str
    reason: str


@dataclass(frozen=True)
class System:
    """What the engines see.

    ``parameters``: the symbolic parameters (those with a value have been replaced by it) and what
    is known of their signs. ``generic``: internal parameters (their names begin with ``_``) that
    stand for geometry left out: squared lengths of links, positions of joints.
    ``functions``: unknown functions and their numbers of arguments.
    ``reference``: the value of every coordinate symbol at the reference configuration (t = 0), or
    None where the scene gives none. ``pose``: values for some coordinate symbols at which the
    joints close by construction, generic parameters included; equal to ``reference`` where that is given.
    ``particles`` and ``bodies`` list names; ``links`` the rigid links between particles as
    (constraint index, particle, particle), ``distances`` those between points of any kind that constraints
    hold, by constraint index; ``connections`` what each constraint of given or generic geometry
    connects, ``starts`` where the bodies' origins stand. ``size``: the largest distance between given points.
    """

    name: str
    dimension: int
    coordinates: tuple[Coordinate, ...]
    constraints: tuple[Constraint, ...]
    parameters: Mapping[str, Sign] = field(default_factory=dict)
    generic: tuple[str, ...] = ()
    functions: Mapping[str, int] = field(default_factory=dict)
    rotations: tuple[Rotation, ...] = ()
    reference: Mapping[Expr, Expr] | None = None
    pose: Mapping[Expr, Expr] = field(default_factory=dict)
    particles: tuple[str, ...] = ()
    bodies: tuple[str, ...] = ()
    forces: tuple[ListedForce, ...] = ()
    links: tuple[tuple[int, str, str], ...] = ()
    distances: Mapping[int, Sequence[Distance]] = field(default_factory=dict)
    connections: tuple[Connection, ...] = ()
    starts: Mapping[str, tuple[Expr, ...]] = field(default_factory=dict)
    tolerance: Fraction | None = None
    size: float = 1.0
    warnings: tuple[str, ...] = ()

    def numbers_of(self, *names: str) -> tuple[int, ...]:
        """The numbers of the constraints of these names, in the order of the names."""
        return tuple(i for name in names for i, c in enumerate(self.constraints) if c.name == name)


#: The fixed world, always there.
GROUND = "ground"


#: The coordinates of a particle or a body by dimension, before the owner's name.
PARTICLE_ROLES: dict[int, tuple[str, ...]] = {1: ("x",), 2: ("x", "y"), 3: ("x", "y", "z")}


BODY_ROLES: dict[int, tuple[str, ...]] = {
    1: ("x",),
    2: ("x", "y", "theta"),
    3: ("x", "y", "z", "phi", "theta", "psi"),
}
