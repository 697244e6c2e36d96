"""Lagrange's equations of a scene rechecked, on what its relations leave.

The energies and forces are read from the scene's texts, or from masses, springs, dampers, gravity and forces:
L = T - V, with T = sum m v.v/2 + w.J w/2 (each body's centre of mass at its origin, J in its axes) where no text gives
it, V of springs and gravity, Rayleigh's D of dampers. A force F at r pushes along q by F . dr/dq.
"""

from collections.abc import Iterator
from typing import Any

from dofkit.checker.constraints import Entry, known_fields
from dofkit.checker.evidence import CheckedEvidence, Told
from dofkit.checker.geometry import Vector, dot, length, less, scaled, square
from dofkit.checker.problem import CheckedProblem
from dofkit.checker.trees import HALF, ONE, ZERO, Tree, add, along, call, derivative, refuse, substituted, symbol

#: What pulls, and the fields that it has.
ENTRIES = {
    "spring": "between stiffness rest_length",
    "damper": "between damping",
    "gravity": "acceleration direction",
    "force": "point body value direction",
}


class CheckedEnergies:
    """The ``lagrangian`` of a scene, its ``dissipation`` D, and ``pushes``, the applied forces."""

    def __init__(self, problem: CheckedProblem) -> None:
        """Read the energies (``rates``: time derivatives) and pairs (force component, place or coordinate)."""
        self.scene, self.world, self.d = problem.scene, problem.world, problem.world.dimension
        self.text = problem.in_rates
        self.rates = {"t": ONE, **{q: symbol(f"{q}dot") for q in problem.coordinates}}
        self.rates |= {f"{q}dot": symbol(f"{q}ddot") for q in problem.coordinates}
        energies: Entry = self.scene.get("energies", {})
        known_fields(energies, "kinetic potential dissipation forces")
        pushed: Entry = energies.get("forces", {})
        refuse(not pushed.keys() <= {*problem.coordinates}, "a force names something that is not a coordinate")
        for entry in self.scene.get("forces", []):
            known_fields(entry, f"type name notes {ENTRIES[entry['type']]}")
        texts = {key: self.text(value) for key, value in energies.items() if key != "forces"}
        potential = texts.get("potential") or add(*self.of("spring"), *self.of("gravity"))
        self.lagrangian = (texts.get("kinetic") or add(*self.kinetic())) - potential
        self.dissipation = texts.get("dissipation") or add(*self.of("damper"))
        self.pushes = [(self.text(text), symbol(q)) for q, text in pushed.items()]
        self.pushes = self.pushes or [pair for pairs in self.of("force") for pair in pairs]

    def of(self, kind: str) -> list[Any]:
        """What all entries of a kind give."""
        read = {"spring": self.spring, "gravity": self.gravity, "damper": self.damper, "force": self.force}[kind]
        return [read(entry) for entry in self.scene.get("forces", []) if entry["type"] == kind]

    def masses(self) -> Iterator[tuple[Tree, Vector]]:
        """The mass (a symbol where it is left out) and the place of every particle and body."""
        places = {name: point.over for name, point in self.world.particles.items()}
        places |= {name: frame.position for name, frame in self.world.frames.items()}
        for entry in (*self.scene.get("particles", []), *self.scene.get("bodies", [])):
            yield self.text(entry.get("mass", symbol(f"mass of {entry['name']}"))), places[entry["name"]]

    def kinetic(self) -> Iterator[Tree]:
        """m v.v/2 of all, and w.J w/2 of bodies; an inertia is a number, three moments, or three rows."""
        for mass, place in self.masses():
            yield HALF * mass * square([self.rates[str(q.value)] for q in place])
        for entry in self.scene.get("bodies", []) if self.d > 1 else ():
            spin, inertia = self.spin(entry["name"]), entry.get("inertia", symbol(f"inertia of {entry['name']}"))
            for w, row in zip(spin, inertia if isinstance(inertia, list) else [inertia] * len(spin), strict=True):
                whole = isinstance(row, list)
                yield HALF * w * (dot([*map(self.text, row)], spin) if whole else self.text(row) * w)

    def spin(self, body: str) -> Vector:
        """The angular velocity; in space by its components in the body's axes."""
        angles = list(self.world.frames[body].reference)[self.d :]
        rates = [self.rates[q] for q in angles]
        if self.d == 2:
            return tuple(rates)
        tilt, (_, theta, psi) = rates[0] * call("sin", symbol(angles[1])), map(symbol, angles)
        s, c = call("sin", psi), call("cos", psi)
        turned = tilt * s + rates[1] * c, tilt * c - rates[1] * s
        return *turned, rates[0] * call("cos", theta) + rates[2]

    def extent(self, entry: Entry) -> tuple[Tree, Tree | None]:
        """How far two points are apart, now and at the reference; of bodies of the plane the angle between them."""
        ends, frames = entry["between"], self.world.frames
        if self.d == 2 and all(isinstance(end, str) and end in frames for end in ends):
            return frames[ends[1]].angle - frames[ends[0]].angle, ZERO
        first, second = map(self.world.point, ends)
        drawn = length(less(second.start, first.start)) if first.start and second.start else None
        return length(less(second.place, first.place)), drawn

    def spring(self, entry: Entry) -> Tree:
        """k (d - d0)^2/2, d0 as it is drawn where it is not given."""
        now, drawn = self.extent(entry)
        rest_length = self.text(entry.get("rest_length", drawn))
        return HALF * self.text(entry["stiffness"]) * (now - rest_length) ** 2

    def damper(self, entry: Entry) -> Tree:
        """c ddot^2/2."""
        return HALF * self.text(entry["damping"]) * along(self.rates, self.extent(entry)[0]) ** 2

    def gravity(self, entry: Entry) -> Tree:
        """-sum m g.r."""
        pull = self.vector(entry, "acceleration", -ONE)
        return -add(*(mass * dot(pull, place) for mass, place in self.masses()))

    def force(self, entry: Entry) -> list[tuple[Tree, Tree]]:
        """A force, at a point or at the origin of a body."""
        body = self.world.frames[entry["body"]].position if "body" in entry else ()
        place = self.world.point(entry["point"]).place if "point" in entry else body
        return list(zip(self.vector(entry, "value", ONE), place, strict=True))

    def vector(self, entry: Entry, key: str, last: Tree) -> Vector:
        """A vector from its components, or from its size and direction (the last axis, or down)."""
        written, axis = entry[key], entry.get("direction")
        listed = isinstance(written, list)
        refuse(key == "value" and self.d > 1 and axis is None and not listed, "no direction is given")
        texts = written if listed else axis or [*[ZERO] * (self.d - 1), last]
        components = tuple(map(self.text, texts))
        refuse(len(components) != self.d, "a vector has as many components as space")
        return components if texts is written else scaled(self.text(written) / length(components), components)


#: What a claim tells: the fields of a report of the motion.
FIELDS = ("coordinates", "lagrangian", "momenta", "forces", "equations", "constraints", "multipliers", "eliminated")


def motion(evidence: CheckedEvidence, claim: Told, verified: Told) -> Told:
    """Lagrange's equations where the eliminated coordinates are functions of those kept, up to factors that are not 0.

    Let M be where they are and the given constraints hold: as is checked, all that the relations allow near a point,
    and what does no work on it are multiples of these constraints (of those nonlinear in velocities: of their slopes
    by these). So d/dt dL/dqdot - dL/dq + dD/dqdot less all pushes are such multiples, L and D put in [Lagrange1788].
    """
    claimed, problem = claim["value"], evidence.problem
    energies, kept, names = CheckedEnergies(problem), claimed["coordinates"], claimed["multipliers"]
    extra = [*names, *claim.get("constants", {}), *(f"{q}ddot" for q in kept)]
    refuse(claim.get("cayley"), "a body turns by its angles here")
    twice = len({*extra}) < len(extra) or any(map(evidence.is_taken, extra))
    refuse(twice, "a multiplier, a constant or an acceleration has the name of another")
    every = sorted([*kept, *claimed["eliminated"]])
    refuse(every != sorted(problem.coordinates), "each coordinate is kept or eliminated")

    def read(text: str) -> Tree:
        return evidence.text(text.removesuffix("= 0"), extra)

    places = {q: read(text) for q, text in claimed["eliminated"].items()}
    put = {"tdot": ONE, **places, **{f"{q}dot": along(energies.rates, tree) for q, tree in places.items()}}
    dependent = [tree for tree in places.values() if evidence.met_by(tree) or not tree.symbols.isdisjoint(put)]
    refuse(dependent, "a coordinate is eliminated by such, or by velocities")
    limits = {name: read(text) for name, text in zip(names, claimed["constraints"], strict=True)}
    _check_elimination(evidence, claim, put, places, limits)
    lagrangian, lost = (substituted(tree, put) for tree in (energies.lagrangian, energies.dissipation))
    pushes = [(substituted(force, put), substituted(place, put)) for force, place in energies.pushes]
    whole = read(claimed["lagrangian"])
    evidence.identity(whole, lagrangian, "the Lagrangian")
    for q, text in zip(kept, claimed["equations"], strict=True):
        rate, momentum, force = f"{q}dot", read(claimed["momenta"][q]), read(claimed["forces"][q])
        work = [push * derivative(place, q) for push, place in pushes]
        outer = add(*work, -derivative(lost, rate))
        evidence.identity(momentum, derivative(whole, rate), f"the momentum of {q}")
        evidence.identity(force, derivative(whole, q) + outer, f"the force along {q}")
        ways = {name: derivative(limit, rate if evidence.met_by(limit) else q) for name, limit in limits.items()}
        held = add(*(symbol(name) * slope for name, slope in ways.items()))
        factor = evidence.text(claim.get("factors", {}).get(q, "1"))
        refuse(not evidence.is_nowhere_zero(factor), f"the factor of the equation of {q} may be 0")
        equation = along(energies.rates, momentum) - (force + held)
        evidence.identity(factor * read(text), equation, f"the equation of {q}")
    fields = {part: {q: claimed[part][q] for q in kept} for part in ("momenta", "forces")}
    return {name: fields.get(name, claimed[name]) for name in FIELDS}


def _check_elimination(evidence: CheckedEvidence, claim: Told, put: Told, places: Told, limits: Told) -> None:
    """Raise `CheckError` unless the set of the claim is all that the relations of the scene allow near a point.

    ``places``: what each eliminated coordinate is; ``put``: the same with its rates, to be put in; ``limits``: the
    constraints that remain, by name. With ``put`` every relation is a combination of the remaining constraints, so the
    set is part of what the relations allow. As many relations as there are eliminated coordinates and remaining
    constraints are independent at a point of it, so both have the same dimension there.
    """
    used = list[Tree]()
    for checked in map(evidence.relation, evidence.equations):
        factors = {name: evidence.text(text) for name, text in claim.get("c", {}).get(checked.name, {}).items()}
        moving = [*factors.values(), *(limits[name] for name in factors if checked.kind == "finite")]
        refuse(any(map(evidence.met_by, moving)), "a cofactor holds velocities, or a holonomic equation rests on such")
        total = add(*(tree * limits[name] for name, tree in factors.items()))
        evidence.identity(substituted(checked.tree, put), total, f"`{checked.name}` where coordinates are put in")
        used += factors.values()
    if places or limits:
        minor = evidence.minor(claim["minor"])
        evidence.is_about("here", minor.point)
        refuse(len(minor.rows) != len(places) + len(limits), "a row for each elimination and constraint is needed")
        chosen = {name: evidence.text(text) for name, text in claim.get("constants", {}).items()}
        met = [symbol(q) - substituted(tree, chosen) for q, tree in places.items()]
        met += [tree for tree in limits.values() if not evidence.met_by(tree)]
        missed = [tree for tree in met if not evidence.is_zero(tree, minor.point)]
        refuse(missed, "the point does not satisfy the claimed relations")
        for tree in used:
            minor.point.value(tree)
