"""Rules for what depends on what, and for numbers that follow from others."""

from __future__ import annotations

from typing import Any

from dofkit.checker.balls import excludes_zero
from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.dimension_rules import Told, equal, is_here, names_told, regular
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.evidence import CheckedEvidence, CheckedMinor, has_own_symbol
from dofkit.checker.fields import admissible, independent, involutive, of_word
from dofkit.checker.label_rules import own
from dofkit.checker.points import CheckedPoint
from dofkit.checker.trees import add, negative

BOTH = ("finite", "velocity")


def _owners(evidence: CheckedEvidence) -> list[str]:
    """The constraints with relations, in order."""
    return list(dict.fromkeys(one.owner for one in evidence.problem.relations))


def _of(evidence: CheckedEvidence, owners: Any, kinds: tuple[str, ...] = BOTH) -> tuple[str, ...]:
    return tuple(one for owner in owners for one in evidence.owned(owner, kinds))


def circuit(evidence: CheckedEvidence, claim: Told) -> None:
    """The constraint follows from those named, by cofactors near a point of all; without any one it does not."""
    names, order, point = names_told(claim), _owners(evidence), evidence.point(claim["at"])
    relations = own(evidence, claim)
    before = order[: order.index(claim["owner"])]
    refuse(not set(names) <= set(before), "a circuit holds constraints that were written before")
    is_here(evidence, point)
    evidence.on_set(point, [*_of(evidence, names), *relations])
    left = set(relations) - evidence.closure(_of(evidence, names), point)
    if left:
        raise CheckError(f"`{min(left)}` is not shown to follow from the circuit")
    for name in names:
        others = _of(evidence, [other for other in names if other != name])
        _fails(evidence, claim["minimal"][name], others, relations)


def _fails(evidence: CheckedEvidence, given: Told, others: tuple[str, ...], relations: tuple[str, ...]) -> None:
    """Where ``others`` hold, one of ``relations`` need not: at a point, or by a row that is independent of theirs."""
    if "minor" in given:
        minor = evidence.minor(given["minor"], {*others, *relations})
        left = [row for row in minor.rows if row not in relations]
        if len(left) == len(minor.rows) or not set(left) <= evidence.closure(others, minor.point):
            raise CheckError("the minor is of the others' rows and of one of the constraint's own")
        evidence.on_set(minor.point, others)
        if not evidence.closure(left, minor.point).issuperset(others):
            raise CheckError("the others do not follow from the rows of the minor")
        return
    point = evidence.point(given["at"])
    if any(evidence.relation(name).kind != "finite" for name in (*others, *relations)):
        raise CheckError("a point separates finite relations")
    if any(evidence.is_open(evidence.relation(name).left) for name in (*others, *relations)):
        raise CheckError("with parameters a minor is needed, not a point")
    evidence.on_set(point, others)
    if not any(excludes_zero(point.value(evidence.relation(name).left)) for name in relations):
        raise CheckError("the constraint may hold at the point")


def _rows_of(evidence: CheckedEvidence, minor: CheckedMinor, names: tuple[str, ...]) -> list[str]:
    """The rows of a minor that follow from relations, which follow from them in turn."""
    known = evidence.closure(names, minor.point)
    rows = [row for row in minor.rows if row in known and not evidence.relation(row).leaf]
    evidence.on_set(minor.point, names)
    left = set(names) - evidence.closure(rows, minor.point)
    if left:
        raise CheckError(f"`{min(left)}` is not shown to follow from the rows of the minor")
    return rows


def independent_of_those_before(evidence: CheckedEvidence, claim: Told) -> None:
    """How many rows the constraint adds to those of the constraints before it."""
    own(evidence, claim)
    minor, order = evidence.minor(claim["minor"]), _owners(evidence)
    is_here(evidence, minor.point)
    place = order.index(claim["owner"])
    before = _rows_of(evidence, minor, _of(evidence, order[:place]))
    upto = _rows_of(evidence, minor, _of(evidence, order[: place + 1]))
    equal(claim, len(upto) - len(before))


def independent_in_all(evidence: CheckedEvidence, claim: Told) -> None:
    """How many of the finite equations are independent."""
    minor = evidence.minor(claim["minor"])
    is_here(evidence, minor.point)
    rows = [row for row in _rows_of(evidence, minor, evidence.finite) if evidence.relation(row).kind == "finite"]
    if not evidence.closure(rows, minor.point).issuperset(evidence.finite):
        raise CheckError("the finite relations do not follow from the finite rows")
    equal(claim, len(rows))


def _same_place(evidence: CheckedEvidence, point: CheckedPoint, verified: dict[str, Any]) -> None:
    """`CheckError` unless the dof that was verified is that near the point."""
    is_here(evidence, point)
    place = verified.get("/dof at")
    refuse(place not in (None, "reference", point.name), "dof was verified at another point")


def generalized_coordinates(evidence: CheckedEvidence, claim: Told, verified: dict[str, Any]) -> None:
    """All other coordinates are functions of these near the point, whose number is dof there."""
    minor = involutive(evidence, claim) if "fields" in claim else evidence.minor(claim["minor"])
    if "fields" not in claim and any(evidence.relation(row).kind != "finite" for row in minor.rows):
        raise CheckError("a row of velocities does not reduce dof by itself")
    _same_place(evidence, minor.point, verified)
    coordinates = evidence.problem.coordinates
    if set(names_told(claim)) != set(coordinates) - set(minor.columns):
        raise CheckError("the columns of the minor are not all the other coordinates")
    if "/dof" not in verified or verified["/dof"] != len(coordinates) - len(minor.rows):
        raise CheckError("their number is not that of a verified dof")
    evidence.on_set(minor.point, evidence.finite)


def integrable_part(evidence: CheckedEvidence, claim: Told, verified: dict[str, Any]) -> None:
    """The rank of what is finite is n - dof; the basis are relations that give it with the finite ones as written."""
    value, rank = claim["value"], len(evidence.problem.coordinates) - verified["/dof"]
    refuse(set(value) != {"rank", "basis"} or not evidence.moving, "an integrable part of forms has a rank and a basis")
    equal({"value": value["rank"]}, rank)
    if value["basis"] is None:
        return
    minor, steps = evidence.minor(claim["minor"]), list(claim.get("steps", []))
    _same_place(evidence, minor.point, verified)
    if len(minor.rows) != rank or not set(steps) <= set(minor.rows) <= {*steps, *evidence.finite}:
        raise CheckError("the minor is not of finite relations and the basis, or of another rank")
    for text, name in zip(value["basis"], steps, strict=True):
        left, _, right = text.rpartition("=")
        one = evidence.relation(name)
        if one.kind != "finite" or (right.strip() == "0") == one.leaf or not (one.leaf or right.strip() == "0"):
            raise CheckError("an integral ends with a constant, another relation with 0")
        if one.leaf and (not right.strip().isidentifier() or evidence.names.meaning(right.strip()) is not None):
            raise CheckError("the constant of an integral has a name of its own")
        evidence.identity(add(evidence.text(left.strip()), negative(one.left)), "a relation of the basis as it is told")


def redundant(evidence: CheckedEvidence, claim: Told) -> None:
    """The constraints named follow from the others near the point, and no more could be dropped.

    No more: of E equations with r independent rows E - r can be spared at most, where what depends does so by numbers,
    or is a single relation that depends with cofactors none of which is 0.
    """
    minor, dropped = regular(evidence, claim["minor"]), names_told(claim)
    is_here(evidence, minor.point)
    order = [owner for owner in _owners(evidence) if _of(evidence, [owner])]
    refuse(not set(dropped) <= set(order), "what is redundant are constraints")
    kept = _of(evidence, [owner for owner in order if owner not in dropped])
    left = set(_of(evidence, dropped)) - evidence.closure(kept, minor.point)
    if left:
        raise CheckError(f"`{min(left)}` is not shown to follow from what is kept")
    every = _of(evidence, order)
    spared = len(every) - len(minor.rows)
    refuse(not set(minor.rows) <= set(every) or spared < 0, "the minor is of the relations of the scene")
    _depend_plainly(evidence, minor, set(every) - set(minor.rows))
    sizes = sorted(len(_of(evidence, [owner])) for owner in order)
    most = sum(1 for i in range(len(sizes)) if sum(sizes[: i + 1]) <= spared)
    refuse(len(dropped) != most, f"{len(dropped)} constraints are named, and {most} might be dropped")


def _depend_plainly(evidence: CheckedEvidence, minor: CheckedMinor, others: set[str]) -> None:
    """`CheckError` unless relations depend on rows by numbers, or one does by cofactors that are not 0.

    Where every relation is linear or has a generic length of its own, all ranks are constant near almost every point.
    """
    if not evidence.moving and all(_is_general(evidence, name) for name in evidence.finite):
        return
    for name in others:
        ways = [one for one in evidence.consequences if one.target == name and set(one.sources) <= set(minor.rows)]
        plain = any(one.defined and not any(symbols_in(tree) for tree in (*one.defined, *one.nonzero)) for one in ways)
        single = len(others) == 1 and any(
            one.defined and all(excludes_zero(minor.point.value(tree)) for tree in one.defined) for one in ways
        )
        refuse(not plain and not single, f"`{name}` does not depend on the rows by numbers")


def _is_general(evidence: CheckedEvidence, name: str) -> bool:
    left = evidence.relation(name).left
    if all(evidence.ring.rational(derivative(left, q)) is not None for q in evidence.problem.coordinates):
        return True
    return has_own_symbol(evidence, name)


def growth(evidence: CheckedEvidence, claim: Told, verified: dict[str, Any]) -> None:
    """Words span each step of the growth from below; from above as many words as there are, or the dimension of all.

    Witt 1937: of length k there are (1/k) sum over d | k of mu(d) m^(k/d) brackets of m fields at most.
    """
    value, spans, minor = claim["value"], claim["spans"], regular(evidence, claim["minor"])
    if not evidence.moving or len(spans) != len(value) or "/dof" not in verified:
        raise CheckError("a growth vector is of forms, with words for each entry, and dof is verified")
    _same_place(evidence, minor.point, verified)
    refuse(not all(evidence.is_linear(name) for name in evidence.moving), "a relation is not linear in the velocities")
    everything = (*evidence.finite, *evidence.moving)
    point, fields = admissible(evidence, {**claim, "at": claim["at"]}, everything)
    timed = evidence.timed
    rank = len(evidence.problem.coordinates) + timed - len(minor.rows)
    whole, most = verified["/dof"] + timed, 0
    refuse(point is not minor.point or len(fields) > rank, "the fields and the minor are of one point")
    for step, (told, given) in enumerate(zip(value, spans, strict=True), 1):
        words = given["words"]
        if any(len(word) > step or not set(word) <= set(claim["fields"]) for word in words):
            raise CheckError("a word is longer than the step, or of other fields")
        independent(evidence, [of_word(evidence, word) for word in words], given["columns"], point)
        most = min(whole, most + _witt(rank, step))
        if told != len(words) or told != most or type(told) is not int:
            raise CheckError(f"entry {step} is at least {len(words)} and at most {most}")
    refuse(value[-1] != whole and (len(value) < 2 or value[-1] != value[-2]), "the last entry is not the whole")


def _witt(fields: int, length: int) -> int:
    """How many independent brackets of a length there are in a free Lie algebra."""
    moebius = {1: 1, 2: -1, 3: -1, 4: 0, 5: -1, 6: 1, 7: -1, 8: 0, 9: 0, 10: 1, 11: -1, 12: 0}
    total = sum(moebius[d] * int(fields ** (length // d)) for d in range(1, length + 1) if length % d == 0)
    return total // length


def counted(evidence: CheckedEvidence, claim: Told, verified: dict[str, Any]) -> None:
    """A number or a label that follows from others that were verified."""
    path = claim["path"]
    if path == "/redundant_equations":
        equations = len(evidence.finite) + len(evidence.moving)
        size = len(evidence.problem.coordinates)
        return equal(claim, max(0, equations - (size - verified["/velocity_dof"])))
    if path == "/redundancies" and verified["/redundant_equations"] == 0:
        return equal(claim, [])
    if path == "/velocity_dof" and not evidence.moving:
        about = verified.get("/dof about")
        refuse(claim.get("about", about) != about, "the claim is about other points than that of dof")
        return equal(claim, verified["/dof"])
    if path == "/singular":
        return equal(claim, verified["/instantaneous_dof"] != verified["/velocity_dof"])
    if path in ("/holonomic", "/scleronomic"):
        found = [verified.get(f"/constraints/{_escaped(owner)}{path}") for owner in _owners(evidence)]
        if False in found:
            return equal(claim, False)
        if None not in found:
            return equal(claim, True)
    raise CheckError("nothing that was verified decides this")


def _escaped(name: str) -> str:
    return name.replace("~", "~0").replace("/", "~1")
