"""Rules for numbers: how many freedoms, near a point and everywhere, and what depends on what.

A rule looks at the evidence of a claim and gives the value that it shows.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from flint import fmpq, fmpq_mat

from dofkit.checker.balls import CheckedPoint, excludes_zero
from dofkit.checker.derivatives import derivative, heads_in, symbols_in
from dofkit.checker.evidence import CheckedEvidence, CheckedMinor
from dofkit.checker.fields import Told, admissible, independent, involutive, of_word, span
from dofkit.checker.trees import Tree, refuse


def bounds(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """dof or velocity_dof near a point, between two bounds."""
    path, size = claim["path"], len(evidence.problem.coordinates)
    one = {"minor": claim.get("minor")}
    most, least = claim.get("most", {**one, "rule": "minor"}), claim.get("least", {**one, "rule": "regular"})
    refuse(most["rule"] not in ("minor", "frobenius"), "an upper bound is `minor` or `frobenius`")
    minor = involutive(evidence, most) if most["rule"] == "frobenius" else evidence.minor(most["minor"])
    if most["rule"] == "minor" and path == "/dof":
        _finite_rows(evidence, minor)
    if least["rule"] == "regular":
        other = evidence.accounts(evidence.minor(least["minor"]), evidence.equations)
        point, found = other.point, size - len(other.rows)
    else:
        refuse(least["rule"] != "span", "a lower bound is `regular` or `span`")
        given, longest = {"minor": most["minor"], **least}, 1 if path == "/velocity_dof" else 12
        point, found = span(evidence, given, longest)
    above = size - len(minor.rows)
    refuse(point is not minor.point or above != found, f"{found} at least and {above} at most, or of two points")
    evidence.is_about(claim["about"], point)
    verified[f"{path} at"] = "reference" if claim["about"] == "reference" else point.name
    return found


def _finite_rows(evidence: CheckedEvidence, minor: CheckedMinor) -> None:
    moving = any(evidence.relation(row).kind != "finite" for row in minor.rows)
    refuse(moving, "a row of velocities does not reduce dof by itself")


def everywhere(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """The largest number over all parts of the set, from relations of three kinds.

    ``order``: each relation gives a coordinate, or its velocity, with a factor of numbers and parameters, and those
    before do not hold it: the finite ones are a graph, and all have constant rank. Instead of a coordinate one may give
    t, of which almost all values are then regular, where nothing else is told (Sard 1942).
    ``blocks``: a single analytic relation that is not 0 everywhere has zeros of dimension n - 1 at most; a single form,
    of which all finite relations are a graph, has rank 1 but on such a part.
    ``generic``: relations with a symbol of their own in which they are nowhere stationary: for almost all values of
    these the set is a manifold, of the rank that a cover of all shows (Sard 1942, Federer 3.4.3). Blocks, and the
    generic relations together, share no free coordinate.

    dof, where there are forms: that near a point (``most``, ``least``). None is larger where the finite relations allow
    no more, or where all relations are named here and analytic: then orbits have the dimension that the brackets span,
    which is largest almost everywhere at once (Nagano 1966).
    """
    order, blocks, generic = claim.get("order", []), claim.get("blocks", []), dict(claim.get("generic", []))
    names, size = [*(name for name, _ in order), *blocks, *generic], len(evidence.problem.coordinates)
    whole, rank = sorted(names) == sorted(evidence.equations), len(names)
    refuse(claim.get("about") != "everywhere", "the rule is about everywhere")
    refuse(not whole and sorted(names) != sorted(evidence.finite), "each relation stands in one place")
    refuse(not all(map(evidence.is_linear, names)), "a relation is not linear in the velocities")
    forms = [name for name in names if evidence.relation(name).kind != "finite"]
    refuse(forms and (generic or (blocks and not blocks == forms == names[-1:])), "forms stand in the order, or alone")
    minor = evidence.accounts(evidence.minor(claim["minor"], names), names) if "minor" in claim else None
    free, rank = _free(evidence, order, minor and minor.point), len(minor.rows if minor else names)
    groups = [_coordinates(evidence, name, free) for name in blocks]
    groups.append(frozenset().union(*(_coordinates(evidence, name, free) for name in generic)))
    refuse(sum(map(len, groups)) != len(frozenset().union(*groups)), "two blocks share a coordinate")
    if minor:
        evidence.is_about("here", minor.point)
    for name, letter in generic.items():
        refuse(not evidence.own_symbol(name, [letter]), f"`{letter}` is not the own symbol of `{name}`")
    smooth = all(_is_analytic(evidence, name, not minor or name in dict(order)) for name in names)
    timely = any(q == "t" for _, q in order)
    refuse(not minor and (blocks or generic or timely), "a point is needed")
    refuse(timely and (blocks or generic or evidence.moving), "where t is given, nothing else is told")
    refuse((blocks or rank < len(names) or not minor) and not smooth, "a relation is not analytic")
    if rank < len(names):
        rows = [row for name in claim["covers"] for row in evidence.seen["covers", name]]
        refuse(blocks or order or sorted(rows) != sorted(names), "one cover of all finite relations is needed")
    if not evidence.moving or claim["path"] == "/velocity_dof":
        refuse(not whole, "each relation stands in one place")
        return size - rank
    found = bounds(evidence, {**claim, "about": "here"}, verified)
    refuse(found != size - rank + len(forms) and not (whole and smooth), "another part may be larger")
    return found


def _is_analytic(evidence: CheckedEvidence, name: str, given: bool) -> bool:
    """Whether a relation is analytic at all places; a form, and what gives no coordinate, up to a denominator."""
    one = evidence.relation(name)
    whole = given and one.kind == "finite"
    plain = evidence.has_value_everywhere(one.left) if whole else _is_meromorphic(evidence, one.left)
    return plain and "apply" not in heads_in(one.left)


def _is_meromorphic(evidence: CheckedEvidence, tree: Tree) -> bool:
    """Whether a tree is a quotient of expressions that are analytic everywhere."""
    below, exponent = tree.below, tree.below[-1].value if tree.head == "power" else None
    if isinstance(exponent, Fraction) and exponent.denominator == 1:
        return _is_meromorphic(evidence, below[0])
    if tree.head in ("tan", "cot", "sec", "csc"):
        return evidence.has_value_everywhere(below[0])
    parts = tree.head in ("sum", "product") and all(_is_meromorphic(evidence, part) for part in below)
    return parts or evidence.has_value_everywhere(tree)


def _free(evidence: CheckedEvidence, order: list[list[str]], point: CheckedPoint | None) -> dict[str, frozenset[str]]:
    """On which coordinates those that are given depend."""
    later, found = [q for _, q in order], dict[str, frozenset[str]]()
    own = len(set(later)) == len(later) and set(later) <= set(evidence.variables)
    refuse(not own, "each relation gives a coordinate of its own")
    for i, (name, q) in enumerate(order):
        one, slope, dot = evidence.relation(name), evidence.slope(name, q), "dot"
        dot = dot if one.kind == "velocity" else ""
        plain = symbols_in(slope) <= evidence.chosen and evidence.has_value_everywhere(slope)
        sure = evidence.ring.rational(slope) or evidence.is_nowhere_zero(slope)
        gives = sure or (plain and point and excludes_zero(point.value(slope)))
        refuse(not gives or q + dot == "tdot", f"`{name}` does not give `{q}` everywhere")
        refuse(not symbols_in(one.left).isdisjoint(q + dot for q in later[i + 1 :]), f"`{name}` holds what comes later")
        if not dot:
            found[q] = _coordinates(evidence, name, found) - {q}
    return found


def _coordinates(evidence: CheckedEvidence, name: str, given: dict[str, frozenset[str]]) -> frozenset[str]:
    held = symbols_in(evidence.relation(name).left) & set(evidence.problem.coordinates)
    return frozenset().union(*(given.get(q, frozenset((q,))) for q in held))


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
    """How many equations a constraint adds to those of the constraints before it; or how many finite ones there are."""
    minor, order = evidence.minor(claim["minor"]), owners(evidence)
    evidence.is_about("here", minor.point)
    if claim["path"] == "/count/independent":
        return _rank(evidence, minor, evidence.finite)
    place, own = order.index(claim["owner"]), len(evidence.owned(claim["owner"]))
    refuse(not own, "the constraint has no equations")
    ranks = [_rank(evidence, minor, relations_of(evidence, order[:k])) for k in (place, place + 1)]
    return min(own, ranks[1] - ranks[0])


def redundant(evidence: CheckedEvidence, claim: Told, verified: Told) -> list[str]:
    """The constraints named follow from the others near the point, and no more could be dropped.

    No more: of E equations with r independent rows E - r can be spared at most, where what depends does so by numbers,
    or is a single relation that depends with cofactors none of which is 0.
    """
    minor, dropped = evidence.accounts(evidence.minor(claim["minor"]), evidence.equations), names_told(claim)
    evidence.is_about("here", minor.point)
    order, every = [owner for owner in owners(evidence) if evidence.owned(owner)], set(evidence.equations)
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
    minor = involutive(evidence, claim) if "fields" in claim else evidence.minor(claim["minor"])
    if "fields" not in claim:
        _finite_rows(evidence, minor)
    others = set(evidence.problem.coordinates) - set(minor.columns)
    refuse(set(names_told(claim)) != others, "the columns of the minor are not all the other coordinates")
    refuse(_same_place(evidence, minor.point, verified) != len(minor.rows), "their number is not a verified dof")
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
