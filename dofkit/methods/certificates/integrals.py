"""Integrals of forms in the presence of other relations: cofactors by Cramer's rule."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.checker.trees import ONE, ZERO, CheckError, Tree, add, derivative, negative, times
from dofkit.methods.certificates.dependence import rate_of
from dofkit.methods.certificates.elimination import echelon, solved
from dofkit.methods.certificates.estimates import Estimates, NoEstimateError
from dofkit.methods.certificates.room import Room, Told
from dofkit.methods.certificates.substitutions import Order, needed_puts, puts, with_puts
from dofkit.methods.certificates.texts import text_of

#: The most rows of a determinant that is written out.
LARGEST_CRAMER = 5
Components = dict[str, Tree]


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
    tree = room.scenery.evidence.text(function)
    target = {v: derivative(tree, v) for v in room.scenery.evidence.variables}
    step = {"id": name, "by": "integral", "function": function}
    return name if _combined(room, step, target, moving_rows(room)) else None


def moving_rows(room: Room) -> list[str]:
    """The velocity relations, and the rates of the finite ones."""
    found = []
    for name in room.equations:
        finite = room.scenery.evidence.relation(name).kind == "finite"
        row = rate_of(room.scenery, name) if finite else name
        found += [row] if row else []
    return found


def follows_from_integrals(room: Room, name: str, steps: Sequence[str]) -> bool:
    """Whether a step was found by which a form follows from integrals and finite relations."""
    step = f"{room.scenery.label}{name} from integrals"
    if room.scenery.has_step(step):
        return True
    sources = [rate for one in (*steps, *room.scenery.evidence.finite) if (rate := rate_of(room.scenery, one))]
    return _combined(room, {"id": step, "by": "implied", "of": name}, components(room, name), sources)


def _combined(room: Room, step: Told, target: Components, sources: Sequence[str]) -> bool:
    """Whether a step stands up with cofactors, where need be after coordinates that relations give are put in."""
    rows = {one: components(room, one) for one in sources}
    for order in ([], puts(room.scenery, room.scenery.evidence.finite)):
        placed = {one: _placed(room, row, order) for one, row in rows.items()}
        found = cofactors(room, _placed(room, target, order), placed)
        if found is None:
            continue
        h, factors = found
        used = [*target.values(), h, *factors.values(), *(tree for row in factors for tree in rows[row].values())]
        told = {"h": text_of(h), "c": {row: text_of(factor) for row, factor in factors.items()}}
        put = needed_puts(room.scenery, used, order)
        try:
            room.scenery.add_step({**step, **told, **({"put": put} if put else {})})
        except CheckError:
            continue
        return True
    return False


def _placed(room: Room, row: Components, order: Order) -> Components:
    return {v: with_puts(room.scenery, tree, order) for v, tree in row.items()} if order else row


def components(room: Room, name: str) -> Components:
    """The components of a linear relation of velocities."""
    left = room.scenery.evidence.relation(name).left
    return {v: derivative(left, f"{v}dot") for v in room.scenery.evidence.variables}


def cofactors(room: Room, target: Components, rows: dict[str, Components]) -> tuple[Tree, dict[str, Tree]] | None:
    """h and c_i with h target = sum c_i row_i identically; None where a few rows do not do."""
    if room.point is None:
        return None
    try:
        chosen, columns = _chosen(room, target, rows)
    except NoEstimateError:
        return None
    if len(chosen) > LARGEST_CRAMER:
        return None
    matrix = [[rows[row][column] for row in chosen] for column in columns]
    right = [target[column] for column in columns]
    h = determinant(matrix)
    found = {
        row: determinant([[*line[:i], b, *line[i + 1 :]] for line, b in zip(matrix, right, strict=True)])
        for i, row in enumerate(chosen)
    }
    ring = room.scenery.evidence.ring
    for v in room.scenery.evidence.variables:
        total = add(*(times(factor, rows[row][v]) for row, factor in found.items()))
        if not ring.vanishes(add(times(h, target[v]), negative(total))):
            return None
    return h, found


def _chosen(room: Room, target: Components, rows: dict[str, Components]) -> tuple[list[str], list[str]]:
    """The sources that matter, at the point or beside it, and columns in which they are independent."""
    used: set[str] = set()
    floats = room.point.floats if room.point is not None else {}
    for shift in (0.0, 0.0625):
        moved = {name: value + shift * (1 + i % 5) for i, (name, value) in enumerate(floats.items())}
        estimates = Estimates(moved)
        numbers = {row: _floats(room, estimates, one) for row, one in rows.items()}
        pivots = echelon(list(numbers.values())).pivots
        kept = [list(rows)[p.row] for p in pivots]
        goal = _floats(room, estimates, target)
        square = [{row: numbers[row].get(p.column, 0.0) for row in kept} for p in pivots]
        found = solved(square, [goal.get(p.column, 0.0) for p in pivots], kept) or {}
        used |= {row for row, value in found.items() if abs(value) > 1e-9}
    chosen = [row for row in rows if row in used]
    estimates = Estimates(floats)
    pivots = echelon([_floats(room, estimates, rows[row]) for row in chosen]).pivots
    return [chosen[p.row] for p in pivots], [p.column for p in pivots]


def _floats(room: Room, estimates: Estimates, row: Components) -> dict[str, float]:
    return {v: estimates.value(room.scenery.chosen(tree)) for v, tree in row.items() if tree != ZERO}


def determinant(rows: list[list[Tree]]) -> Tree:
    """A small determinant."""
    if not rows:
        return ONE
    parts = []
    for j, entry in enumerate(rows[0]):
        rest = determinant([[*row[:j], *row[j + 1 :]] for row in rows[1:]])
        parts.append(times(entry, rest) if j % 2 == 0 else negative(times(entry, rest)))
    return add(*parts)
