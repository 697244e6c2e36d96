"""Rules for numbers: how many freedoms, from above and from below, and of which points that is said."""

from __future__ import annotations

from typing import Any

from flint import fmpq, fmpq_mat

from dofkit.checker.balls import determinant, evaluated, excludes_zero
from dofkit.checker.derivatives import derivative, substituted, symbols_in
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.evidence import CheckedEvidence, CheckedMinor, has_own_symbol
from dofkit.checker.fields import field_named, independent, involutive, span, tangent
from dofkit.checker.points import CheckedPoint, in_turn
from dofkit.checker.steps import Consequence
from dofkit.checker.trees import ONE, ZERO, Tree, add, negative, symbol, times

Told = dict[str, Any]


def equal(claim: Told, value: object) -> None:
    """`CheckError` unless the claim's value is what the evidence gives."""
    if type(claim["value"]) is not type(value) or claim["value"] != value:
        raise CheckError(f"the evidence gives {value!r}, not {str(claim['value'])[:80]!r}")


def names_told(claim: Told) -> list[str]:
    """The claim's value as a list of names, each once."""
    value = claim["value"]
    if not isinstance(value, list) or not all(isinstance(one, str) for one in value) or len(set(value)) < len(value):
        raise CheckError("the value is a list of names, each once")
    return value


def is_about(evidence: CheckedEvidence, claim: Told, point: CheckedPoint) -> None:
    """`CheckError` unless the point is one of those that the claim is about.

    Where the scene has a configuration that meets its relations, numbers are about that.
    """
    about, reference = claim.get("about"), evidence.problem.reference
    if about == "reference":
        refuse(not reference, "the scene has no configuration")
        if point.has("t"):
            evidence.identity(point.prepared(symbol("t")), "the time of the configuration")
        for name in evidence.problem.coordinates:
            refuse(
                not point.has(name)
                or not evidence.ring.vanishes(
                    add(point.prepared(symbol(name)), negative(point.prepared(reference[name])))
                ),
                f"`{name}` is not that of the scene's configuration",
            )
        for name in evidence.finite:
            if evidence.is_open(evidence.relation(name).left):
                evidence.identity(
                    at_reference(evidence, evidence.relation(name).left), f"`{name}` at the configuration"
                )
    elif about != "component":
        raise CheckError("a claim is about `reference`, `component` or `everywhere`")
    elif reference and not _is_off(evidence, point):
        raise CheckError("the scene has a configuration: the claim has to be about it")


def at_reference(evidence: CheckedEvidence, tree: Tree) -> Tree:
    """A tree at the scene's configuration, parameters and functions left open."""
    return substituted(tree, {**evidence.problem.reference, "t": ZERO, "tdot": ONE})


def is_here(evidence: CheckedEvidence, point: CheckedPoint) -> None:
    """`CheckError` unless the point is the scene's configuration, where one is given that meets the relations."""
    has_one = bool(evidence.problem.reference) and not _is_off(evidence, point)
    is_about(evidence, {"about": "reference" if has_one else "component"}, point)


def _is_off(evidence: CheckedEvidence, point: CheckedPoint) -> bool:
    """Whether the scene's configuration is shown not to meet its relations."""
    kept = {name: tree for name, tree in point.exact.items() if name not in evidence.problem.coordinates}
    start = CheckedPoint("", {**kept, **evidence.problem.reference, "t": ZERO}, point.functions, evidence.effort)
    for name in evidence.finite:
        try:
            if excludes_zero(start.value(evidence.relation(name).left)):
                return True
        except CheckError:
            continue
    return False


def regular(evidence: CheckedEvidence, given: Any) -> CheckedMinor:
    """Near the point the set of the rows is a manifold, and all relations hold on it (implicit functions).

    Every velocity that the rows allow there is that of a motion, as the rows have full rank in the coordinates.
    """
    minor = evidence.minor(given)
    evidence.covers(minor, (*evidence.finite, *evidence.moving))
    return minor


def _most(evidence: CheckedEvidence, given: Told, path: str) -> tuple[CheckedPoint, int]:
    size = len(evidence.problem.coordinates)
    if given["rule"] == "minor":
        minor = evidence.minor(given["minor"])
        if path == "/dof" and any(evidence.relation(row).kind != "finite" for row in minor.rows):
            raise CheckError("a row of velocities does not reduce dof by itself")
        return minor.point, size - len(minor.rows)
    if given["rule"] == "frobenius":
        minor = involutive(evidence, given)
        return minor.point, size - len(minor.rows)
    raise CheckError(f"no upper bound is called {str(given['rule'])[:40]!r}")


def _least(evidence: CheckedEvidence, given: Told, path: str) -> tuple[CheckedPoint, int]:
    if given["rule"] == "regular":
        minor = regular(evidence, given["minor"])
        return minor.point, len(evidence.problem.coordinates) - len(minor.rows)
    if given["rule"] == "family":
        return _family(evidence, given)
    if given["rule"] == "span":
        return span(evidence, given, 1 if path == "/velocity_dof" else 12)
    if given["rule"] == "cover":
        return _cover(evidence, given)
    raise CheckError(f"no lower bound is called {str(given['rule'])[:40]!r}")


def _family(evidence: CheckedEvidence, given: Told) -> tuple[CheckedPoint, int]:
    """A family q(u) of configurations through the point, with as many directions there as parameters."""
    refuse(evidence.moving or evidence.timed, "a family is for finite relations without time")
    point, parameters = evidence.point(given["at"]), given["parameters"]
    problem = evidence.problem
    taken = {*evidence.variables, *evidence.velocities, *problem.parameters, *problem.generic, *point.exact}
    refuse(not taken.isdisjoint(parameters), "a parameter of a family has a name that is taken")
    own = {name: tree for name, tree in point.exact.items() if name in evidence.variables}
    family = {q: substituted(evidence.text(text, parameters), own) for q, text in given["q"].items()}
    family |= {q: point.prepared(symbol(q)) for q in problem.coordinates if q not in family}
    refuse(not set(family) <= set(evidence.problem.coordinates), "a family has what is no coordinate")
    values = in_turn({u: evidence.text(given["values"][u]) for u in parameters})
    evidence.on_set(point, evidence.finite)
    at_once = {"t": point.exact["t"]} if "t" in point.exact else {}
    for name in evidence.finite:
        left = substituted(evidence.relation(name).left, at_once)
        evidence.identity(substituted(left, family), f"`{name}` on the family")
    family = {q: point.prepared(tree) for q, tree in family.items()}
    for q, tree in family.items():
        evidence.identity(add(substituted(tree, values), negative(point.prepared(symbol(q)))), f"the family's `{q}`")
    balls = {u: evaluated(tree, {}, evidence.effort) for u, tree in values.items()} | point.balls
    columns = given["columns"]
    if len(columns) != len(parameters) or not {*columns} <= {*family} or len({*columns}) != len({*parameters}):
        raise CheckError("as many columns as parameters are needed, each once")
    matrix = [[evaluated(derivative(family[q], u), balls, evidence.effort) for q in columns] for u in parameters]
    for tree in family.values():
        evaluated(tree, balls, evidence.effort)
    if not excludes_zero(determinant(matrix, evidence.effort)):
        raise CheckError("the family may be slower at the point than its parameters")
    return point, len(parameters)


def _constant_rank(evidence: CheckedEvidence, given: Told) -> CheckedMinor:
    """Blocks of rows, each with fields that keep it: near the point the rank is that of the minor, of some of the rows.

    The fields are tangent identically, so a block has rank at most its variables less its fields, and the minor shows
    that the sum is reached. Then all rows are functions of those of the minor (constant rank theorem).
    """
    minor = evidence.minor(given["minor"])
    rows = [row for block in given["blocks"] for row in block["rows"]]
    if len(rows) != len(set(rows)) or not set(minor.rows) <= set(rows) <= set(evidence.finite):
        raise CheckError("the blocks do not hold each finite relation once, or the minor has other rows")
    for row in rows:
        left = evidence.relation(row).left
        refuse("t" in symbols_in(left), f"`{row}` holds time: what is constant may be so at one moment only")
        chosen = evidence.is_open(left) and not has_own_symbol(evidence, row)
        refuse(chosen, f"`{row}` holds what the point chose: it may be met for that alone")
    evidence.on_set(minor.point, rows)
    total = 0
    for block in given["blocks"]:
        fields = [field_named(evidence, name) for name in block["fields"]]
        held = frozenset().union(*(symbols_in(evidence.relation(row).left) for row in block["rows"]))
        own = [q for q in evidence.problem.coordinates if q in held]
        if not set(block["columns"]) <= set(own) or any("t" in field for field in fields):
            raise CheckError("the columns of a block are coordinates that occur in it")
        tangent(evidence, fields, block["rows"])
        if fields:
            independent(evidence, fields, block["columns"], minor.point)
        total += min(len(own) - len(fields), len(block["rows"]))
    refuse(total != len(minor.rows), f"the blocks have rank {total} at most, the minor {len(minor.rows)}")
    return minor


def _cover(evidence: CheckedEvidence, given: Told) -> tuple[CheckedPoint, int]:
    """A level set of constant rank r is a manifold of dimension n - r (constant rank theorem)."""
    minor = _constant_rank(evidence, given)
    if evidence.moving or {row for block in given["blocks"] for row in block["rows"]} != set(evidence.finite):
        raise CheckError("a cover is of all finite relations, where there are no others")
    return minor.point, len(evidence.problem.coordinates) - len(minor.rows)


def take_cover(evidence: CheckedEvidence, name: Any) -> None:
    """Near the point the rows of a cover follow from those of its minor."""
    if name in evidence.taken:
        return
    given = evidence.named("covers", name)
    minor = _constant_rank(evidence, given)
    evidence.taken.add(name)
    for block in given["blocks"]:
        for row in block["rows"]:
            follows = Consequence(row, minor.rows, (), (), minor.point.name)
            if row not in minor.rows:
                evidence.consequences.append(follows)


def freedom(evidence: CheckedEvidence, claim: Told) -> str:
    """dof or velocity_dof near a point, squeezed between two bounds; told is where."""
    path, rule = claim["path"], claim["rule"]
    if rule == "squeeze":
        (point, most), (other, least) = _most(evidence, claim["most"], path), _least(evidence, claim["least"], path)
        refuse(point is not other or most != least, f"{least} at least and {most} at most, or of two points")
    else:
        minor = regular(evidence, claim["minor"])
        point, most = minor.point, len(evidence.problem.coordinates) - len(minor.rows)
        if path == "/dof" and any(evidence.relation(row).kind != "finite" for row in minor.rows):
            raise CheckError("a row of velocities does not reduce dof by itself")
    is_about(evidence, claim, point)
    equal(claim, most)
    return "reference" if claim["about"] == "reference" else point.name


def nothing(evidence: CheckedEvidence, claim: Told) -> None:
    """No equation: every coordinate is free."""
    refuse(evidence.finite or evidence.moving, "there are equations")
    equal(claim, len(evidence.problem.coordinates))


def instantaneous(evidence: CheckedEvidence, claim: Told) -> None:
    """n less the rank of all rows at the configuration: of rational rows, or a minor and what depends on it."""
    names = (*evidence.finite, *evidence.moving)
    point = evidence.point(claim["at"])
    is_about(evidence, {"about": "reference"}, point)
    evidence.on_set(point, evidence.finite)
    refuse(not all(evidence.is_linear(name) for name in names), "a relation is not linear in the velocities")
    size = evidence.problem.coordinates
    for name in names:
        for q in size:
            point.value(evidence.slope(name, q))
    slopes = {name: [at_reference(evidence, evidence.slope(name, q)) for q in size] for name in names}
    if "minor" not in claim:
        values = [evidence.ring.rational(tree) for row in slopes.values() for tree in row]
        if any(value is None for value in values):
            raise CheckError("the rows are not rational at the point")
        entries = [fmpq(value.numerator, value.denominator) for value in values if value is not None]
        evidence.effort.spend(len(entries) * len(names))
        equal(claim, len(size) - (fmpq_mat(len(names), len(size), entries).rank() if entries else 0))
        return
    minor = evidence.minor(claim["minor"])
    if minor.point is not point or not set(minor.rows) <= set(names):
        raise CheckError("the minor is not of the relations at the configuration")
    for name in set(names) - set(minor.rows):
        factors = {row: evidence.text(text) for row, text in claim["dependent"][name].items()}
        held = frozenset().union(*(symbols_in(tree) for tree in factors.values()))
        if not set(factors) <= set(minor.rows) or not held <= {*evidence.problem.parameters}:
            raise CheckError("a row depends on rows of the minor, by numbers and parameters")
        for tree in factors.values():
            point.value(tree)
        for i, tree in enumerate(slopes[name]):
            total: list[Tree] = [times(factor, slopes[row][i]) for row, factor in factors.items()]
            evidence.identity(add(tree, negative(add(*total))), f"`{name}` as a sum of rows")
    equal(claim, len(size) - len(minor.rows))
