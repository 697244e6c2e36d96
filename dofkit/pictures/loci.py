"""Curves and surfaces of equations: the positions that a point can reach while everything else is at rest."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise, takewhile
from typing import Any

import numpy as np

from dofkit.expressions.tree import Expr, coordinate
from dofkit.motion.continuation import Follower, trail
from dofkit.motion.poses import PoseRelations
from dofkit.pictures.arrangement import Arrangement
from dofkit.pictures.evaluation import evaluated
from dofkit.pictures.files import require_matplotlib
from dofkit.pictures.shapes import Array, Role, Shape, fixed
from dofkit.pictures.stage import StagedScene
from dofkit.system import Connection, Relation

#: Grid points per direction in the plane, and in a slice of space; slices per direction; the most points of a line in
#: the plane, and in a slice.
GRID, SLICE_GRID, SLICES, DRAWN, FEW_DRAWN = 161, 41, 6, 120, 22
#: The most steps of a curve in space in each direction.
STEPS = 220


def level_lines(value: Callable[[Array, Array], Array], box: Sequence[float], count: int = GRID) -> list[Array]:
    """Return the lines on which a function is 0 in a box (low x, high x, low y, high y). Needs matplotlib."""
    require_matplotlib("a curve of an equation")
    x, y = np.meshgrid(np.linspace(box[0], box[1], count), np.linspace(box[2], box[3], count))
    z = np.ma.masked_invalid(np.broadcast_to(value(x, y), x.shape))
    if z.count() == 0 or float(z.min()) > 0 or float(z.max()) < 0 or float(np.ptp(z)) == 0:
        return []
    from contourpy import contour_generator

    contours: Any = contour_generator(x, y, z, name="mpl2014")
    segments = contours.lines(0.0)[0]
    usual = float(np.median(np.abs(z.compressed())))
    most = DRAWN if count == GRID else FEW_DRAWN
    return [_thinned(s, most) for s in segments if len(s) > 1 and _is_zero(value, s, usual)]


def _is_zero(value: Callable[[Array, Array], Array], line: Array, usual: float) -> bool:
    """Return whether a function is small along a line, and so does not change sign there through a pole."""
    along = np.abs(np.broadcast_to(value(line[:, 0], line[:, 1]), len(line)))
    return bool(np.median(np.nan_to_num(along, nan=np.inf)) <= 0.5 * usual)


def _thinned(line: Array, most: int) -> Array:
    kept = np.unique(np.linspace(0, len(line) - 1, most).astype(int))
    return line if len(line) <= most else np.asarray(line[kept])


def locus(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """Yield the curve or surface of each relation on one carrier; for relations on several, lines between them."""
    del connection
    constraint = stage.system.constraints[number]
    alone: dict[str, list[Relation]] = {}
    ties = set()
    for relation in constraint.relations:
        owners = _owners(stage, relation)
        if len(owners) == 1 and _is_place(stage, relation, owners[0]):
            alone.setdefault(owners[0], []).append(relation)
        elif len(owners) > 1:
            ties |= set(pairwise(owners))
    for first, second in sorted(ties):
        yield Shape("line", (stage.origin(first), stage.origin(second)), "tie")
    for owner, relations in list(alone.items())[: 1 if constraint.facts.shared else None]:
        yield from _alone(stage, owner, relations)


def _owners(stage: StagedScene, relation: Relation) -> list[str]:
    """Return the particles and bodies whose coordinates or velocities a relation contains."""
    names = {s.args[1] for s in relation.expr.symbols}
    return list(dict.fromkeys(c.owner for c in stage.system.coordinates if c.name in names and c.owner))


def _position(stage: StagedScene, owner: str) -> list[Expr]:
    """Return the coordinates of a carrier's position."""
    return [coordinate(c.name) for c in stage.system.coordinates if c.owner == owner and c.role in ("x", "y", "z")]


def _is_place(stage: StagedScene, relation: Relation, owner: str) -> bool:
    """Return whether a relation restricts the position of its owner and nothing else."""
    kinds = {s.args[0] for s in relation.expr.symbols}
    coordinates = {s for s in relation.expr.symbols if s.args[0] == "coordinate"}
    restricts = bool(coordinates) and coordinates <= set(_position(stage, owner))
    return restricts and kinds <= {"coordinate", "parameter", "time"}


def _alone(stage: StagedScene, owner: str, relations: Sequence[Relation]) -> Iterator[Shape]:
    """Yield the curves or surfaces of one carrier."""
    symbols = _position(stage, owner)
    equations = [r for r in relations if r.sense == "="]
    if len(symbols) == 1:
        return
    for relation in relations:
        curve_role = relation.sense == "=" and len(equations) < len(symbols) == 2
        role: Role = "locus" if curve_role else "surface"
        for line in lines_of(stage.arrangement, relation.expr, symbols, half_of(stage)):
            yield Shape("line", fixed(*line), role)


def meeting_shapes(stage: StagedScene) -> Iterator[Shape]:
    """Yield, in space, the curve in which two surfaces meet that restrict the same particle or body."""
    if stage.system.dimension < 3:
        return
    surfaces: dict[str, list[Expr]] = {}
    for number, constraint in enumerate(stage.system.constraints):
        for relation in constraint.relations if stage.symbol(number).run == "locus" else ():
            owners = _owners(stage, relation)
            if len(owners) == 1 and relation.sense == "=" and _is_place(stage, relation, owners[0]):
                surfaces.setdefault(owners[0], []).append(relation.expr)
    for owner, exprs in surfaces.items():
        symbols = [coordinate(c.name) for c in stage.system.coordinates if c.owner == owner][:3]
        line = curve(stage.arrangement, exprs, symbols, 2 * half_of(stage)) if len(exprs) > 1 else []
        if len(line) > 1:
            yield Shape("line", fixed(*line), "locus", owner=owner)


def half_of(stage: StagedScene) -> float:
    """Return half the side of a cube about the origin that contains the picture."""
    origins = (pose.moved((0.0, 0.0, 0.0)) for pose in stage.arrangement.poses.values())
    reach = [np.zeros(3), np.array(stage.centre), *origins]
    return max(1.25, 1.35 * max(float(np.max(np.abs(p))) for p in reach))


def lines_of(arrangement: Arrangement, e: Expr, symbols: Sequence[Expr], half: float) -> Iterator[Array]:
    """Yield lines on which an expression is 0: curves for two symbols, plane sections of a surface for three."""
    if len(symbols) == 2:
        yield from _slice(arrangement, e, symbols, {}, half)
        return
    for axis in range(3):
        i, j = [k for k in range(3) if k != axis]
        for height in np.linspace(-half, half, SLICES + 2)[1:-1]:
            plane = {symbols[axis]: np.asarray(float(height))}
            for line in _slice(arrangement, e, (symbols[i], symbols[j]), plane, half):
                points = np.zeros((len(line), 3))
                points[:, i], points[:, j], points[:, axis] = line[:, 0], line[:, 1], height
                yield points


def _slice(
    arrangement: Arrangement, e: Expr, symbols: Sequence[Expr], plane: dict[Expr, Array], half: float
) -> list[Array]:
    """Return the lines on which an expression is 0 in a square, by two symbols; ``plane``: the value of a third."""

    def value(x: Array, y: Array) -> Array:
        return evaluated(e, {**arrangement.numbers, **plane, symbols[0]: x, symbols[1]: y})

    return level_lines(value, (-half, half, -half, half), SLICE_GRID if plane else GRID)


def curve(arrangement: Arrangement, exprs: Sequence[Expr], symbols: Sequence[Expr], limit: float) -> list[Array]:
    """Return the intersection curve of surfaces, followed from the point until it closes or leaves the picture."""
    relations = PoseRelations(arrangement.system, exprs, (), frozenset())
    relations.constants |= arrangement.numbers
    columns = [relations.plain.index(s) for s in symbols]
    others = np.delete(np.eye(relations.columns), columns, axis=0)
    follower, step = Follower(relations, 1, others), limit / 60 / arrangement.system.size
    start = follower.onto(relations.pose(arrangement.numbers))
    if start is None:
        return []
    ahead, back = follower.begin(start, None, step)
    poses, closed = trail(follower, start, ahead, STEPS, step)
    before = [] if closed else trail(follower, start, back, STEPS, step)[0]
    halves = [[pose.plain[columns] for pose in half] for half in (before, poses)]
    ends = [list(takewhile(lambda p: float(np.max(np.abs(p))) <= limit, half)) for half in halves]
    return [*reversed(ends[0]), start.plain[columns], *ends[1]]


def profile(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """Yield the profile of a cam on the second member: where the follower's point can be; an area if it is closed."""
    relations = stage.system.constraints[number].relations
    vertex = next(stage.vertices(connection), None)
    if not relations or vertex is None:
        return
    owner, body = vertex.carrier, connection.members[-1]
    symbols = [coordinate(c.name) for c in stage.system.coordinates if c.owner == owner][:2]
    here = stage.here(vertex)
    numbers = stage.arrangement.numbers
    if len(symbols) < 2:
        return
    starts = [numbers.get(s, 0.0) for s in symbols]

    def value(x: Array, y: Array) -> Array:
        moved = {symbols[0]: x - here[0] + starts[0], symbols[1]: y - here[1] + starts[1]}
        return evaluated(relations[0].expr, {**numbers, **moved})

    half = 1.6 * stage.size
    box = (here[0] - half * 1.3, here[0] + half * 1.3, here[1] - half * 1.3, here[1] + half * 1.3)
    for line in level_lines(value, box):
        rim = tuple(stage.carried(body, (float(p[0]), float(p[1]), 0.0)) for p in line)
        if np.linalg.norm(line[0] - line[-1]) < 0.05 * half and len(line) > 8 and body in stage.system.bodies:
            yield Shape("area", rim, "body", stage.state_of_body(body), body)
        else:
            yield Shape("line", rim, "locus")
