"""The energies of a scene: as written, or from its masses, inertias, gravity, springs, dampers and forces.

T = sum m v.v/2 + w.J w/2, every body's centre of mass at its origin; V = -sum m g.r + k (d - d0)^2/2 for each spring;
Rayleigh's D = c ddot^2/2 for each damper; Q_i = sum F . dr/dq_i for each force.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from dofkit.base.errors import Fault
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import HALF, ZERO, Expr
from dofkit.expressions.vectors import Vec, dot, length, minus, scaled, square
from dofkit.motion.lagrange.rates import by_time
from dofkit.scene.drawing import Drawing
from dofkit.scene.frames import Frame, Placed
from dofkit.scene.ledger import MOVING
from dofkit.scene.parts import Force
from dofkit.scene.scene import Scene
from dofkit.scene.world import Before, World
from dofkit.system import GROUND

#: Stand for a mass or an inertia that the scene leaves out; an error where the motion depends on it.
MISSING = "_missing "


@dataclass(frozen=True)
class Energy:
    """T, V and D as expressions, the non-conservative forces by coordinate, and where they are from."""

    kinetic: Expr
    potential: Expr
    dissipation: Expr
    forces: Mapping[str, Expr]
    notes: tuple[str, ...] = ()

    @property
    def lagrangian(self) -> Expr:
        """L = T - V."""
        return self.kinetic - self.potential


def energy_of(scene: Scene, drawing: Drawing) -> tuple[Energy, tuple[Fault, ...]]:
    """What `energies` gives, and what it leaves out from the masses and the forces; and what is at fault in these."""
    reader = EnergyReader(scene, drawing)
    return reader.energy(), tuple(fault for world in reader.worlds for fault in world.faults)


@dataclass
class EnergyReader:
    """Reads the energies of a scene, each entry in a world of its own, where its faults are."""

    scene: Scene
    drawing: Drawing
    notes: list[str] = field(default_factory=list)
    worlds: list[World] = field(default_factory=list)

    def at(self, *here: str | int) -> World:
        """The world as the entry at a path sees it."""
        self.worlds.append(World(self.drawing, here, Before(sum(len(world.faults) for world in self.worlds))))
        return self.worlds[-1]

    def energy(self) -> Energy:
        """The energies, and the forces by coordinate."""
        given = self.scene.energies
        world = self.at("energies")
        kinetic, potential, dissipation = (
            _moving_if_given(world, getattr(given, key, None), key) for key in ("kinetic", "potential", "dissipation")
        )
        forces = {} if given is None else {q: _moving(world, text, "forces", q) for q, text in given.forces.items()}
        springs = [(i, f) for i, f in enumerate(self.scene.forces) if f.type in ("spring", "gravity")]
        if kinetic is None:
            kinetic = ex.add(*self._kinetic())
            self._assumed_centres()
        if potential is None:
            potential = ex.add(*(self._potential(i, f) for i, f in springs))
        elif springs:
            self._as_written("the potential energy", [f for _, f in springs])
        dampers = [(i, f) for i, f in enumerate(self.scene.forces) if f.type == "damper"]
        if dissipation is None:
            dissipation = ex.add(*(_damper(self.at("forces", i), f) for i, f in dampers))
        elif dampers:
            self._as_written("the dissipation function", [f for _, f in dampers])
        applied = [(i, f) for i, f in enumerate(self.scene.forces) if f.type == "force"]
        if forces and applied:
            self._as_written("the generalized forces", [f for _, f in applied])
        elif applied:
            forces = self._applied(applied)
        return Energy(kinetic, potential, dissipation, forces, tuple(self.notes))

    def _as_written(self, what: str, entries: list[Force]) -> None:
        kinds = " and ".join(dict.fromkeys(f.type for f in entries))
        self.notes.append(f"`energies` gives {what}: the {kinds} among the forces is taken to be in it already.")

    def _assumed_centres(self) -> None:
        if self.scene.bodies:
            self.notes.append("Each body's centre of mass is taken to be at its origin, its inertia about that.")

    def _masses(self) -> Iterator[tuple[World, Expr, tuple[str, ...]]]:
        """For every particle and body its world, its mass and the coordinates of its place."""
        table, d = self.drawing.vocabulary.table, self.drawing.dimension
        for i, particle in enumerate(self.scene.particles):
            world = self.at("particles", i)
            yield world, _mass(world, particle.mass, "mass", particle.name), table.particles[particle.name]
        for i, body in enumerate(self.scene.bodies):
            world = self.at("bodies", i)
            yield world, _mass(world, body.mass, "mass", body.name), table.bodies[body.name][:d]

    def _kinetic(self) -> Iterator[Expr]:
        inertias = [*(None for _ in self.scene.particles), *self.scene.bodies]
        for (world, mass, names), body in zip(self._masses(), inertias, strict=True):
            yield HALF * mass * _speed_squared(names)
            if body is not None and world.dimension > 1:
                yield _turning(world, body.inertia, world.frames[body.name])

    def _potential(self, index: int, force: Force) -> Expr:
        world = self.at("forces", index)
        if force.type != "gravity":
            return self._spring(world, force)
        pull = _vector(world, force.acceleration, force.direction, "acceleration", downward=True)
        return -ex.add(*(mass * dot(pull, tuple(map(ex.coordinate, names))) for _, mass, names in self._masses()))

    def _spring(self, world: World, force: Force) -> Expr:
        stiffness = _needed(world, force.stiffness, "stiffness", "of a spring")
        turned = _turned(world, force)
        if turned is not None:
            rest = ZERO if force.rest_length is None else _moving(world, force.rest_length, "rest_length")
            return HALF * stiffness * (turned - rest) ** 2
        ends = _ends(world, force)
        if ends is None:
            return ZERO
        gap = minus(_place(ends[1]), _place(ends[0]))
        if force.rest_length is not None:
            rest = _moving(world, force.rest_length, "rest_length")
        elif ends[0].reference is not None and ends[1].reference is not None:
            rest = length(minus(ends[1].reference, ends[0].reference))
            self.notes.append("A spring without `rest_length` is unstretched in the drawing.")
        else:
            world.fault("a spring needs its `rest_length` here", hint="write its length without load, perhaps 0")
            return ZERO
        if rest.is_zero:
            return HALF * stiffness * square(gap)
        return HALF * stiffness * (ex.sqrt(square(gap)) - rest) ** 2

    def _applied(self, entries: list[tuple[int, Force]]) -> dict[str, Expr]:
        found: dict[str, Expr] = {}
        for i, force in entries:
            world = self.at("forces", i)
            if force.point is not None:
                place = _place(world.point(force.point, "point"))
            elif force.body is not None:
                place = world.frame(force.body, "body").position
            else:
                hint = "name its `point` or `body`, or give `energies: {forces: ...}`"
                world.fault("where the force acts is not said", hint=hint)
                continue
            vector = _vector(world, force.value, force.direction, "value", downward=False)
            for q in world.table.coordinates:
                symbol = ex.coordinate(q.name)
                work = ex.add(*(f * ex.diff(part, symbol) for f, part in zip(vector, place, strict=True)))
                if not work.is_zero:
                    found[q.name] = found.get(q.name, ZERO) + work
        return found


def _moving(world: World, value: object, *where: str | int) -> Expr:
    if isinstance(value, (str, Fraction)):
        return world.expression(value, *where, allow=MOVING)
    world.fault("one value is needed here, not a list", *where, hint="write a number or a text")
    return ZERO


def _moving_if_given(world: World, value: object, key: str) -> Expr | None:
    return None if value is None else _moving(world, value, key)


def _needed(world: World, value: object, key: str, what: str) -> Expr:
    if value is None:
        world.fault(f"the `{key}` {what} is missing", hint="give a number or a parameter")
        return ZERO
    return _moving(world, value, key)


def _mass(world: World, value: object, key: str, name: str) -> Expr:
    return ex.parameter(f"{MISSING}{key} of {name}") if value is None else _moving(world, value, key)


def _turning(world: World, inertia: object, frame: Frame) -> Expr:
    """w.J w/2 with J in the body's axes."""
    if frame.dimension == 2:
        rate = ex.velocity(frame.angles[0])
        return HALF * _mass(world, inertia, "inertia", frame.name) * rate * rate
    spin = body_spin(frame)
    if not isinstance(inertia, tuple):
        return HALF * _mass(world, inertia, "inertia", frame.name) * square(spin)
    if len(inertia) != 3:
        world.fault("an inertia is one number, three principal moments or three rows", "inertia")
        return ZERO
    if all(isinstance(row, tuple) for row in inertia):
        rows = [[_moving(world, v, "inertia", i, j) for j, v in enumerate(row)] for i, row in enumerate(inertia)]
        if any(len(row) != 3 for row in rows):
            world.fault("a row of the inertia has three entries", "inertia")
            return ZERO
        return HALF * ex.add(*(ex.mul(w, m, u) for w, row in zip(spin, rows, strict=True)
                               for m, u in zip(row, spin, strict=True)))  # fmt: skip
    moments = [_moving(world, v, "inertia", i) for i, v in enumerate(inertia)]
    return HALF * ex.add(*(ex.mul(m, w, w) for m, w in zip(moments, spin, strict=True)))


def _damper(world: World, force: Force) -> Expr:
    damping = _needed(world, force.damping, "damping", "of a damper")
    turned = _turned(world, force)
    if turned is not None:
        return HALF * damping * by_time(turned) ** 2
    ends = _ends(world, force)
    if ends is None:
        return ZERO
    gap = minus(_place(ends[1]), _place(ends[0]))
    if len(gap) == 1:
        return HALF * damping * by_time(gap[0]) ** 2
    along = dot(gap, tuple(by_time(part) for part in gap))
    return HALF * damping * along**2 / square(gap)


def _ends(world: World, force: Force) -> tuple[Placed, Placed] | None:
    if force.between is None or any(isinstance(e, str) and e in (*world.frames, GROUND) for e in force.between):
        hint = "write `between: [point, point]`; a point of a body is {on: BODY, at: [..]}"
        world.fault(f"a {force.type} needs the two points that it acts between", "between", hint=hint)
        return None
    first, second = (world.point(end, "between", j) for j, end in enumerate(force.between))
    return first, second


def _turned(world: World, force: Force) -> Expr | None:
    """The angle between two planar bodies that a torsion spring or damper acts on."""
    names = [e for e in force.between or () if isinstance(e, str) and e in (*world.frames, GROUND)]
    if len(names) != 2 or world.dimension != 2:
        return None
    first, second = (world.frame(name, "between") for name in names)
    return second.angle - first.angle


def _vector(world: World, value: object, direction: object, key: str, downward: bool) -> Vec:
    """A vector from its components, or from its size and direction (gravity's is the last axis, downward)."""
    d = world.dimension
    zero: Vec = (ZERO,) * d
    if isinstance(value, tuple):
        if len(value) != d:
            world.fault(f"{len(value)} components given where the dimension is {d}", key)
            return zero
        return tuple(_moving(world, part, key, i) for i, part in enumerate(value))
    size = _needed(world, value, key, "of gravity" if downward else "of a force")
    if direction is None:
        if not downward and d > 1:
            world.fault("the `direction` of the force is missing", hint="or give its components as `value`")
            return zero
        return (*(ZERO,) * (d - 1), -size if downward else size)
    if not isinstance(direction, tuple) or len(direction) != d:
        world.fault(f"a direction has {d} components here", "direction")
        return zero
    along = tuple(_moving(world, part, "direction", i) for i, part in enumerate(direction))
    if all(part.is_zero for part in along):
        world.fault("a direction cannot be zero", "direction")
        return zero
    return scaled(size / length(along), along)


def body_spin(frame: Frame) -> Vec:
    """The angular velocity in the axes of a spatial body, for z-x-z Euler angles.

    phidot (sin theta sin psi, sin theta cos psi, cos theta) + thetadot (cos psi, -sin psi, 0) + psidot e_z.
    """
    theta, psi = (ex.coordinate(name) for name in frame.angles[1:])
    precession, nutation, own = (ex.velocity(name) for name in frame.angles)
    s, c = ex.fn("sin", psi), ex.fn("cos", psi)
    tilt = ex.fn("sin", theta)
    return (
        precession * tilt * s + nutation * c,
        precession * tilt * c - nutation * s,
        precession * ex.fn("cos", theta) + own,
    )


def _place(point: Placed) -> Vec:
    return tuple(part / point.under for part in point.over)


def _speed_squared(names: tuple[str, ...]) -> Expr:
    return ex.add(*(ex.velocity(name) ** 2 for name in names))


def missing(symbols: frozenset[Expr], scene: Scene) -> list[Fault]:
    """A fault for everything that was left out and that the motion depends on, where it belongs."""
    named = sorted(str(s.args[1]).removeprefix(MISSING) for s in symbols if str(s.args[1]).startswith(MISSING))
    where: dict[str, tuple[str | int, ...]] = {p.name: ("particles", i) for i, p in enumerate(scene.particles)}
    where.update({b.name: ("bodies", i) for i, b in enumerate(scene.bodies)})
    hint = "give it, or `energies: {kinetic: ...}`"
    return [Fault(f"the {name} is missing", where.get(name.rpartition(" ")[2], ()), hint=hint) for name in named]
