"""Rules for numbers: how many freedoms there are near a point, and what depends on what.

A rule looks at the evidence of a claim and gives the value that it shows.
"""

from collections.abc import Collection
from itertools import chain

from flint import fmpq_mat

from dofkit.checker.curves import LEAST, MOST
from dofkit.checker.evidence import CheckedEvidence, CheckedMinor, Told, field_named, independent, span
from dofkit.checker.point import CheckedPoint, not_zero
from dofkit.checker.trees import refuse


def bounds(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """dof near a point, between two bounds; or that and velocity_dof, where one minor is both."""
    path, size = claim["path"], len(evidence.problem.coordinates)
    both = claim["rule"] == "regular"
    most, least = ({**claim, "rule": "minor"}, claim) if both else (claim["most"], claim["least"])
    minor = MOST[most["rule"]](evidence, most) if path == "/dof" else evidence.minor(most["minor"])
    above = size - len(minor.rows) - (len(most["speeds"]) if most["rule"] == "isolated" else 0)
    if least["rule"] == "span":
        point, lower = span(evidence, {"minor": most["minor"], **least})
    else:
        other, more = LEAST[least["rule"]](evidence, least)
        point, lower = other.point, size - len(other.rows) + more
    refuse(point is not minor.point or above != lower, f"{lower} at least and {above} at most, or of two points")
    verified[f"{path} at"] = evidence.is_about(claim["about"], point)
    return lower


def instantaneous(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """Return n - rank of all rows at the point: by rational arithmetic, or by a nonzero minor that has every row."""
    names, point, size = evidence.equations, evidence.point(claim["at"]), len(evidence.problem.coordinates)
    evidence.is_about("reference", point)
    evidence.on_set(point, names)
    refuse(not all(map(evidence.is_linear, names)), "a relation is not linear in the velocities")
    if "minor" in claim:
        minor = evidence.minor(claim["minor"])
        refuse(minor.point is not point or set(minor.rows) != set(names), "the minor is not of all relations there")
        return size - len(names)
    slopes = [evidence.slope(name, q) for name in names for q in evidence.problem.coordinates]
    entries = [evidence.ring.rational(evidence.at_reference(tree)) for tree in slopes if point.value(tree) is not None]
    refuse(None in entries, "the rows are not rational at the point")
    evidence.effort.spend(len(entries) * len(names))
    return size - (fmpq_mat(len(names), size, entries).rank() if entries else 0)


def counted(evidence: CheckedEvidence, claim: Told, verified: Told) -> object:
    """A number or a label that others imply, which were verified."""
    path, equations = claim["path"], len(evidence.equations)
    if path == "/redundant_equations":
        return max(0, equations - len(evidence.problem.coordinates) + verified["/velocity_dof"])
    if path == "/singular":
        return bool(verified["/instantaneous_dof"] != verified["/velocity_dof"])
    if path == "/velocity_dof":
        about = verified["/dof about"]
        refuse(evidence.moving or claim.get("about", about) != about, "there are velocity relations, or other points")
        return verified["/dof"]
    if path == "/redundancies":
        return _groups(evidence, claim, verified)
    if path == "/generalized_coordinates":
        refuse(verified["/dof"] != 0, "coordinates are needed: dof is not 0")
        return []
    labels = [verified.get(f"{path[1:]} {owner}") for owner in owners(evidence)]
    refuse(None in labels and False not in labels, "nothing that was verified decides this")
    return False not in labels


def _groups(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[Told]:
    """What depends on what: nothing; a circuit where one equation is too many; all, where without any one nothing.

    So it is where what is redundant was verified at the same point: there the dependent equation is a regular one.
    The circuit was verified, or is that ``of`` a constraint which may be written before others.
    """
    if "of" in claim:
        (group,) = claim["value"]
        members = [name for name in group["members"] if name != claim["of"]]
        dependence = {**claim, "owner": claim["of"], "value": members}
        verified[f"circuit {claim['of']}"] = circuit(evidence, dependence, verified)
    surplus, removable = verified["/redundant_equations"], verified if "/redundant" in verified else {}
    place = removable.get("at /redundant", object())
    constrained = [owner for owner in owners(evidence) if evidence.owned(owner)]
    whole = len(constrained) == 1 or "apart" in removable
    tied = [owner for owner in constrained if verified.get(f"at circuit {owner}") == place]
    around = [{*constrained}] if whole else [{owner, *verified[f"circuit {owner}"]} for owner in tied]
    refuse(surplus and (len(around) != 1 or (surplus > 1 and not whole)), "several groups, or none that is shown")
    return [{"nullity": surplus, "members": [owner for owner in constrained if owner in around[0]]}] if surplus else []


def owners(evidence: CheckedEvidence) -> list[str]:
    """The constraints with relations, in order."""
    return list(dict.fromkeys(relation.owner for relation in evidence.problem.relations))


def names_told(claim: Told) -> list[str]:
    """The claim's value as a list of names, each once."""
    value: list[str] = claim["value"]
    texts = type(value) is list and {*map(type, value)} <= {str}
    refuse(not texts or len({*value}) < len(value), "the value is a list of names, each once")
    return value


def circuit(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[str]:
    """Those named imply the constraint near a point of all; without any one, a row of it is independent."""
    names, point, dependent = names_told(claim), evidence.point(claim["at"]), evidence.owned(claim["owner"])
    members = {*chain(*map(evidence.owned, names))}
    before = owners(evidence)[: owners(evidence).index(claim["owner"])]
    late = claim["field"] == "circuit" and not set(names) <= set(before)
    refuse(not dependent or late, "a circuit holds constraints that were written before")
    verified[f"at circuit {claim['owner']}"] = evidence.is_about("here", point)
    evidence.on_set(point, {*evidence.finite, *members, *dependent})
    evidence.follow(dependent, members, point, "the circuit")
    for name in names:
        others = members.difference(evidence.owned(name))
        minor = evidence.minor(claim["minimal"][name]["minor"], {*others, *dependent})
        apart = minor.point is point and _rank(evidence, minor, others) < len(minor.rows)
        refuse(not apart, "no row is independent of the other members, or at another point")
    return names


def _rank(evidence: CheckedEvidence, minor: CheckedMinor, names: Collection[str]) -> int:
    """How many rows of a minor follow from relations, which follow from them in turn."""
    implied = evidence.closure(names, minor.point)
    rows = tuple(row for row in minor.rows if row in implied and not evidence.relation(row).leaf)
    return len(evidence.accounts(minor._replace(rows=rows), names).rows)


def independence(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """How many equations a constraint adds to those before it; geometric equations come before those of velocities.

    For the last geometric constraint the rank after it may be taken as n - dof, where the dof was verified there.
    """
    minor, order = evidence.minor(claim["minor"]), evidence.equations
    evidence.is_about("here", minor.point)
    evidence.on_set(minor.point, evidence.finite)
    equations_of_owner = [rows for kind in ("finite", "velocity") if (rows := evidence.owned(claim["owner"], {kind}))]
    refuse(not equations_of_owner, "the constraint has no equations")
    added = 0
    for rows in equations_of_owner:
        place = order.index(rows[0])
        before, upto = order[:place], order[: place + len(rows)]
        last = "last" in claim and "/dof at" in verified and not evidence.moving and upto == order
        after = verified_rank(evidence, minor.point, verified) if last else _rank(evidence, minor, upto)
        added += min(len(rows), after - _rank(evidence, minor, before))
    return added


def redundant(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[str]:
    """The constraints named follow from the others near the point, and no more could be dropped.

    No more: of E equations with r independent rows E - r can be spared at most, where what depends does so by numbers,
    or is a single relation that depends with cofactors none of which is 0. None is named where ``without`` any the rows
    that account for the others leave more than the dof (with velocity relations: of velocities) verified there.
    """
    dropped, every, whole = names_told(claim), set(evidence.equations), True
    order = [owner for owner in owners(evidence) if evidence.owned(owner)]
    if "without" in claim:
        number = "/velocity_dof" if evidence.moving else "/dof"
        for name in order:
            others = every.difference(evidence.owned(name))
            minor = evidence.accounts(evidence.minor(claim["without"][name]), others)
            evidence.on_set(minor.point, evidence.finite)
            whole &= others == {*minor.rows}
            rank = verified_rank(evidence, minor.point, verified, number)
            refuse(rank <= len(minor.rows), f"`{name}` may be dropped")
        verified |= {"apart": True} if whole else {}
        return []
    minor = evidence.accounts(evidence.minor(claim["minor"]), evidence.equations)
    refuse(not set(dropped) <= set(order) or not set(minor.rows) <= every, "no constraints, or rows of no relations")
    implied = {*chain(*map(evidence.owned, dropped))}
    evidence.follow(implied, every - implied, minor.point, "what is kept")
    _depend_plainly(evidence, minor, every - set(minor.rows))
    verified["at /redundant"] = evidence.is_about("here", minor.point)
    sizes, spared = sorted(len(evidence.owned(owner)) for owner in order), len(every) - len(minor.rows)
    most = sum(1 for i in range(len(sizes)) if sum(sizes[: i + 1]) <= spared)
    refuse(len(dropped) != most, f"{len(dropped)} constraints are named, and {most} might be dropped")
    return dropped


def _depend_plainly(evidence: CheckedEvidence, minor: CheckedMinor, others: set[str]) -> None:
    """`CheckError` unless the ``others`` depend on the rows of the minor wherever they are satisfied, near its point.

    A relation that is a combination of rows, or of their rates, with constant coefficients is dependent everywhere. One
    relation alone may have coefficients that are functions, not 0 at the point: then row and relation can be exchanged
    near it. Where every relation is linear or has a generic length that no other has, all ranks are constant near
    almost every point, and there is nothing to check.
    """
    slopes = ((n, [evidence.slope(n, q) for q in evidence.problem.coordinates]) for n in evidence.finite)
    general = (None not in map(evidence.ring.rational, row) or evidence.own_symbol(n) for n, row in slopes)
    if not others or (not evidence.moving and all(general)):
        return
    rates = (step.target for step in evidence.consequences if step.is_rate and {*step.sources} <= {*minor.rows})
    rows = {*minor.rows, *rates}
    for name in others:
        used = [
            (*step.defined, *step.nonzero)
            for i, step in enumerate(evidence.consequences)
            if step.target == name and step.defined and {*step.sources} <= rows
            if evidence.applies(i, minor.point)
        ]
        plain = any(not any(tree.symbols for tree in trees) for trees in used)
        single = len(others) == 1 and any(all(not_zero(minor.point.value(t)) for t in trees) for trees in used)
        refuse(not plain and not single, f"`{name}` does not depend on the rows by numbers")


def verified_rank(evidence: CheckedEvidence, point: CheckedPoint, verified: Told, number: str = "/dof") -> int:
    """Return n - dof (or another number), if that was verified at this point."""
    place = evidence.is_about("here", point)
    refuse(verified.get(f"{number} at") not in (None, place), "dof was verified at another point")
    return len(evidence.problem.coordinates) - int(verified[number])


def generalized_coordinates(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[str]:
    """All other coordinates are functions of these near the point, whose number is dof there.

    Angles of a body with Cayley parameters stand for these. Where fields carry an ``isolated`` point to all that there
    is around, they are independent in these coordinates.
    """
    minor, world, names = MOST[claim["rule"]](evidence, claim), evidence.problem.world, names_told(claim)
    moved, rank, fields = world.charted(names), len(minor.rows), claim["rule"] == "isolated"
    if fields:
        rank += len(claim["speeds"])
        independent(evidence, [field_named(evidence, name) for name in claim["fields"]], moved, minor.point)
    whole = fields or sorted((*minor.columns, *moved)) == sorted(evidence.problem.coordinates)
    whole &= world.names.coordinates.union(*world.angles.values()).issuperset(names)
    refuse(not whole, "the columns of the minor are not all the other coordinates")
    refuse(verified_rank(evidence, minor.point, verified) != rank, "their number is not a verified dof")
    evidence.on_set(minor.point, evidence.finite)
    return names


def growth(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[int]:
    """Check that each entry is spanned from below and bounded from above; return the growth vector.

    From below by words; from above by fields and their brackets, or by the dimension of all.
    Directions are those of (q, t) where a constraint was verified to be rheonomic or not catastatic.
    """
    labels = [f"{field} {owner}" for field in ("scleronomic", "catastatic") for owner in owners(evidence)]
    refuse(evidence.timed and not any(verified.get(label) is False for label in labels), "time may be divided out")
    minor = evidence.accounts(evidence.minor(claim["minor"]), evidence.equations)
    whole = len(evidence.problem.coordinates) - verified_rank(evidence, minor.point, verified) + evidence.timed
    refuse(not evidence.moving or not all(map(evidence.is_linear, minor.rows)), "a growth vector is of forms")
    rank, vector = len(evidence.problem.coordinates) + evidence.timed - len(minor.rows), list[int]()
    for step, entry in enumerate(claim["spans"], 1):
        point, reached = span(evidence, {**claim, **entry}, step)
        most = min(whole, (rank, rank * (rank + 1) // 2, whole)[min(step, 3) - 1])
        here = point is minor.point and reached + evidence.timed == most
        refuse(not here, f"entry {step} is not {most}, or not there")
        vector.append(most)
    refuse(vector[-1] != whole and (len(vector) < 2 or vector[-1] != vector[-2]), "the last entry is not the whole")
    return vector
