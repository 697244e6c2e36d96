"""Curves and surfaces that relations describe: what a point may reach while all else stands still."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from dofkit.expressions.tree import Expr, coordinate
from dofkit.pictures.arrangement import Arrangement
from dofkit.pictures.evaluation import derivatives, evaluated, values_at, with_unit_rows
from dofkit.pictures.raster import require_matplotlib
from dofkit.pictures.shapes import Array, Role, Shape, Vertex, place
from dofkit.pictures.stage import StagedScene
from dofkit.system import GROUND, Connection, Relation

#: Points of a grid in the plane, and in each slice of space; slices in each direction; points of a drawn line.
GRID, SLICE_GRID, SLICES, DRAWN = 161, 41, 7, 60
#: Steps of a curve in space to either side.
STEPS = 220


def level_lines(value: Callable[[Array, Array], Array], box: Sequence[float], count: int = GRID) -> list[Array]:
    """Where a function of the plane is 0 in a box (low x, high x, low y, high y), as lines. Needs matplotlib."""
    require_matplotlib("a curve of an equation")
    x, y = np.meshgrid(np.linspace(box[0], box[1], count), np.linspace(box[2], box[3], count))
    z = np.ma.masked_invalid(np.broadcast_to(value(x, y), x.shape))
    if z.count() == 0 or float(z.min()) > 0 or float(z.max()) < 0 or float(np.ptp(z)) == 0:
        return []
    found = _axes().contour(x, y, z, levels=[0.0])
    segments = found.allsegs[0]
    found.remove()
    usual = float(np.median(np.abs(z.compressed())))
    segments = [s for s in segments if len(s) > 1 and _is_zero(value, s, usual)]
    return [s[:: max(1, len(s) // DRAWN)] if len(s) <= DRAWN else _thinned(s) for s in segments if len(s) > 1]


@cache
def _axes() -> Any:
    """Axes on which level lines are found; making them takes longer than finding."""
    from matplotlib.figure import Figure

    return Figure().add_subplot()


def _is_zero(value: Callable[[Array, Array], Array], line: Array, usual: float) -> bool:
    """Is a function small along a line, as it is not where it changes its sign through a pole?"""
    along = np.abs(np.broadcast_to(value(line[:, 0], line[:, 1]), len(line)))
    return bool(np.median(np.nan_to_num(along, nan=np.inf)) <= 0.5 * usual)


def _thinned(line: Array) -> Array:
    kept = np.unique(np.linspace(0, len(line) - 1, DRAWN).astype(int))
    return np.asarray(line[kept])


def locus(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """For each relation between places: a curve or surface of the one that it holds, or ties between several."""
    del connection
    alone: dict[str, list[Relation]] = {}
    ties = set()
    for relation in stage.system.constraints[number].relations:
        owners = _owners(stage, relation)
        if len(owners) == 1 and _is_place(stage, relation, owners[0]):
            alone.setdefault(owners[0], []).append(relation)
        elif len(owners) > 1:
            ties |= set(pairwise(owners))
    for first, second in sorted(ties):
        ends = (_origin(stage, first), _origin(stage, second))
        yield Shape("line", ends, "tie")
    shared = stage.system.constraints[number].facts.shared
    for owner, relations in list(alone.items())[: 1 if shared else None]:
        yield from _alone(stage, owner, relations)


def _owners(stage: StagedScene, relation: Relation) -> list[str]:
    """The particles and bodies whose coordinates or velocities a relation names."""
    named = {s.args[1] for s in relation.expr.symbols}
    return list(dict.fromkeys(c.owner for c in stage.system.coordinates if c.name in named and c.owner))


def _is_place(stage: StagedScene, relation: Relation, owner: str) -> bool:
    """Does it hold where the owner is, and nothing else?"""
    places = {coordinate(c.name) for c in stage.system.coordinates if c.owner == owner and c.role in ("x", "y", "z")}
    kinds = {s.args[0] for s in relation.expr.symbols}
    own = {s for s in relation.expr.symbols if s.args[0] == "coordinate"}
    return bool(own) and own <= places and kinds <= {"coordinate", "parameter", "time"}


def _origin(stage: StagedScene, owner: str) -> Vertex:
    if owner in stage.system.starts:
        return Vertex(owner, stage.arrangement.point(stage.system.starts[owner]))
    return Vertex(owner, (0.0, 0.0, 0.0))


def _alone(stage: StagedScene, owner: str, relations: Sequence[Relation]) -> Iterator[Shape]:
    """The curves or surfaces of one owner."""
    symbols = [coordinate(c.name) for c in stage.system.coordinates if c.owner == owner and c.role in ("x", "y", "z")]
    exprs = [r.expr for r in relations if r.sense == "="]
    bounds = _bounds(stage)
    for relation in relations:
        role: Role = "locus" if relation.sense == "=" and len(exprs) < len(symbols) else "surface"
        lines = lines_of_plane if len(symbols) == 2 else lines_of_space
        if len(symbols) == 1:
            continue
        for line in lines(stage.arrangement, relation.expr, symbols, bounds):
            yield Shape("line", tuple(Vertex(GROUND, place(p)) for p in line), role if len(symbols) == 2 else "surface")


def meeting_shapes(stage: StagedScene) -> Iterator[Shape]:
    """In space, the curve where two surfaces meet that hold the same particle or body."""
    if stage.system.dimension < 3:
        return
    held: dict[str, list[Expr]] = {}
    for number, constraint in enumerate(stage.system.constraints):
        for relation in constraint.relations if stage.symbol(number).run == "locus" else ():
            owners = _owners(stage, relation)
            if len(owners) == 1 and relation.sense == "=" and _is_place(stage, relation, owners[0]):
                held.setdefault(owners[0], []).append(relation.expr)
    for owner, exprs in held.items():
        symbols = [coordinate(c.name) for c in stage.system.coordinates if c.owner == owner][:3]
        line = curve(stage.arrangement, exprs, symbols, float(_bounds(stage)[0][1])) if len(exprs) > 1 else []
        if len(line) > 1:
            yield Shape("line", tuple(Vertex(GROUND, place(p)) for p in line), "locus", owner=owner)


def _bounds(stage: StagedScene) -> Array:
    """A box around the picture and the origin: low and high by direction."""
    middle = np.array(stage.centre)
    reach = [np.zeros(3), middle, *(pose.moved((0.0, 0.0, 0.0)) for pose in stage.arrangement.poses.values())]
    half = max(1.25, 1.35 * max(float(np.max(np.abs(p))) for p in reach))
    return np.array([[-half, half]] * 3)


def lines_of_plane(arrangement: Arrangement, e: Expr, symbols: Sequence[Expr], bounds: Array) -> Iterator[Array]:
    """Where an expression is 0, by two of its symbols."""
    numbers = arrangement.numbers

    def value(x: Array, y: Array) -> Array:
        return evaluated(e, {**numbers, symbols[0]: x, symbols[1]: y})

    yield from level_lines(value, (*bounds[0], *bounds[1]))


def lines_of_space(arrangement: Arrangement, e: Expr, symbols: Sequence[Expr], bounds: Array) -> Iterator[Array]:
    """The lines in which a surface meets planes across each direction."""
    numbers = arrangement.numbers
    for axis in range(3):
        i, j = [k for k in range(3) if k != axis]
        for height in np.linspace(bounds[axis][0], bounds[axis][1], SLICES + 2)[1:-1]:

            def value(a: Array, b: Array, axis: int = axis, h: float = float(height)) -> Array:
                i, j = [k for k in range(3) if k != axis]
                return evaluated(e, {**numbers, symbols[axis]: np.asarray(h), symbols[i]: a, symbols[j]: b})

            for line in level_lines(value, (*bounds[i], *bounds[j]), SLICE_GRID):
                found = np.zeros((len(line), 3))
                found[:, i], found[:, j], found[:, axis] = line[:, 0], line[:, 1], height
                yield found


def curve(arrangement: Arrangement, exprs: Sequence[Expr], symbols: Sequence[Expr], limit: float) -> list[Array]:
    """Where surfaces meet, followed from where the point stands until it closes or leaves the picture."""
    start = np.array([arrangement.numbers.get(s, 0.0) for s in symbols])
    ways = []
    for sign in (1.0, -1.0):
        point, way, found = start, None, []
        for k in range(STEPS):
            point, way = _ahead(arrangement, exprs, symbols, (point, way, sign * limit / 60))
            if way is None or float(np.max(np.abs(point))) > limit:
                break
            found.append(point)
            if k > 4 and float(np.linalg.norm(point - start)) < limit / 70:
                return [start, *found, start]
        ways.append(found)
    return [*reversed(ways[1]), start, *ways[0]]


def _ahead(
    arrangement: Arrangement, exprs: Sequence[Expr], symbols: Sequence[Expr], state: tuple[Array, Array | None, float]
) -> tuple[Array, Array | None]:
    """One step along a curve in space, and back onto it."""
    point, way, step = state
    known = {**arrangement.numbers, **dict(zip(symbols, point, strict=True))}
    rows = with_unit_rows(derivatives(exprs, symbols, known))
    _, singular, right = np.linalg.svd(rows)
    if len(singular) > 2 and singular[2] > 1e-4:
        return point, None
    ahead = right[2] if way is None or right[2] @ way >= 0 else -right[2]
    moved = point + step * ahead
    for _ in range(4):
        known = {**arrangement.numbers, **dict(zip(symbols, moved, strict=True))}
        gaps, slopes = values_at(exprs, known), derivatives(exprs, symbols, known)
        if not np.all(np.isfinite(gaps)):
            return point, None
        moved = moved - np.linalg.lstsq(slopes, gaps, rcond=None)[0]
    return moved, ahead


def profile(stage: StagedScene, number: int, connection: Connection) -> Iterator[Shape]:
    """The curve along which a point may slide, carried by the second member."""
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

    half = 1.6 * max(stage.size, 1.0)
    box = (here[0] - half * 1.3, here[0] + half * 1.3, here[1] - half * 1.3, here[1] + half * 1.3)
    for line in level_lines(value, box):
        rim = tuple(stage.carried(body, (float(p[0]), float(p[1]), 0.0)) for p in line)
        if np.linalg.norm(line[0] - line[-1]) < 0.05 * half and len(line) > 8 and body in stage.system.bodies:
            yield Shape("area", rim, "body", stage.state_of_body(body), body)
        else:
            yield Shape("line", rim, "locus")
