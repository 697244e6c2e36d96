"""The energies of a scene: as written, or from its masses, inertias and forces.

T = sum m v.v/2 + w.J w/2, every body's centre of mass at its origin.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from dofkit.base.errors import Fault
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import HALF, ZERO, Expr
from dofkit.expressions.vectors import Vec, square
from dofkit.motion.lagrange.forces import PARTS, EntryWorlds, ForceReader, Numbered, mass, masses, moving
from dofkit.scene.drawing import Drawing
from dofkit.scene.frames import Frame
from dofkit.scene.scene import Scene
from dofkit.scene.world import World


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
    worlds = EntryWorlds(drawing)
    return EnergyReader(scene, worlds).energy(), worlds.faults


@dataclass
class EnergyReader:
    """Reads the energies of a scene, each entry in its world; ``notes`` say what was taken for granted."""

    scene: Scene
    worlds: EntryWorlds
    notes: list[str] = field(default_factory=list)

    def energy(self) -> Energy:
        """The energies, and the forces by coordinate."""
        given = self.scene.energies
        world = self.worlds.at("energies")
        kinetic, potential, dissipation = (
            _text(world, getattr(given, key, None), key) for key in ("kinetic", "potential", "dissipation")
        )
        own = {} if given is None else given.forces
        forces = {name: moving(world, text, "forces", name) for name, text in own.items()}
        if kinetic is None:
            kinetic = ex.add(*self._kinetic())
            self._assumed_centres()
        reader = ForceReader(self.scene, self.worlds, self.notes)
        springs, dampers, applied = map(reader.entering, PARTS)
        if potential is None:
            potential = reader.potential(springs)
        elif springs:
            self._as_written("the potential energy", springs)
        if dissipation is None:
            dissipation = reader.dissipation(dampers)
        elif dampers:
            self._as_written("the dissipation function", dampers)
        if forces and applied:
            self._as_written("the generalized forces", applied)
        elif applied:
            forces = reader.applied(applied)
        return Energy(kinetic, potential, dissipation, forces, tuple(self.notes))

    def _as_written(self, what: str, entries: Sequence[Numbered]) -> None:
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
            yield HALF * m * _speed_squared(names)
            if body is not None and world.dimension > 1:
                yield _turning(world, body.inertia, world.frames[body.name])


def _text(world: World, text: object, key: str) -> Expr | None:
    return None if text is None else moving(world, text, key)


def _turning(world: World, inertia: object, frame: Frame) -> Expr:
    """w.J w/2 with J in the body's axes."""
    if frame.dimension == 2:
        rate = ex.velocity(frame.angles[0])
        return HALF * mass(world, inertia, "inertia", frame.name) * rate * rate
    return spin_energy(world, inertia, frame.name, body_spin(frame))


def spin_energy(world: World, inertia: object, name: str, spin: Vec) -> Expr:
    """s.J s/2 of the body of that name in space, with the spin s and J in its axes."""
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


def _speed_squared(names: tuple[str, ...]) -> Expr:
    return ex.add(*(ex.velocity(name) ** 2 for name in names))
