"""Integrals of forms in the presence of other relations: cofactors by Cramer's rule."""

from __future__ import annotations

from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.errors import CheckError
from dofkit.checker.fields import LARGEST_CRAMER
from dofkit.checker.steps import total_derivative
from dofkit.checker.trees import ONE, Tree, add, negative, times
from dofkit.methods.certificates.room import Room
from dofkit.methods.certificates.texts import text_of


def integral_of_text(room: Room, text: str) -> str | None:
    """A step for a text such as ``x*y = C`` or ``g = 0``."""
    left, _, right = text.rpartition("=")
    return combined_integral(room, left.strip()) if right.strip() != "0" else None


def combined_integral(room: Room, function: str) -> str | None:
    """A step by which a function keeps its value, whatever relations that takes: its id."""
    name = f"{room.scenery.label}{function} is constant"
    if name in room.scenery.evidence.known:
        return name
    if room.standing is None or not room.small:
        return None
    change = room.scenery.evidence.text(function)
    found = multipliers(room, change)
    if found is None:
        return None
    h, factors = found
    try:
        told = {row: text_of(tree) for row, tree in factors.items()}
        room.scenery.add_step({"id": name, "by": "integral", "function": function, "h": text_of(h), "c": told})
    except CheckError:
        return None
    return name


def multipliers(room: Room, function: Tree) -> tuple[Tree, dict[str, Tree]] | None:
    """h and c_i with h df = sum c_i row_i, by Cramer's rule for the rows that touch the function."""
    standing, evidence = room.standing, room.scenery.evidence
    if standing is None:
        return None
    pairs = dict(zip(standing.rows, standing.columns, strict=True))
    moved = {q for q in room.problem.coordinates if q in symbols_in(function)}
    rows: list[str] = []
    grown = True
    while grown:
        fresh = [row for row in pairs if row not in rows and moved & _moved(room, row)]
        grown = bool(fresh)
        rows += fresh
        moved |= {q for row in fresh for q in _moved(room, row)}
    for chosen in _fewer(rows):
        if len(chosen) <= LARGEST_CRAMER:
            columns = [pairs[row] for row in chosen]
            matrix = [[evidence.slope(row, column) for row in chosen] for column in columns]
            right = [derivative(function, column) for column in columns]
            h = determinant(matrix)
            factors = {
                row: determinant([[*line[:i], b, *line[i + 1 :]] for line, b in zip(matrix, right, strict=True)])
                for i, row in enumerate(chosen)
            }
            if _stands(room, function, h, factors):
                return h, factors
    return None


def _fewer(rows: list[str]) -> list[list[str]]:
    """One row, two, then all."""
    found = [[row] for row in rows]
    found += [[a, b] for i, a in enumerate(rows) for b in rows[:i]]
    return [*found[:20], rows]


def _stands(room: Room, function: Tree, h: Tree, factors: dict[str, Tree]) -> bool:
    evidence = room.scenery.evidence
    change = total_derivative(function, evidence.variables)
    rates = {
        row: one.left if one.kind == "velocity" else total_derivative(one.left, evidence.variables)
        for row, one in ((row, evidence.relation(row)) for row in factors)
    }
    total = add(*(times(factor, rates[row]) for row, factor in factors.items()))
    return evidence.ring.vanishes(add(times(h, change), negative(total)))


def _moved(room: Room, row: str) -> set[str]:
    one = room.scenery.evidence.relation(row)
    held = symbols_in(one.left)
    return {q for q in room.problem.coordinates if (q if one.kind == "finite" else f"{q}dot") in held}


def determinant(rows: list[list[Tree]]) -> Tree:
    """A small determinant."""
    if not rows:
        return ONE
    parts = []
    for j, entry in enumerate(rows[0]):
        rest = determinant([[*row[:j], *row[j + 1 :]] for row in rows[1:]])
        parts.append(times(entry, rest) if j % 2 == 0 else negative(times(entry, rest)))
    return add(*parts)
