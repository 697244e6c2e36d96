"""Velocity fields: brackets and orbits, rows that integrate, blocks of constant rank; curves on independent rows.

The points that can be reached along fields form an immersed manifold, whose tangent space holds all their brackets
there (Hermann 1960, Nagano 1966, Sussmann 1973). Fields that are tangent to relations never leave them.
"""

from collections.abc import Collection, Iterable, Sequence
from itertools import chain
from typing import Any

from flint import arb, arb_mat, ctx

from dofkit.checker.evidence import CheckedEvidence, CheckedMinor
from dofkit.checker.relations import Consequence, total_derivative
from dofkit.checker.trees import ONE, ZERO, Tree, difference, refuse
from dofkit.checker.values import PRECISION, CheckedPoint, along, excludes_zero, substituted, symbols_in

LONGEST_WORD, LARGEST_FIELD, HIGHEST_ORDER = 12, 100_000, 8
VelocityField = dict[str, Tree]
Told = dict[str, Any]


def field_named(evidence: CheckedEvidence, name: Any) -> VelocityField:
    """A field by its id: its components; what is left out is 0."""
    given = evidence.named("fields", name)["components"]
    refuse(not given.keys() <= set(evidence.variables), "a field has a component of no coordinate")
    return {name: evidence.text(text) for name, text in given.items()}


def of_word(evidence: CheckedEvidence, word: Any, allowed: Iterable[str], longest: int = LONGEST_WORD) -> VelocityField:
    """The left-normed bracket of a word of the fields that are allowed: [A, B, C] is [[A, B], C]."""
    short = isinstance(word, list) and 1 <= len(word) <= longest and set(word) <= set(allowed)
    refuse(not short, "a word is a list of the fields, not too long")
    start, last = word[:-1], field_named(evidence, word[-1])
    if not start:
        return last
    return evidence.once(("word", *word), lambda: bracket(evidence, of_word(evidence, start, allowed), last))


def bracket(evidence: CheckedEvidence, x: VelocityField, y: VelocityField) -> VelocityField:
    """[X, Y] = (DY) X - (DX) Y, at the price of the size of the fields; large ones are refused."""
    sizes = [sum(tree.size for tree in field.values()) for field in (x, y)]
    evidence.effort.spend(sizes[0] * len(y) + sizes[1] * len(x) + 1)
    refuse(max(sizes) > LARGEST_FIELD, "a bracket is too large")
    return {q: difference(along(x, y.get(q, ZERO)), along(y, x.get(q, ZERO))) for q in {**x, **y}}


def on_row(evidence: CheckedEvidence, row: str, field: VelocityField) -> Tree:
    """What a row says of a field: 0 where the field is tangent to it."""
    one = evidence.relation(row)
    if one.kind == "finite":
        return along(field, one.left)
    slow = not evidence.is_linear(row) and field.get("t", ZERO) != ONE
    refuse(slow, f"`{row}` is not linear in velocities, and the field does not have time go by 1")
    return substituted(one.left, {name + "dot": field.get(name, ZERO) for name in evidence.variables})


def tangent(evidence: CheckedEvidence, fields: Iterable[VelocityField], rows: Sequence[str]) -> None:
    """`CheckError` unless fields are tangent to rows, identically."""
    for field in fields:
        for row in rows:
            evidence.identity(on_row(evidence, row, field), ZERO, f"a field along `{row}`")


def independent(evidence: CheckedEvidence, fields: Sequence[VelocityField], columns: Any, point: CheckedPoint) -> None:
    """`CheckError` unless the fields have a minor at the point that is not 0."""
    square = len(fields) == len(columns) == len(set(columns)) and set(columns) <= set(evidence.variables)
    refuse(not square, "as many columns as fields are needed, each once")
    point.is_regular([[field.get(column, ZERO) for column in columns] for field in fields])


def admissible(
    evidence: CheckedEvidence, given: Told, wanted: Sequence[str]
) -> tuple[CheckedPoint, list[VelocityField]]:
    """Fields whose curves through a point are motions: tangent to rows that account for ``wanted``, smooth there."""
    point, rows = evidence.point(given["at"]), given["rows"]
    fields = [field_named(evidence, name) for name in given["fields"]]
    tangent(evidence, fields, rows)
    evidence.on_set(point, [*rows, *wanted])
    evidence.follow(rows, wanted, point, "the relations")
    evidence.follow(wanted, rows, point, "the rows of the fields")
    evidence.settled(point, wanted, given)
    for value in (value for field in fields for value in field.values()):
        point.value(value)
    return point, fields


def span(evidence: CheckedEvidence, given: Told, longest: int) -> tuple[CheckedPoint, int]:
    """A lower bound of the dimension of the orbit through a point, at a fixed time."""
    point, fields = admissible(evidence, given, evidence.equations)
    words = [of_word(evidence, word, given["fields"], longest) for word in given["words"]]
    independent(evidence, words, given["columns"], point)
    times_of = [field["t"] for field in fields if field.get("t", ZERO) != ZERO]
    goes_on = any(excludes_zero(point.value(tree)) for tree in times_of)
    refuse((evidence.timed or times_of) and not goes_on, "no field is shown to have time go by")
    return point, len(words) - bool(times_of)


def involutive(evidence: CheckedEvidence, given: Told, allowed: Collection[str] | None = None) -> CheckedMinor:
    """Rows whose kernel is spanned by fields that are closed under brackets: they integrate (Frobenius 1877)."""
    minor, fields = evidence.minor(given["minor"], allowed), [field_named(evidence, name) for name in given["fields"]]
    timed = evidence.holds_time(minor.rows)
    missing = len(evidence.problem.coordinates) + timed - len(minor.rows)
    fits = len(fields) == missing and (timed or all("t" not in field for field in fields))
    refuse(not fits or not all(map(evidence.is_linear, minor.rows)), f"the kernel has {missing} fields")
    independent(evidence, fields, given["columns"], minor.point)
    brackets = (bracket(evidence, first, second) for i, first in enumerate(fields) for second in fields[:i])
    tangent(evidence, chain(fields, brackets), minor.rows)
    return minor


def take_cover(evidence: CheckedEvidence, name: Any) -> list[str]:
    """Blocks of rows, each with fields that keep it: near a minor's point its rows give all (constant rank theorem).

    The fields are tangent identically, so a block has rank at most its variables less its fields, and the minor shows
    that the sum is reached.
    """
    given, total = evidence.named("covers", name), 0
    minor, rows = evidence.minor(given["minor"]), [row for block in given["blocks"] for row in block["rows"]]
    once = len(rows) == len(set(rows)) and set(minor.rows) <= set(rows) <= set(evidence.finite)
    for row in rows:
        left = evidence.relation(row).left
        chosen = "t" in symbols_in(left) or (evidence.is_open(left) and not evidence.own_symbol(row))
        refuse(chosen, f"`{row}` holds time, or what the point chose: it may be met for that alone")
    evidence.on_set(minor.point, rows)
    for block in given["blocks"]:
        fields = [field_named(evidence, field) for field in block["fields"]]
        held = frozenset().union(*(symbols_in(evidence.relation(row).left) for row in block["rows"]))
        own = held & set(evidence.problem.coordinates)
        refuse(not set(block["columns"]) <= own or any("t" in field for field in fields), "a column of no coordinate")
        tangent(evidence, fields, block["rows"])
        independent(evidence, fields, block["columns"], minor.point)
        total += min(len(own) - len(fields), len(block["rows"]))
    refuse(not once or total != len(minor.rows), "each finite relation once, and the rank of the minor are needed")
    evidence.consequences += (Consequence(row, minor.rows, at=minor.point.name) for row in {*rows} - {*minor.rows})
    return rows


def along_curve(evidence: CheckedEvidence, minor: CheckedMinor, speeds: Told, tree: Tree, order: int) -> Any:
    """The derivative of a tree of some order along a curve through the minor's point on which its rows stay 0.

    Coordinates in ``speeds`` have these, and no acceleration; those of the columns follow; all others rest. Of g(q) = 0
    the k-th derivative is J q^(k) and a rest without q^(k), by which q^(k) is found.
    """
    refuse(type(order) is not int or not 1 <= order <= HIGHEST_ORDER, "the order of a derivative is small")
    lefts, moved = [*(evidence.relation(row).left for row in minor.rows), tree], [*minor.columns, *speeds]
    names, rates = list(moved), dict[str, Any]()
    taken = {q + "dot" * k for q in moved for k in range(1, order + 1)}.intersection(
        (*evidence.chosen, *evidence.variables)
    )
    refuse(taken, "a parameter or coordinate has the name of a derivative")
    with ctx.workprec(PRECISION):
        slopes = [[minor.point.value(evidence.slope(row, column)) for column in minor.columns] for row in minor.rows]
        for k in range(1, order + 1):
            evidence.effort.spend(10 * sum(left.size for left in lefts))
            lefts = [total_derivative(left, names) for left in lefts]
            names += [q + "dot" * k for q in moved]
            rates |= {q + "dot" * k: speeds.get(q, arb(0)) if k == 1 else arb(0) for q in moved}
            rest = arb_mat([[minor.point.value_with(left, rates)] for left in lefts[:-1]])
            found = arb_mat(slopes).solve(rest) if minor.rows else rest
            rates |= {q + "dot" * k: -found[i, 0] for i, q in enumerate(minor.columns)}
    return minor.point.value_with(lefts[-1], rates)


def isolated(evidence: CheckedEvidence, given: Told) -> CheckedMinor:
    """A minor whose rows leave a dimension more than there is: another relation is not 0 on all that they leave.

    It has a derivative that is not 0 along a curve there, and what is analytic is 0 on a thin set only.
    """
    minor, name = evidence.minor(given["minor"]), given["zero"]
    unfit = evidence.moving or evidence.problem.functions or evidence.holds_time((*minor.rows, name))
    refuse(unfit or not {*minor.rows, name} <= {*evidence.finite}, "finite relations of the scene, without time")
    evidence.on_set(minor.point, (*minor.rows, name))
    speeds = {q: minor.point.value(evidence.text(text)) for q, text in given["speeds"].items()}
    refuse(not speeds.keys() <= {*evidence.problem.coordinates} - {*minor.columns}, "speeds are of free coordinates")
    value = along_curve(evidence, minor, speeds, evidence.relation(name).left, given["order"])
    refuse(not excludes_zero(value), "the zero on the curve is not shown to be isolated")
    return minor
