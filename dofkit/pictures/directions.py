"""Scenes of coordinates only: their axes, the directions that constraints allow, and those that brackets add."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from dofkit.base.errors import DofkitError
from dofkit.expressions.tree import TIME, Expr, coordinate
from dofkit.motion.loops import Field, bracket, by_pivots, by_size, fields_of_pivots
from dofkit.pictures.arrangement import Arrangement, geometric_equations, is_linear, velocity_rows
from dofkit.pictures.evaluation import kernel
from dofkit.pictures.loci import half_of
from dofkit.pictures.mechanism import notes_of, sketch_of
from dofkit.pictures.shapes import AT_REST, Array, Role, Shape, Sketch, circle, fixed, place
from dofkit.pictures.stage import StagedScene
from dofkit.pictures.words import alternative, answer, sure
from dofkit.report import Report
from dofkit.system import GROUND

#: Grid points of a planar field in each direction, and corners of a disc.
PLANE, CORNERS = 11, 24
#: Half the side of the box that is shown, the length of directions, and the step of difference quotients in brackets.
HALF, LONG, STEP = 1.2, 0.75, 1e-3
#: The least sine of the angle of a new direction, and the depth of brackets.
NEW, DEEPEST = 2e-2, 4
NOT_REGULAR = "the directions allowed at this configuration are no smooth fields near it: give a regular configuration"


class NoFormsError(DofkitError):
    """A scene has no directions to show, such as without differential constraints or with one coordinate."""


class Direction3(NamedTuple):
    """A vector at the first configuration, and the brackets that give it; ``order``: the number of their fields."""

    name: str
    vector: Array
    order: int


class Distribution:
    """The directions that all constraints allow, as smooth vector fields near the configuration of the scene.

    ``names``: the coordinates in order; ``fields``: the number of independent fields; ``timed``: whether time occurs,
    which is fixed.
    """

    def __init__(self, arrangement: Arrangement) -> None:
        self.arrangement = arrangement
        self.names = [c.name for c in arrangement.system.coordinates]
        self.symbols = [coordinate(n) for n in self.names]
        self.start = np.array([arrangement.numbers.get(s, 0.0) for s in self.symbols])
        self.timed = TIME in velocity_rows(arrangement.system, arrangement.numbers)[1]
        basis = self.basis(self.start)
        self.pivots = sorted(by_pivots(basis, by_size(basis, range(len(self.names))))[1])
        self.fields = len(basis)

    def values(self, q: Array) -> Mapping[Expr, float]:
        """Return the numbers of all symbols, with the coordinates q."""
        return {**self.arrangement.numbers, **dict(zip(self.symbols, map(float, q), strict=True))}

    def basis(self, q: Array) -> Array:
        """Return an orthonormal basis of the admissible directions at q as rows, with time fixed."""
        rows, columns = velocity_rows(self.arrangement.system, self.values(q))
        moving = [k for k, c in enumerate(columns) if c != TIME]
        return kernel(rows[:, moving], len(self.names))

    def at(self, q: Array) -> Array:
        """Return the vector fields at q: each moves one of the pivots at unit speed and no other pivot.

        Raises LinAlgError if there are no such fields.
        """
        return fields_of_pivots(self.basis(q), self.pivots)


def element(q: Iterable[float], directions: Array, size: float, role: Role = "field") -> Iterator[Shape]:
    """Yield the symbol of the admissible directions at a point: a short line, a disc for two, a ball for three."""
    middle = np.array(place(q))
    spanned = _orthonormal(directions)
    if len(spanned) == 1:
        yield Shape("line", fixed(middle - size * spanned[0], middle + size * spanned[0]), role)
    elif len(spanned) == 2:
        yield Shape("area", fixed(*(middle + size * (p[:2] @ spanned) for p in circle(CORNERS))), role)
    else:
        yield Shape("ball", fixed(middle), role, size=0.35 * size)


def _orthonormal(directions: Array) -> Array:
    """Return an orthonormal basis of what some directions of space span, as rows."""
    padded = np.zeros((len(directions), 3))
    padded[:, : directions.shape[1]] = directions
    _, singular, right = np.linalg.svd(padded)
    return np.asarray(right[: int(np.sum(singular > 1e-3))])


def elements(distribution: Distribution, half: float) -> Iterator[Shape]:
    """Yield the directions over a grid of the plane of two coordinates, about the configuration of the scene."""
    grids = [np.linspace(c - half, c + half, PLANE) for c in distribution.start]
    for center in product(*grids):
        directions = distribution.basis(np.array(center))
        if np.all(np.isfinite(directions)) and len(_orthonormal(directions)) == 1:
            yield from element(center, directions, 0.75 * half / (PLANE - 1))


# The picture


def phase_sketch(stage: StagedScene) -> Sketch:
    """Return the sketch of the admissible directions at a scene's configuration, and of those that brackets add.

    With two coordinates, the directions are also shown over a grid. Raises NoFormsError if there is nothing to show.
    """
    report, system = stage.report, stage.system
    if len(system.coordinates) < 2 or not any(e.form in ("pfaffian", "nonlinear") for e in report.constraints):
        raise NoFormsError("a picture of directions needs differential constraints and at least two coordinates")
    if not is_linear(system):
        raise NoFormsError("a picture of directions needs constraints that are linear in the velocities")
    distribution = Distribution(stage.arrangement)
    if not distribution.fields:
        raise NoFormsError("no admissible direction was found at this configuration")
    try:
        directions = directions_of(distribution)
    except np.linalg.LinAlgError:
        raise NoFormsError(NOT_REGULAR) from None
    chosen = _chosen(distribution, directions)
    shapes = [*elements(distribution, HALF)] if len(distribution.names) == 2 else []
    shapes += [*_at_start(distribution, directions, chosen)]
    names = [distribution.names[k] for k in chosen]
    axes = f"Shown: {', '.join(names)}."
    if len(names) < len(distribution.names):
        axes += f" Not shown: {', '.join(n for n in distribution.names if n not in names)}."
    if distribution.timed:
        axes += " Time is fixed."
    note = f"{_growth(report, directions)}; {axes[0].lower()}{axes[1:]}"
    return Sketch(
        title=f"{stage.title}: directions",
        dimension=max(2, len(chosen)),
        shapes=tuple(shapes),
        poses={GROUND: AT_REST},
        size=2 * HALF,
        answer=answer(report),
        alternative=f"{alternative(stage.scene, report)} {note if report.growth_vector is None else axes}",
        notes=(note, *(f"{d.name}: {_vector(distribution, d)}" for d in directions[:4]), *notes_of(stage)),
        axes=tuple(names),
    )


def _growth(report: Report, directions: Sequence[Direction3]) -> str:
    """Return a text with the report's growth vector, or with the one that the brackets at this point suggest."""
    if report.growth_vector is not None:
        return f"Growth vector ({', '.join(map(str, report.growth_vector))}){sure(report, 'growth_vector')}"
    depth = max(d.order for d in directions)
    dimensions = (str(sum(d.order <= k for d in directions)) for k in range(1, 1 + depth))
    return f"The growth vector is undecided; in floating point it is ({', '.join(dimensions)}) at this point"


def _vector(distribution: Distribution, direction: Direction3) -> str:
    pairs, least = zip(distribution.names, direction.vector, strict=True), 1e-3 * abs(direction.vector).max()
    return " + ".join(f"{v:.3g} d/d{n}" for n, v in pairs if abs(v) > least).replace("+ -", "- ")


def directions_of(distribution: Distribution) -> list[Direction3]:
    """Return the fields at the start, then the brackets that add a direction, by their order."""
    start = distribution.start

    def field(k: int) -> Field:
        return lambda q: distribution.at(q)[k]

    first = [(f"X{k + 1}", field(k)) for k in range(distribution.fields)]
    directions = [Direction3(name, x(start), 1) for name, x in first]
    level = list(first)
    for order in range(2, DEEPEST + 1):
        following = []
        for name, x in first:
            for other, y in level:
                if order == 2 and other <= name:
                    continue
                field_of_both = bracket(x, y, STEP * 4.0 ** (order - 2))
                vector = field_of_both(start)
                following.append((f"[{name}, {other}]", field_of_both))
                if _adds(directions, vector):
                    directions.append(Direction3(f"[{name}, {other}]", vector, order))
        level = following
        if len(directions) == len(start) or not any(d.order >= order - 1 for d in directions):
            break
    return directions


def _adds(directions: Sequence[Direction3], vector: Array) -> bool:
    """Return whether a vector is clearly independent of the directions."""
    size = float(np.linalg.norm(vector))
    if size < NEW or not np.isfinite(size):
        return False
    rows = np.array([d.vector / np.linalg.norm(d.vector) for d in directions] + [vector / size])
    return int(np.linalg.matrix_rank(rows, tol=NEW)) > len(directions)


def _chosen(distribution: Distribution, directions: Sequence[Direction3]) -> list[int]:
    """Return up to three coordinate numbers: those the directions depend on or brackets move, then the first ones."""
    count = len(distribution.names)
    if count <= 3:
        return list(range(count))
    here = distribution.at(distribution.start)

    def changes(q: Array) -> bool:
        try:
            return bool(np.max(np.abs(distribution.at(q) - here)) > 1e-6)
        except np.linalg.LinAlgError:
            return True

    weights = 10.0 * sum((np.abs(d.vector) > 1e-6).astype(float) for d in directions if d.order > 1) + np.zeros(count)
    for k in range(count):
        shifted = distribution.start.copy()
        shifted[k] += 0.37
        weights[k] += 20.0 * changes(shifted)
    return sorted(sorted(range(count), key=lambda k: (-weights[k], k))[:3])


def _at_start(distribution: Distribution, directions: Sequence[Direction3], chosen: Sequence[int]) -> Iterator[Shape]:
    """Yield the large symbol of the admissible directions at the configuration, and an arrow for each direction."""
    start = distribution.start[list(chosen)]
    admissible = np.array([d.vector[list(chosen)] for d in directions if d.order == 1])
    yield from element(start, admissible, 0.55 * LONG)
    for direction in directions:
        seen = direction.vector[list(chosen)]
        size = float(np.linalg.norm(seen))
        if size < 1e-6:
            continue
        role: Role = "guide" if direction.order == 1 else "bracket" if direction.order == 2 else "further"
        tip = start + LONG * seen / size
        yield Shape("line", fixed(start, tip), role, owner=direction.name)
        yield Shape("ball", fixed(tip), role, owner=direction.name, size=0.03)
        yield Shape("words", fixed(tip), "name", owner=direction.name, text=direction.name)


# Scenes of two or three coordinates


def coordinate_sketch(stage: StagedScene) -> Sketch:
    """Return the sketch of a scene of coordinates as a particle at this position, with the axes."""
    sketch = sketch_of(stage)
    shapes = (*_axes(stage), *_field(stage), *sketch.shapes)
    return replace(sketch, shapes=shapes, axes=(), alternative=f"{sketch.alternative} The axes are the coordinates.")


def _axes(stage: StagedScene) -> Iterator[Shape]:
    """Yield a line for each coordinate, with its name and marks at the whole numbers."""
    half = half_of(stage)
    for axis, direction in zip(stage.system.coordinates, np.eye(3), strict=False):
        yield Shape("line", fixed(-half * direction, half * direction), "axis")
        yield Shape("words", fixed(1.06 * half * direction), "name", text=axis.name)
        side = 0.03 * half * np.roll(direction, 1 if direction[1] == 0 else -1)
        for tick in range(-int(half), int(half) + 1):
            if tick and half < 12:
                yield Shape("line", fixed(tick * direction - side, tick * direction + side), "axis")
        yield Shape("words", fixed(direction - 2.6 * side), "name", text="1")


def _field(stage: StagedScene) -> Iterator[Shape]:
    """Yield the directions that constraints of velocities allow, over the plane of two coordinates."""
    system = stage.system
    finite = geometric_equations(system, ("=", ">=", ">"))
    written = [r.expr for c in system.constraints for r in c.relations]
    if system.dimension == 2 and len(written) > len(finite) and is_linear(system):
        yield from elements(Distribution(stage.arrangement), 0.9 * half_of(stage))
