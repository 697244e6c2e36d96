"""Rules for numbers: how many freedoms, near a point and everywhere, and what depends on what.

A rule looks at the evidence of a claim and gives the value that it shows.
"""

from __future__ import annotations

from typing import Any

from flint import fmpq, fmpq_mat

from dofkit.checker.evidence import CheckedEvidence, CheckedMinor
from dofkit.checker.fields import Told, admissible, crossing, independent, involutive, isolated, of_word, span
from dofkit.checker.trees import refuse
from dofkit.checker.values import CheckedPoint, derivative, excludes_zero, symbols_in


def _finite_minor(evidence: CheckedEvidence, given: Told) -> CheckedMinor:
    minor = evidence.minor(given["minor"])
    moving = any(evidence.relation(row).kind != "finite" for row in minor.rows)
    refuse(moving, "a row of velocities does not reduce dof by itself")
    return minor


#: What shows how many freedoms there are at most: as many as coordinates less rows, or one less.
MOST = {"minor": _finite_minor, "frobenius": involutive, "isolated": isolated, "crossing": crossing}
CURVED = ("isolated", "crossing")


def bounds(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """dof or velocity_dof near a point, between two bounds."""
    path, size, one = claim["path"], len(evidence.problem.coordinates), {"minor": claim.get("minor")}
    most, least = claim.get("most", {**one, "rule": "minor"}), claim.get("least", {**one, "rule": "regular"})
    refuse(path != "/dof" and most["rule"] != "minor", "an upper bound of velocities is `minor`")
    minor = MOST[most["rule"]](evidence, most) if path == "/dof" else evidence.minor(most["minor"])
    above = size - len(minor.rows) - (most["rule"] in CURVED)
    if least["rule"] == "crossing":
        point, found = crossing(evidence, least).point, above
    elif least["rule"] == "regular":
        other = evidence.accounts(evidence.minor(least["minor"]), evidence.equations)
        point, found = other.point, size - len(other.rows)
    else:
        refuse(least["rule"] != "span", "a lower bound is `regular`, `span` or `crossing`")
        point, found = span(evidence, {"minor": most["minor"], **least}, 1 if path == "/velocity_dof" else 12)
    refuse(point is not minor.point or above != found, f"{found} at least and {above} at most, or of two points")
    evidence.is_about(claim["about"], point)
    verified[f"{path} at"] = "reference" if claim["about"] == "reference" else point.name
    return found


def instantaneous(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """n less the rank of all rows at the configuration: of rational rows, or of rows that are all in a minor."""
    names, point, size = evidence.equations, evidence.point(claim["at"]), len(evidence.problem.coordinates)
    evidence.is_about("reference", point)
    evidence.on_set(point, names)
    refuse(not all(map(evidence.is_linear, names)), "a relation is not linear in the velocities")
    if "minor" in claim:
        minor = evidence.minor(claim["minor"])
        refuse(minor.point is not point or set(minor.rows) != set(names), "the minor is not of all relations there")
        return size - len(names)
    slopes = [evidence.slope(name, q) for name in names for q in evidence.problem.coordinates]
    values = [evidence.ring.rational(evidence.at_reference(tree)) for tree in slopes if point.value(tree) is not None]
    entries = [fmpq(value.numerator, value.denominator) for value in values if value is not None]
    refuse(len(entries) < len(slopes), "the rows are not rational at the point")
    evidence.effort.spend(len(entries) * len(names))
    return size - (fmpq_mat(len(names), size, entries).rank() if entries else 0)


def counted(evidence: CheckedEvidence, claim: Told, verified: Told) -> object:
    """A number or a label that follows from others that were verified."""
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
        return _groups(evidence, verified)
    labels = [verified.get(f"/constraints/{escaped(owner)}{path}") for owner in owners(evidence)]
    refuse(None in labels and False not in labels, "nothing that was verified decides this")
    return False not in labels


def _groups(evidence: CheckedEvidence, verified: Told) -> list[Told]:
    """What depends on what: nothing, one constraint alone, or a circuit where one equation is too many."""
    surplus, known = verified["/redundant_equations"], [one for one in owners(evidence) if evidence.owned(one)]
    around = [{one, *verified[key]} for one in known if (key := f"/constraints/{escaped(one)}/circuit") in verified]
    around = [set(known)] if len(known) == 1 else around
    refuse(surplus and (len(around) != 1 or (surplus != 1 and len(known) > 1)), "several groups, or none that is shown")
    return [{"nullity": surplus, "members": [one for one in known if one in around[0]]}] if surplus else []


def escaped(name: str) -> str:
    """A name as a part of a path."""
    return name.replace("~", "~0").replace("/", "~1")


def owners(evidence: CheckedEvidence) -> list[str]:
    """The constraints with relations, in order."""
    return list(dict.fromkeys(one.owner for one in evidence.problem.relations))


def relations_of(evidence: CheckedEvidence, names: Any) -> tuple[str, ...]:
    """The equations of constraints."""
    return tuple(one for name in names for one in evidence.owned(name))


def names_told(claim: Told) -> list[str]:
    """The claim's value as a list of names, each once."""
    value = claim["value"]
    fine = isinstance(value, list) and all(isinstance(one, str) for one in value) and len(set(value)) == len(value)
    refuse(not fine, "the value is a list of names, each once")
    return list(value)


def circuit(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[str]:
    """The constraint follows from those named near a point of all; without any one, a row of it is independent."""
    names, point, own = names_told(claim), evidence.point(claim["at"]), evidence.owned(claim["owner"])
    before = owners(evidence)[: owners(evidence).index(claim["owner"])]
    refuse(not own or not set(names) <= set(before), "a circuit holds constraints that were written before")
    evidence.is_about("here", point)
    evidence.on_set(point, [*relations_of(evidence, names), *own])
    evidence.follow(own, relations_of(evidence, names), point, "the circuit")
    for name in names:
        others = relations_of(evidence, [other for other in names if other != name])
        minor = evidence.minor(claim["minimal"][name]["minor"], {*others, *own})
        rows = [row for row in minor.rows if row not in own]
        refuse(len(rows) == len(minor.rows) or minor.point is not point, "no row of the constraint, or another point")
        evidence.follow(rows, others, point, "the other members")
        evidence.follow(others, rows, point, "the rows of the minor")
    return names


def _rank(evidence: CheckedEvidence, minor: CheckedMinor, names: tuple[str, ...]) -> int:
    """How many rows of a minor follow from relations, which follow from them in turn."""
    known = evidence.closure(names, minor.point)
    rows = [row for row in minor.rows if row in known and not evidence.relation(row).leaf]
    evidence.on_set(minor.point, names)
    evidence.follow(names, rows, minor.point, "the rows of the minor")
    return len(rows)


def independence(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """How many equations a constraint adds to those of the constraints before it.

    Of the last constraint: by how much the dimension falls, from a manifold to a dof that was verified there.
    """
    minor, order = evidence.minor(claim["minor"]), owners(evidence)
    evidence.is_about("here", minor.point)
    place, own = order.index(claim["owner"]), len(evidence.owned(claim["owner"]))
    refuse(not own, "the constraint has no equations")
    before, upto = (relations_of(evidence, order[:k]) for k in (place, place + 1))
    last = "last" in claim and "/dof at" in verified and not evidence.moving and set(upto) == set(evidence.finite)
    after = _same_place(evidence, minor.point, verified) if last else _rank(evidence, minor, upto)
    return min(own, after - _rank(evidence, minor, before))


def redundant(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[str]:
    """The constraints named follow from the others near the point, and no more could be dropped.

    No more: of E equations with r independent rows E - r can be spared at most, where what depends does so by numbers,
    or is a single relation that depends with cofactors none of which is 0. None is named where ``without`` any the rows
    of the others are independent, and leave more than the dof that was verified there.
    """
    dropped, every = names_told(claim), set(evidence.equations)
    order = [owner for owner in owners(evidence) if evidence.owned(owner)]
    if "without" in claim:
        minors = {name: evidence.minor(claim["without"][name]) for name in order}
        others = {name: every.difference(evidence.owned(name)) for name in order}
        ranks = {_same_place(evidence, minor.point, verified) - len(minor.rows) for minor in minors.values()}
        whole = all(set(minor.rows) == others[name] for name, minor in minors.items())
        refuse(
            evidence.moving or min(ranks, default=0) <= 0 or not whole or "/dof at" not in verified,
            "without a constraint the others are no manifold, or as large",
        )
        return []
    minor = evidence.accounts(evidence.minor(claim["minor"]), evidence.equations)
    evidence.is_about("here", minor.point)
    refuse(not set(dropped) <= set(order) or not set(minor.rows) <= every, "no constraints, or rows of no relations")
    kept = relations_of(evidence, [owner for owner in order if owner not in dropped])
    evidence.follow(relations_of(evidence, dropped), kept, minor.point, "what is kept")
    _depend_plainly(evidence, minor, every - set(minor.rows))
    sizes, spared = sorted(len(evidence.owned(owner)) for owner in order), len(every) - len(minor.rows)
    most = sum(1 for i in range(len(sizes)) if sum(sizes[: i + 1]) <= spared)
    refuse(len(dropped) != most, f"{len(dropped)} constraints are named, and {most} might be dropped")
    return dropped


def _depend_plainly(evidence: CheckedEvidence, minor: CheckedMinor, others: set[str]) -> None:
    """`CheckError` unless relations depend on rows by numbers, or one does by cofactors that are not 0.

    Where every relation is linear or has a generic length of its own, all ranks are constant near almost every point.
    """
    if not evidence.moving and all(_is_general(evidence, name) for name in evidence.finite):
        return
    for name in others:
        ways = [one for one in evidence.consequences if one.target == name and set(one.sources) <= set(minor.rows)]
        used = [(*one.defined, *one.nonzero) for one in ways if one.defined]
        plain = any(not any(map(symbols_in, trees)) for trees in used)
        single = len(others) == 1 and any(all(excludes_zero(minor.point.value(t)) for t in trees) for trees in used)
        refuse(not plain and not single, f"`{name}` does not depend on the rows by numbers")


def _is_general(evidence: CheckedEvidence, name: str) -> bool:
    slopes = (derivative(evidence.relation(name).left, q) for q in evidence.problem.coordinates)
    return all(evidence.ring.rational(slope) is not None for slope in slopes) or bool(evidence.own_symbol(name))


def _same_place(evidence: CheckedEvidence, point: CheckedPoint, verified: Told) -> int:
    """n less the dof that was verified near the point."""
    evidence.is_about("here", point)
    refuse(verified.get("/dof at") not in (None, "reference", point.name), "dof was verified at another point")
    return len(evidence.problem.coordinates) - int(verified["/dof"])


def generalized_coordinates(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[str]:
    """All other coordinates are functions of these near the point, whose number is dof there."""
    minor = MOST[claim["rule"]](evidence, claim)
    columns = {*minor.columns, *([claim["free"]] if claim["rule"] == "isolated" else [])}
    whole = sorted((*columns, *names_told(claim))) == sorted(evidence.problem.coordinates)
    refuse(not whole, "the columns of the minor are not all the other coordinates")
    refuse(_same_place(evidence, minor.point, verified) != len(columns), "their number is not a verified dof")
    evidence.on_set(minor.point, evidence.finite)
    return names_told(claim)


def integrable_part(evidence: CheckedEvidence, claim: Told, verified: Told) -> Told:
    """The rank of what is finite is n - dof; the basis are relations that give it with the finite ones as written."""
    refuse(not evidence.moving, "an integrable part is of forms")
    found: Told = {"rank": len(evidence.problem.coordinates) - verified["/dof"], "basis": claim["value"]["basis"]}
    if found["basis"] is None:
        return found
    minor, steps = evidence.minor(claim["minor"]), claim.get("steps", [])
    whole = set(steps) <= set(minor.rows) <= {*steps, *evidence.finite} and len(minor.rows) == found["rank"]
    refuse(_same_place(evidence, minor.point, verified) != found["rank"] or not whole, "the minor is not of the basis")
    for text, name in zip(found["basis"], steps, strict=True):
        left, one = told_integral(evidence, text), evidence.relation(name)
        refuse(not one.leaf, "a relation of the basis is an integral")
        evidence.identity(evidence.text(left), one.left, "a relation of the basis as it is told")
    return found


def told_integral(evidence: CheckedEvidence, text: Any) -> str:
    """The function of an integral that is told with a constant of a name of its own."""
    function, _, constant = str(text).rpartition("=")
    taken = {*evidence.variables, *evidence.velocities, *evidence.chosen, *evidence.functions}
    refuse(not constant.strip().isidentifier() or constant.strip() in taken, "an integral ends with `= C`")
    return function.strip()


def growth(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[int]:
    """Words span each step of the growth from below; from above as many words as there are, or the dimension of all.

    Witt 1937: of length k there are (1/k) sum over d | k of mu(d) m^(k/d) brackets of m fields at most.
    """
    minor = evidence.accounts(evidence.minor(claim["minor"]), evidence.equations)
    whole = len(evidence.problem.coordinates) - _same_place(evidence, minor.point, verified) + evidence.timed
    refuse(not evidence.moving or not all(map(evidence.is_linear, evidence.moving)), "a growth vector is of forms")
    point, fields = admissible(evidence, claim, evidence.equations)
    rank, most, found = len(evidence.problem.coordinates) + evidence.timed - len(minor.rows), 0, list[int]()
    refuse(point is not minor.point or len(fields) > rank, "the fields and the minor are of one point")
    for step, given in enumerate(claim["spans"], 1):
        words = [of_word(evidence, word, claim["fields"], step) for word in given["words"]]
        independent(evidence, words, given["columns"], point)
        most = min(whole, most + _witt(rank, step))
        refuse(len(words) != most, f"entry {step} is at least {len(words)} and at most {most}")
        found.append(most)
    refuse(found[-1] != whole and (len(found) < 2 or found[-1] != found[-2]), "the last entry is not the whole")
    return found


def _witt(fields: int, length: int) -> int:
    """How many independent brackets of a length there are in a free Lie algebra."""
    moebius = {1: 1, 2: -1, 3: -1, 4: 0, 5: -1, 6: 1, 7: -1, 8: 0, 9: 0, 10: 1, 11: -1, 12: 0}
    total = sum(moebius[d] * int(fields ** (length // d)) for d in range(1, length + 1) if length % d == 0)
    return total // length
