"""The mathematics of a scene: coordinates, relations with their owners, and the reference pose.

Everything after this module works on `System` and never reads the scene again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, Literal, NamedTuple, Protocol

from dofkit.expressions.calculus import longest_number
from dofkit.expressions.real_values import Requirement
from dofkit.expressions.renaming import Unwritten
from dofkit.expressions.tree import Expr

Sense = Literal["=", ">=", ">"]
Sign = Literal["real", "positive", "nonzero"]


class Coordinate(NamedTuple):
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


class Relation(NamedTuple):
    """One scalar relation ``expr sense 0``; ``part`` names it within its constraint (``point x``).

    ``vector`` is the place or direction at the reference that it is about; ``domain``: what has to be so where the
    text, as it was written, has a value.
    """

    expr: Expr
    sense: Sense = "="
    part: str = ""
    vector: tuple[Expr, ...] = ()
    domain: tuple[Requirement, ...] = ()


#: A linear relation between velocities: its coefficients by column.
VelocityRow = dict[int, Any]


class Kinematics(Protocol):
    """A connection with numbers of any kind, where it is drawn or elsewhere: what a type builds its velocity rows from.

    Columns are the velocity v, then the angular velocity w, of every member; a vector of velocities is a row a
    component. ``points``: (what carries it, its place); ``number``: the screw's advance by radian, or a ratio of gears.
    ``couplings``: of a coupling the rate of each joint, its factor, and the joint alone.
    """

    @property
    def dimension(self) -> int: ...
    @property
    def members(self) -> Sequence[Any]: ...
    @property
    def points(self) -> Sequence[tuple[Any, Sequence[Any]]]: ...
    @property
    def directions(self) -> Sequence[Sequence[Any]]: ...
    @property
    def number(self) -> Any: ...
    @property
    def couplings(self) -> Sequence[tuple[Callable[[Any], VelocityRow], Any, Any]]: ...

    def shift(self) -> list[VelocityRow]:
        """How the second body's point at the first place moves against the first body's."""

    def turn(self) -> list[VelocityRow]:
        """The angular velocity of the second body against the first."""

    def slip(self) -> list[VelocityRow]:
        """How the first point moves against the other member, or the ground."""

    def velocity(self, k: int) -> list[VelocityRow]:
        """Of the point number ``k``."""

    def origin(self, k: int) -> list[VelocityRow]:
        """The velocity of the origin of the member number ``k``."""

    def spin(self, k: int) -> list[VelocityRow]:
        """The angular velocity of the member number ``k``."""


@dataclass(frozen=True)
class TypeFacts:
    """What is true of every constraint of one type; its class declares it, and all others read it here.

    For the geometry of velocities: ``velocities`` yields the rows of a connection, in the order of its scalar
    equations, None where only its relations tell; ``drive`` the row of what is prescribed; ``directions``: how many
    there are, given or not; ``by_turn``: its number is an advance by turn; ``merged``: its points are one point.
    ``axial``: it turns about lines through its places, in the plane about a place; ``slides``: along its first
    direction; ``contact``: in the plane it pushes its first point across its first direction. ``bars``: it keeps
    distances between its points; ``complete``: between every two. ``welded``: two bodies are one; ``held``: a body,
    or a point, stays where it is. ``geared``: two wheels, the ratio of whose angles is its number. ``freedoms``: what a
    joint leaves free of the one body against the other.

    For how its relations are read: ``written``: they are a person's texts, which may be squared or fall into parts;
    ``lettered``: x, y, z in these stand for coordinates of a point; ``half_turns``: they also hold in assemblies that
    are turned by half a turn, which nobody means: the drawn one is as good.

    In a lecture's words: a ``joint`` in Gruebler's count; a ``planar_pair``: a hinge or a slider; a ``string``; each
    equation of its own is a ``surface`` for a point; ``shared``: each of its members has as many of its equations.
    """

    velocities: Callable[[Kinematics], Iterator[VelocityRow]] | None = None
    drive: Callable[[Kinematics], VelocityRow] | None = None
    directions: int = 0
    by_turn: bool = False
    merged: bool = False
    axial: bool = False
    slides: bool = False
    contact: bool = False
    bars: bool = False
    complete: bool = False
    welded: bool = False
    held: bool = False
    geared: bool = False
    freedoms: tuple[str, ...] = ()
    written: bool = False
    lettered: bool = False
    half_turns: bool = False
    joint: bool = False
    planar_pair: bool = False
    string: bool = False
    surface: bool = False
    shared: bool = False

    @property
    def placed(self) -> bool:
        """True where geometry alone says what it does, so that it can be put in general position; a text has none."""
        return self.velocities is not None and not self.written


class Constraint(NamedTuple):
    """A constraint of the scene and the scalar relations that it yields.

    ``facts``: of its type. ``relations`` may be written out only when one of them is asked for. ``notes`` are sentences
    for the report that only the constraint's type can know (a curve is two surfaces; every one of the m(m-1)/2 links
    of a rigid set).
    """

    name: str
    type: str
    facts: TypeFacts
    text: str
    relations: Sequence[Relation]
    notes: tuple[str, ...] = ()

    @property
    def winds(self) -> bool:
        """Whether an equation contains a joint's angle in space up to whole turns, where the thread counts them."""
        if self.facts.written or isinstance(self.relations, Unwritten):
            return False
        return any(r.sense == "=" and not r.expr.functions.isdisjoint(("atan", "atan2")) for r in self.relations)

    @property
    def mentioned(self) -> frozenset[str]:
        """The coordinates that its relations mention, by their values, velocities or differentials."""
        if isinstance(self.relations, Unwritten):
            return self.relations.mentioned
        symbols = frozenset[Expr]().union(*(r.expr.symbols for r in self.relations))
        return frozenset(str(s.args[1]) for s in symbols if s.args[0] not in ("parameter", "time", "dt"))


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


class DrawnPoint(NamedTuple):
    """A point that a constraint mentions, where it is at the reference (None: in general position).

    ``carrier`` is the body that carries it (``ground`` too) or, with ``particle``, the particle it is.
    """

    carrier: str
    at: tuple[Expr, ...] | None
    particle: bool = False


class JointRate(NamedTuple):
    """How the rate of a joint's angle or displacement enters a coupling: ``factor`` times ``rate`` of two members.

    ``name``: of the joint and what is meant of it; ``slope`` of the relation by that; ``slides``: it is a displacement.
    """

    name: str
    slope: Expr
    rate: Callable[[Kinematics], VelocityRow]
    members: tuple[str, str]
    place: tuple[Expr, ...]
    direction: tuple[Expr, ...]
    factor: Expr
    slides: bool = False


class Connection(NamedTuple):
    """What the constraint number ``constraint`` connects, as given by its geometry and not by a text.

    ``facts``: of its type. ``members``: bodies (``ground`` too) and particles, in the order mentioned. ``points``
    belong to members, ``places`` and ``directions`` to the reference; what is in general position is None. ``number``:
    the screw's pitch, or the ratio of gears. ``driven``: one more relation prescribes the motion. ``rates``: of the
    joints that are coupled.
    """

    constraint: int
    facts: TypeFacts
    members: tuple[str, ...]
    points: tuple[DrawnPoint, ...] = ()
    places: tuple[tuple[Expr, ...] | None, ...] = ()
    directions: tuple[tuple[Expr, ...] | None, ...] = ()
    number: Expr | None = None
    driven: bool = False
    rates: tuple[JointRate, ...] = ()


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
    connects, ``starts`` where the bodies' origins stand; ``arms``, where geometry is measured, the vectors from the
    bodies' origins to their material points at the scene's centre. ``size``: the largest distance between given points.
    ``left_out``: what the scene says that it leaves out. ``singular_pose``: a pose that is no ``reference`` since Euler
    angles are singular there, so that coordinates tell no velocities of bodies.
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
    arms: Mapping[str, tuple[Expr, ...]] = field(default_factory=dict)
    tolerance: Fraction | None = None
    size: float = 1.0
    warnings: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
    singular_pose: Mapping[Expr, Expr] | None = None

    @property
    def in_coordinates(self) -> System:
        """With every pose as reference: to compare relations between coordinates, whatever bodies do there."""
        return self if self.singular_pose is None else replace(self, reference=self.singular_pose)

    @property
    def longest(self) -> int:
        """The bits of the longest number in the relations as they are written."""
        groups = [c.relations for c in self.constraints]
        written = (r.expr for group in groups if not isinstance(group, Unwritten) for r in group)
        longest = longest_number({e if e.shape is None else e.shape.skeleton for e in written})
        return max((longest, *(group.longest for group in groups if isinstance(group, Unwritten))))

    @property
    def joints(self) -> tuple[Connection, ...]:
        """The connections that are joints or welds."""
        return tuple(c for c in self.connections if c.facts.freedoms or c.facts.welded)

    @property
    def has_geometry(self) -> bool:
        """Is there a reference configuration, and anything connected in it?"""
        return self.reference is not None and any(c.members for c in self.connections)

    def numbers_of(self, *names: str) -> tuple[int, ...]:
        """The numbers of the constraints of these names, in the order of the names."""
        return tuple(i for name in names for i, c in enumerate(self.constraints) if c.name == name)


#: How an entry of what is left out begins that is a constraint: it would take freedom away.
BINDING = "constraint "


#: The part of a joint's relations that prescribes its motion.
DRIVE = "drive"

#: The fixed world, always there.
GROUND = "ground"


#: The coordinates of a particle or a body by dimension, before the owner's name.
PARTICLE_ROLES: dict[int, tuple[str, ...]] = {1: ("x",), 2: ("x", "y"), 3: ("x", "y", "z")}


BODY_ROLES: dict[int, tuple[str, ...]] = {
    1: ("x",),
    2: ("x", "y", "theta"),
    3: ("x", "y", "z", "phi", "theta", "psi"),
}
