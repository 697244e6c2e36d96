"""The energies of a scene: given as formulas, or computed from its masses, inertias and forces.

T = sum m v.v/2 + w.J w/2, with velocity v and angular velocity w; every body's centre of mass is at its origin.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from dofkit.base.errors import Fault
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import HALF, ZERO, Expr
from dofkit.expressions.vectors import Vec, dot, length, minus, plus, scaled, square
from dofkit.motion.lagrange.elimination import by_time
from dofkit.scene.drawing import Drawing
from dofkit.scene.frames import Frame, Placed
from dofkit.scene.ledger import MOVING
from dofkit.scene.parts import Force
from dofkit.scene.scene import Scene
from dofkit.scene.world import World
from dofkit.system import GROUND


@dataclass(frozen=True)
class Energy:
    """T, V and D as expressions, {coordinate: non-conservative force}, and notes on assumptions."""

    kinetic: Expr
    potential: Expr
    dissipation: Expr
    forces: Mapping[str, Expr]
    notes: tuple[str, ...] = ()

    @property
    def lagrangian(self) -> Expr:
        """L = T - V."""
        return self.kinetic - self.potential

    @property
    def symbols(self) -> frozenset[Expr]:
        """The symbols in the energies and forces."""
        used = (self.kinetic, self.potential, self.dissipation, *self.forces.values())
        return frozenset[Expr]().union(*(e.symbols for e in used))


def energy_of(scene: Scene, drawing: Drawing) -> tuple[Energy, tuple[Fault, ...]]:
    """Return (energy from `energies`, completed from masses and forces, faults of these entries)."""
    worlds = EntryWorlds(drawing)
    return EnergyReader(scene, worlds).energy(), worlds.faults


#: {type of force: the part of the energies to which it contributes}.
_PART = {"spring": "potential", "gravity": "potential", "damper": "dissipation", "force": "applied"}
#: (number of the force in the scene, force).
Numbered = tuple[int, Force]


@dataclass
class EnergyReader:
    """Reads the energies of a scene; ``worlds`` collects the faults, ``notes`` state assumptions."""

    scene: Scene
    worlds: EntryWorlds
    notes: list[str] = field(default_factory=list)

    def energy(self) -> Energy:
        """Return the energies and the forces by coordinate."""
        written = self.scene.energies
        world = self.worlds.at("energies")
        kinetic, potential, dissipation = (
            _text(world, getattr(written, key, None), key) for key in ("kinetic", "potential", "dissipation")
        )
        force_texts = {} if written is None else written.forces
        forces = {name: moving(world, text, "forces", name) for name, text in force_texts.items()}
        if kinetic is None:
            kinetic = ex.add(*self._kinetic())
            self._assumed_centres()
        springs, dampers, applied = (
            [(i, force) for i, force in enumerate(self.scene.forces) if _PART[force.type] == part]
            for part in ("potential", "dissipation", "applied")
        )
        if potential is None:
            terms = {"gravity": self._gravity, "spring": self._spring}
            potential = ex.add(*(terms[force.type](self.worlds.at("forces", i), force) for i, force in springs))
        elif springs:
            self._as_written("the potential energy", springs)
        if dissipation is None:
            dissipation = ex.add(*(_damper(self.worlds.at("forces", i), force) for i, force in dampers))
        elif dampers:
            self._as_written("the dissipation function", dampers)
        if forces and applied:
            self._as_written("the generalized forces", applied)
        elif applied:
            forces = self._applied(applied)
        return Energy(kinetic, potential, dissipation, forces, tuple(self.notes))

    def _as_written(self, what: str, entries: Sequence[Numbered]) -> None:
        """Note that ``what`` is given in `energies` and taken to include these forces."""
        kinds = " and ".join(dict.fromkeys(force.type for _, force in entries))
        self.notes.append(f"`energies` gives {what}, taken to include the {kinds} listed under `forces`.")

    def _assumed_centres(self) -> None:
        if self.scene.bodies:
            self.notes.append(
                "The centre of mass of each body is taken to be at its origin, and its inertia about that point."
            )

    def _kinetic(self) -> Iterator[Expr]:
        bodies = [*(None for _ in self.scene.particles), *self.scene.bodies]
        for (world, m, names), body in zip(masses(self.scene, self.worlds), bodies, strict=True):
            yield HALF * m * ex.add(*(ex.velocity(name) ** 2 for name in names))
            if body is not None and world.dimension > 1:
                yield _turning(world, body.inertia, world.frames[body.name])

    def _applied(self, entries: Sequence[Numbered]) -> dict[str, Expr]:
        """Return {coordinate: generalized force F . dr/dq of the applied forces F at r}, without zeros."""
        work: dict[str, Expr] = {}
        for i, force in entries:
            world = self.worlds.at("forces", i)
            if force.point is not None:
                place = _place(world.point(force.point, "point"))
            elif force.body is not None:
                place = world.frame(force.body, "body").position
            else:
                hint = "name its `point` or `body`, or give `energies: {forces: ...}`"
                world.fault("the point at which the force acts is missing", hint=hint)
                continue
            vector = _vector(world, force.value, force.direction, "value", downward=False)
            for q in world.table.coordinates:
                symbol = ex.coordinate(q.name)
                power = ex.add(*(f * diff(part, symbol) for f, part in zip(vector, place, strict=True)))
                if not power.is_zero:
                    work[q.name] = work.get(q.name, ZERO) + power
        return work

    def _gravity(self, world: World, force: Force) -> Expr:
        pull = _pull(world, force)
        return -ex.add(*(
            mass * dot(pull, tuple(map(ex.coordinate, names))) for _, mass, names in masses(self.scene, self.worlds)
        ))  # fmt: skip

    def _spring(self, world: World, force: Force) -> Expr:
        """Return the energy k/2 (l - l0)^2 of a linear or torsional spring; 0 after a fault, which is recorded."""
        stiffness = needed(world, force.stiffness, "stiffness", "of a spring")
        turned = _turned(world, force)
        if turned is not None:
            unstretched = ZERO if force.rest_length is None else moving(world, force.rest_length, "rest_length")
            return HALF * stiffness * (turned - unstretched) ** 2
        ends = _ends(world, force)
        if ends is None:
            return ZERO
        gap = minus(_place(ends[1]), _place(ends[0]))
        if force.rest_length is not None:
            unstretched = moving(world, force.rest_length, "rest_length")
        elif ends[0].reference is not None and ends[1].reference is not None:
            unstretched = length(minus(ends[1].reference, ends[0].reference))
            self.notes.append("A spring without `rest_length` is unstretched in the reference configuration.")
        else:
            world.fault("a spring needs its `rest_length` here", hint="write its length without load, perhaps 0")
            return ZERO
        if unstretched.is_zero:
            return HALF * stiffness * square(gap)
        return HALF * stiffness * (ex.sqrt(square(gap)) - unstretched) ** 2


def _text(world: World, text: object, key: str) -> Expr | None:
    return None if text is None else moving(world, text, key)


def _turning(world: World, inertia: object, frame: Frame) -> Expr:
    """Return the rotational energy w.J w/2 of a body, with the inertia J in its axes."""
    if frame.dimension == 2:
        rate = ex.velocity(frame.angles[0])
        return HALF * mass(world, inertia, "inertia", frame.name) * rate * rate
    return spin_energy(world, inertia, frame.name, body_spin(frame))


def spin_energy(world: World, inertia: object, name: str, spin: Vec) -> Expr:
    """Return s.J s/2 of a spatial body; the angular velocity s and the inertia J (1, 3 or 3 x 3 values) in its axes."""
    if not isinstance(inertia, tuple):
        return HALF * mass(world, inertia, "inertia", name) * square(spin)
    if len(inertia) != 3:
        world.fault("an inertia is one number, three principal moments or three rows", "inertia")
        return ZERO
    if all(isinstance(row, tuple) for row in inertia):
        rows = [[moving(world, v, "inertia", i, j) for j, v in enumerate(row)] for i, row in enumerate(inertia)]
        if any(len(row) != 3 for row in rows):
            world.fault("a row of the inertia has three entries", "inertia")
            return ZERO
        return HALF * ex.add(*(ex.mul(w, m, u) for w, row in zip(spin, rows, strict=True)
                               for m, u in zip(row, spin, strict=True)))  # fmt: skip
    moments = [moving(world, v, "inertia", i) for i, v in enumerate(inertia)]
    return HALF * ex.add(*(ex.mul(m, w, w) for m, w in zip(moments, spin, strict=True)))


def body_spin(frame: Frame) -> Vec:
    """Return the angular velocity in the axes of a spatial body, for z-x-z Euler angles.

    phidot (sin theta sin psi, sin theta cos psi, cos theta) + thetadot (cos psi, -sin psi, 0) + psidot e_z.
    """
    theta, psi = (ex.coordinate(name) for name in frame.angles[1:])
    precession, nutation, rotation = (ex.velocity(name) for name in frame.angles)
    s, c = ex.fn("sin", psi), ex.fn("cos", psi)
    tilt = ex.fn("sin", theta)
    return (
        precession * tilt * s + nutation * c,
        precession * tilt * c - nutation * s,
        precession * ex.fn("cos", theta) + rotation,
    )


def gravity_of(scene: Scene, worlds: EntryWorlds) -> Vec:
    """Return the sum of the accelerations of all gravity in a scene."""
    pulls = [_pull(worlds.at("forces", i), force) for i, force in enumerate(scene.forces) if force.type == "gravity"]
    return plus((ZERO,) * scene.dimension, *pulls)


def _pull(world: World, force: Force) -> Vec:
    return _vector(world, force.acceleration, force.direction, "acceleration", downward=True)


def _damper(world: World, force: Force) -> Expr:
    """Return the dissipation d/2 (dl/dt)^2 of a linear or torsional damper."""
    damping = needed(world, force.damping, "damping", "of a damper")
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
    """Return the angle between the two planar bodies of a torsion spring or damper; None for other forces."""
    names = [e for e in force.between or () if isinstance(e, str) and e in (*world.frames, GROUND)]
    if len(names) != 2 or world.dimension != 2:
        return None
    first, second = (world.frame(name, "between") for name in names)
    return second.angle - first.angle


def _vector(world: World, value: object, direction: object, key: str, downward: bool) -> Vec:
    """Return a vector from components, or from size and direction (if ``downward``: the last axis, negative)."""
    d = world.dimension
    zero: Vec = (ZERO,) * d
    if isinstance(value, tuple):
        if len(value) != d:
            world.fault(f"this vector has {len(value)} components, and the dimension of the scene is {d}", key)
            return zero
        return tuple(moving(world, part, key, i) for i, part in enumerate(value))
    size = needed(world, value, key, "of gravity" if downward else "of a force")
    if direction is None:
        if not downward and d > 1:
            world.fault("the `direction` of the force is missing", hint="or give its components as `value`")
            return zero
        return (*(ZERO,) * (d - 1), -size if downward else size)
    if not isinstance(direction, tuple) or len(direction) != d:
        world.fault(f"a direction has {d} components here", "direction")
        return zero
    along = tuple(moving(world, part, "direction", i) for i, part in enumerate(direction))
    if all(part.is_zero for part in along):
        world.fault("a direction cannot be zero", "direction")
        return zero
    return scaled(size / length(along), along)


def _place(point: Placed) -> Vec:
    return tuple(part / point.under for part in point.over)


#: The beginning of the name of a parameter for a missing mass or inertia; an error if the motion depends on it.
MISSING = "_missing "


@dataclass
class EntryWorlds:
    """Makes a `World` for each entry that is read, so that faults have the entry's path, and collects the faults."""

    drawing: Drawing
    _worlds: list[World] = field(default_factory=list)

    def at(self, *here: str | int) -> World:
        """Return the world of the entry at a path."""
        self._worlds.append(World(self.drawing, here))
        return self._worlds[-1]

    @property
    def faults(self) -> tuple[Fault, ...]:
        """The faults of all entries, in the order of reading."""
        return tuple(fault for world in self._worlds for fault in world.faults)


def moving(world: World, value: object, *where: str | int) -> Expr:
    """Return a number or text, which may mention velocities, as an expression; 0 after a fault."""
    if isinstance(value, (str, Fraction)):
        return world.expression(value, *where, allow=MOVING)
    world.fault("one value is needed here, not a list", *where, hint="write a number or a text")
    return ZERO


def needed(world: World, value: object, key: str, what: str) -> Expr:
    """Return a required value as `moving` does; 0, with a fault, if it is None."""
    if value is None:
        world.fault(f"the `{key}` {what} is missing", hint=f"write `{key}:` with a number or a parameter")
        return ZERO
    return moving(world, value, key)


def mass(world: World, value: object, key: str, name: str) -> Expr:
    """Return a mass or an inertia as an expression; for None the parameter that marks it as missing."""
    return ex.parameter(f"{MISSING}{key} of {name}") if value is None else moving(world, value, key)


def masses(scene: Scene, worlds: EntryWorlds) -> Iterator[tuple[World, Expr, tuple[str, ...]]]:
    """Yield (world, mass, coordinates of the position) of every particle, then of every body."""
    table = worlds.drawing.vocabulary.table
    for i, particle in enumerate(scene.particles):
        world = worlds.at("particles", i)
        yield world, mass(world, particle.mass, "mass", particle.name), table.particles[particle.name]
    for i, body in enumerate(scene.bodies):
        world = worlds.at("bodies", i)
        yield world, mass(world, body.mass, "mass", body.name), table.bodies[body.name][: worlds.drawing.dimension]


def missing(symbols: frozenset[Expr], scene: Scene) -> list[Fault]:
    """Return a fault for every missing mass or inertia among ``symbols``, at the particle or body."""
    named = sorted(str(s.args[1]).removeprefix(MISSING) for s in symbols if str(s.args[1]).startswith(MISSING))
    where: dict[str, tuple[str | int, ...]] = {p.name: ("particles", i) for i, p in enumerate(scene.particles)}
    where.update({b.name: ("bodies", i) for i, b in enumerate(scene.bodies)})
    hint = "give it, or `energies: {kinetic: ...}`"
    return [Fault(f"the {name} is missing", where.get(name.rpartition(" ")[2], ()), hint=hint) for name in named]
