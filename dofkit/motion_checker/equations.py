"""Lagrange's equations of a scene rechecked, on what its relations leave: one rule more for the checker."""

from dofkit.checker.evidence import CheckedEvidence, Told
from dofkit.checker.trees import MINUS, ONE, Tree, add, difference, refuse, symbol, times
from dofkit.checker.values import along, derivative, substituted
from dofkit.checker.verification import RULES
from dofkit.motion_checker.energies import CheckedEnergies

#: What a claim tells: the fields of a report of the motion.
TOLD = ("coordinates", "lagrangian", "momenta", "forces", "equations", "constraints", "multipliers", "eliminated")


def motion(evidence: CheckedEvidence, claim: Told, verified: Told) -> Told:
    """Lagrange's equations where the eliminated coordinates are functions of those kept, up to factors that are not 0.

    Let M be where they are, and the told constraints hold. By `_leaves` M is all that the relations allow near a point,
    and what does no work on it are multiples of the told constraints (of those nonlinear in velocities: of their slopes
    by these). So d/dt dL/dqdot - dL/dq + dD/dqdot less all pushes are such multiples, L and D put in [Lagrange1788].
    """
    told, problem = claim["value"], evidence.problem
    energies, kept, names = CheckedEnergies(problem), told["coordinates"], told["multipliers"]
    extra = [*names, *claim.get("constants", {}), *(f"{q}ddot" for q in kept)]
    taken = {*evidence.variables, *evidence.velocities, *evidence.chosen, *problem.world.names.words, "E"}
    refuse(claim.get("cayley"), "a body turns by its angles here")
    refuse(len({*extra} - taken) < len(extra), "a multiplier, a constant or an acceleration has the name of another")
    refuse(sorted([*kept, *told["eliminated"]]) != sorted(problem.coordinates), "each coordinate is kept or eliminated")

    def read(text: str) -> Tree:
        return evidence.text(text.removesuffix("= 0"), extra)

    places = {q: read(text) for q, text in told["eliminated"].items()}
    put = {"tdot": ONE, **places, **{f"{q}dot": along(energies.rates, tree) for q, tree in places.items()}}
    own = [tree for tree in places.values() if evidence.met_by(tree) or not tree.symbols.isdisjoint(put)]
    refuse(own, "a coordinate is eliminated by such, or by velocities")
    limits = {name: read(text) for name, text in zip(names, told["constraints"], strict=True)}
    _leaves(evidence, claim, put, places, limits)
    lagrangian, lost = (substituted(tree, put) for tree in (energies.lagrangian, energies.dissipation))
    pushes = [(substituted(force, put), substituted(place, put)) for force, place in energies.pushes]
    whole = read(told["lagrangian"])
    for q, text in zip(kept, told["equations"], strict=True):
        rate, momentum, force = f"{q}dot", read(told["momenta"][q]), read(told["forces"][q])
        for name in (q, rate):
            evidence.identity(derivative(whole, name), derivative(lagrangian, name), f"the Lagrangian, by {name}")
        outer = add(
            *(times(push, derivative(place, q)) for push, place in pushes), times(MINUS, derivative(lost, rate))
        )
        evidence.identity(momentum, derivative(whole, rate), f"the momentum of {q}")
        evidence.identity(force, add(derivative(whole, q), outer), f"the force along {q}")
        ways = {name: derivative(one, rate if evidence.met_by(one) else q) for name, one in limits.items()}
        held = add(*(times(symbol(name), slope) for name, slope in ways.items()))
        factor = evidence.text(claim.get("factors", {}).get(q, "1"))
        refuse(not evidence.is_nowhere_zero(factor), f"the factor of the equation of {q} may be 0")
        equation = difference(along(energies.rates, momentum), add(force, held))
        evidence.identity(times(factor, read(text)), equation, f"the equation of {q}")
    parts = {part: {q: told[part][q] for q in kept} for part in ("momenta", "forces")}
    return {name: parts.get(name, told[name]) for name in TOLD}


def _leaves(evidence: CheckedEvidence, claim: Told, put: Told, places: Told, limits: Told) -> None:
    """`CheckError` unless the told set is all that the relations allow near a point.

    They are all multiples of the told constraints on it, and as many as there are eliminated coordinates and told
    constraints are independent at a point of it: it has the dimension of what they allow.
    """
    used = list[Tree]()
    for one in map(evidence.relation, evidence.equations):
        factors = {name: evidence.text(text) for name, text in claim.get("c", {}).get(one.name, {}).items()}
        moving = [*factors.values(), *(limits[name] for name in factors if one.kind == "finite")]
        refuse(
            any(map(evidence.met_by, moving)),
            "a cofactor contains velocities, or a holonomic equation depends on others",
        )
        total = add(*(times(tree, limits[name]) for name, tree in factors.items()))
        evidence.identity(substituted(one.left, put), total, f"`{one.name}` where coordinates are put in")
        used += factors.values()
    if places or limits:
        minor = evidence.minor(claim["minor"])
        evidence.is_about("here", minor.point)
        refuse(
            len(minor.rows) != len(places) + len(limits),
            "one row for each eliminated coordinate and claimed constraint is needed",
        )
        chosen = {name: evidence.text(text) for name, text in claim.get("constants", {}).items()}
        met = [difference(symbol(q), substituted(tree, chosen)) for q, tree in places.items()]
        met += [tree for tree in limits.values() if not evidence.met_by(tree)]
        refuse(
            not all(evidence.is_zero(tree, minor.point) for tree in met),
            "the point does not satisfy the claimed relations",
        )
        for tree in used:
            minor.point.value(tree)


#: The checker's rules, and this one.
MOTION_RULES = RULES | {("/motion", "lagrange"): motion}
