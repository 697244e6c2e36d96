"""Lagrange's equations of a scene rechecked, on what its relations leave.

The energies are those that the scene gives as texts: L = T - V, Rayleigh's D, and forces along coordinates.
"""

from typing import Any

from dofkit.checker.constraints import Entry, known_fields
from dofkit.checker.evidence import CheckedEvidence, Told
from dofkit.checker.grammar import parse
from dofkit.checker.problem import CheckedProblem
from dofkit.checker.trees import ONE, Tree, add, along, derivative, homogeneous_degree, refuse, substituted, symbol


class CheckedEnergies:
    """The Lagrangian of a scene, its ``dissipation``, and ``pushes``: forces and where they act, part by part.

    ``rates``: the derivatives of coordinates, velocities and time.
    """

    def __init__(self, problem: CheckedProblem) -> None:
        self.names, energies = problem.world.names, problem.scene.get("energies", {})
        self.rates = {"t": ONE, **{q: symbol(f"{q}dot") for q in problem.coordinates}}
        self.rates |= {f"{q}dot": symbol(f"{q}ddot") for q in problem.coordinates}
        known_fields(energies, "kinetic potential dissipation forces")
        refuse("kinetic" not in energies or "forces" in problem.scene, "energies and forces are not all texts")
        pushed: Entry = energies.get("forces", {})
        refuse(not pushed.keys() <= {*problem.coordinates}, "a force pushes along what is no coordinate")
        kinetic, potential, self.dissipation = (
            self.text(energies.get(key, "0")) for key in ("kinetic", "potential", "dissipation")
        )
        self.lagrangian = kinetic - potential
        self.pushes = [(self.text(text), symbol(q)) for q, text in pushed.items()]

    def text(self, value: Any) -> Tree:
        """A number or text, in which velocities may occur."""
        tree = parse(value, self.names)
        refuse(homogeneous_degree(tree, ["dt"]) != 0, "an energy holds differentials")
        return substituted(tree, {"dt": ONE})


#: What a claim tells: the fields of a report of the motion.
MOTION_FIELDS = (
    "coordinates",
    "lagrangian",
    "momenta",
    "forces",
    "equations",
    "constraints",
    "multipliers",
    "eliminated",
)


def motion(evidence: CheckedEvidence, claim: Told, verified: Told) -> Told:
    """Lagrange's equations where the eliminated coordinates are functions of those kept, up to factors that are not 0.

    Let M be where they are, and the told constraints hold. By `_leaves` M is all that the relations allow near a point,
    and what does no work on it are multiples of the told constraints (of those nonlinear in velocities: of their slopes
    by these). So d/dt dL/dqdot - dL/dq + dD/dqdot less all pushes are such multiples, L and D put in [Lagrange1788].
    """
    claimed, problem = claim["value"], evidence.problem
    energies, kept, names = CheckedEnergies(problem), claimed["coordinates"], claimed["multipliers"]
    extra = [*names, *claim.get("constants", {}), *(f"{q}ddot" for q in kept)]
    taken = {*evidence.variables, *evidence.velocities, *evidence.chosen, *problem.world.names.words, "E"}
    refuse(claim.get("cayley"), "a body turns by its angles here")
    refuse(len({*extra} - taken) < len(extra), "a multiplier, a constant or an acceleration has the name of another")
    every = sorted([*kept, *claimed["eliminated"]])
    refuse(every != sorted(problem.coordinates), "each coordinate is kept or eliminated")

    def read(text: str) -> Tree:
        return evidence.text(text.removesuffix("= 0"), extra)

    places = {q: read(text) for q, text in claimed["eliminated"].items()}
    put = {"tdot": ONE, **places, **{f"{q}dot": along(energies.rates, tree) for q, tree in places.items()}}
    dependent = [tree for tree in places.values() if evidence.met_by(tree) or not tree.symbols.isdisjoint(put)]
    refuse(dependent, "a coordinate is eliminated by such, or by velocities")
    limits = {name: read(text) for name, text in zip(names, claimed["constraints"], strict=True)}
    _leaves(evidence, claim, put, places, limits)
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
    return {name: fields.get(name, claimed[name]) for name in MOTION_FIELDS}


def _leaves(evidence: CheckedEvidence, claim: Told, put: Told, places: Told, limits: Told) -> None:
    """`CheckError` unless the set of the claim is all that the relations of the scene allow near a point.

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
