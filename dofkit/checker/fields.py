"""Vector fields over the coordinates and time, given as texts or by Cramer's rule; their brackets, and what they span.

The orbit of smooth fields through a point is an immersed manifold, whose tangent space holds all their brackets there
(Hermann 1960, Nagano 1966, Sussmann 1973). Fields that are tangent to relations never leave them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from dofkit.checker.balls import determinant, excludes_zero
from dofkit.checker.derivatives import derivative, substituted, symbols_in
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.evidence import CheckedEvidence, CheckedMinor
from dofkit.checker.points import CheckedPoint
from dofkit.checker.texts import size_of
from dofkit.checker.trees import ONE, ZERO, Tree, add, negative, times

LARGEST_CRAMER, LONGEST_WORD, MOST_FIELDS, LARGEST_FIELD = 5, 12, 40, 20_000
VelocityField = dict[str, Tree]


def field_named(evidence: CheckedEvidence, name: Any) -> VelocityField:
    """A field by its id; what is left out is 0."""
    given = evidence.named("fields", name)
    if "cramer" in given:
        return _by_cramer(evidence, given["cramer"])
    refuse(not set(given["components"]) <= set(evidence.variables), "a field has a component that is no coordinate")
    return {name: evidence.text(text) for name, text in given["components"].items()}


def _by_cramer(evidence: CheckedEvidence, given: dict[str, Any]) -> VelocityField:
    rows, columns, free = given["rows"], given["columns"], given["free"]
    if len(rows) != len(columns) or len(rows) > LARGEST_CRAMER or free in columns or free not in evidence.variables:
        raise CheckError("Cramer's rule is for as many rows as columns, 5 at most, and another free column")
    matrix = [[evidence.slope(row, column) for column in columns] for row in rows]
    right = [evidence.slope(row, free) for row in rows]
    found = {free: _determinant(matrix)}
    for i, column in enumerate(columns):
        replaced = [[*row[:i], b, *row[i + 1 :]] for row, b in zip(matrix, right, strict=True)]
        found[column] = negative(_determinant(replaced))
    return found


def _determinant(rows: list[list[Tree]]) -> Tree:
    if not rows:
        return ONE
    minors = ((j, [[*row[:j], *row[j + 1 :]] for row in rows[1:]]) for j in range(len(rows)) if rows[0][j] != ZERO)
    return add(
        *(
            times(rows[0][j], _determinant(m)) if j % 2 == 0 else negative(times(rows[0][j], _determinant(m)))
            for j, m in minors
        )
    )


def along(field: VelocityField, tree: Tree) -> Tree:
    """The derivative of a tree along a field."""
    held = symbols_in(tree)
    return add(*(times(value, derivative(tree, name)) for name, value in field.items() if name in held))


def bracket(first: VelocityField, second: VelocityField) -> VelocityField:
    """[X, Y] = (DY) X - (DX) Y."""
    return {
        name: add(along(first, second.get(name, ZERO)), negative(along(second, first.get(name, ZERO))))
        for name in dict.fromkeys([*first, *second])
    }


def of_word(evidence: CheckedEvidence, word: Any) -> VelocityField:
    """The left-normed bracket of a word: [A, B, C] is [[A, B], C]."""
    if not isinstance(word, list) or not 1 <= len(word) <= LONGEST_WORD:
        raise CheckError("a word is a list of fields, not too long")
    found = field_named(evidence, word[0])
    for name in word[1:]:
        field = field_named(evidence, name)
        _pay(evidence, found, field)
        found = bracket(found, field)
    return found


def _pay(evidence: CheckedEvidence, first: VelocityField, second: VelocityField) -> None:
    """A bracket costs the size of its fields; large ones are refused."""
    sizes = [sum(size_of(tree) for tree in field.values()) for field in (first, second)]
    evidence.effort.spend(sizes[0] * len(second) + sizes[1] * len(first) + 1)
    refuse(max(sizes) > LARGEST_FIELD, "a bracket is too large")


def on_row(evidence: CheckedEvidence, row: str, field: VelocityField) -> Tree:
    """What a row says of a field: 0 where the field is tangent to it."""
    one = evidence.relation(row)
    if one.kind == "finite":
        return along(field, one.left)
    if not evidence.is_linear(row) and field.get("t", ZERO) != ONE:
        raise CheckError(f"`{row}` is not linear in velocities, and the field does not have time go by 1")
    return substituted(one.left, {name + "dot": field.get(name, ZERO) for name in evidence.variables})


def tangent(evidence: CheckedEvidence, fields: Iterable[VelocityField], rows: Iterable[str]) -> None:
    """`CheckError` unless fields are tangent to rows, identically."""
    for field in fields:
        for row in rows:
            evidence.identity(on_row(evidence, row, field), f"a field along `{row}`")


def independent(evidence: CheckedEvidence, fields: Sequence[VelocityField], columns: Any, point: CheckedPoint) -> None:
    """`CheckError` unless the fields have a minor at the point that is not 0."""
    if len(fields) != len(columns) or len(set(columns)) != len(columns) or not set(columns) <= set(evidence.variables):
        raise CheckError("as many columns as fields are needed, each once")
    matrix = [[point.value(field.get(column, ZERO)) for column in columns] for field in fields]
    refuse(not excludes_zero(determinant(matrix, evidence.effort)), "the fields may be dependent at the point")


def admissible(
    evidence: CheckedEvidence, given: dict[str, Any], wanted: Sequence[str]
) -> tuple[CheckedPoint, list[VelocityField]]:
    """Fields whose curves through a point are motions: tangent to rows that account for ``wanted``, smooth there."""
    point, names = evidence.point(given["at"]), given["fields"]
    refuse(not 0 < len(names) <= MOST_FIELDS, "there are no fields, or too many")
    fields = [field_named(evidence, name) for name in names]
    tangent(evidence, fields, given["rows"])
    evidence.on_set(point, [name for name in wanted if evidence.relation(name).kind == "finite"])
    left = set(wanted) - evidence.closure(given["rows"], point)
    if left:
        raise CheckError(f"`{min(left)}` is not shown to follow from the rows of the fields")
    for field in fields:
        for value in field.values():
            point.value(value)
    return point, fields


def span(evidence: CheckedEvidence, given: dict[str, Any], longest: int = LONGEST_WORD) -> tuple[CheckedPoint, int]:
    """A lower bound of the dimension of the orbit through a point, at a fixed time."""
    point, fields = admissible(evidence, given, (*evidence.finite, *evidence.moving))
    words = given["words"]
    if any(len(word) > longest or not set(word) <= set(given["fields"]) for word in words):
        raise CheckError("a word is too long, or of other fields")
    independent(evidence, [of_word(evidence, word) for word in words], given["columns"], point)
    moves_time = any(field.get("t", ZERO) != ZERO for field in fields)
    goes_on = any(excludes_zero(point.value(field.get("t", ZERO))) for field in fields)
    refuse((evidence.timed or moves_time) and not goes_on, "no field is shown to have time go by")
    return point, len(words) - moves_time


def involutive(evidence: CheckedEvidence, given: dict[str, Any], allowed: Iterable[str] | None = None) -> CheckedMinor:
    """Rows whose kernel is spanned by fields that are closed under brackets: they integrate (Frobenius 1877)."""
    minor = evidence.minor(given["minor"], allowed)
    timed = any(not {"t", "tdot"}.isdisjoint(symbols_in(evidence.relation(row).left)) for row in minor.rows)
    fields = [field_named(evidence, name) for name in given["fields"]]
    missing = len(evidence.problem.coordinates) + timed - len(minor.rows)
    if len(fields) != missing or not all(evidence.is_linear(row) for row in minor.rows):
        raise CheckError(f"the kernel of the rows has {missing} fields, and the rows are linear in the velocities")
    if not timed and any(field.get("t", ZERO) != ZERO for field in fields):
        raise CheckError("a field moves time, which does not occur")
    independent(evidence, fields, given["columns"], minor.point)
    tangent(evidence, fields, minor.rows)
    for i, first in enumerate(fields):
        for second in fields[:i]:
            _pay(evidence, first, second)
            tangent(evidence, [bracket(first, second)], minor.rows)
    return minor
