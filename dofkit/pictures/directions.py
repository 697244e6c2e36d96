"""The directions that forms allow, and those that their brackets add: a growth vector, in up to three coordinates."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from dofkit.base.errors import DofkitError
from dofkit.pictures.alternative import alternative, answer
from dofkit.pictures.fields import Distribution, element, elements
from dofkit.pictures.mechanism import notes_of
from dofkit.pictures.rates import is_linear
from dofkit.pictures.shapes import AT_REST, Array, Role, Shape, Sketch, Vertex, place
from dofkit.pictures.stage import StagedScene
from dofkit.pictures.states import sure
from dofkit.report import Report
from dofkit.system import GROUND

#: Half of the box that is shown, the length of directions, the step of brackets, and the sides of their square.
HALF, LONG, STEP, SIDE = 1.2, 0.75, 1e-3, 0.55
#: What counts as a new direction, and steps of a path.
NEW, PARTS = 2e-2, 16
#: Brackets of brackets are looked for so deep.
DEEPEST = 4


_Field = Callable[[Array], Array]


class NoFormsError(DofkitError):
    """A picture of directions was asked of a scene whose constraints are all finite, or which has one coordinate."""


class Direction3(NamedTuple):
    """A vector at the first configuration, and the brackets that give it; ``order``: how many fields it takes."""

    name: str
    vector: Array
    order: int


def phase_sketch(stage: StagedScene) -> Sketch:
    """The allowed directions of a scene's forms about its configuration, and what their brackets add."""
    report, system = stage.report, stage.system
    if len(system.coordinates) < 2 or not any(e.form in ("pfaffian", "nonlinear") for e in report.constraints):
        raise NoFormsError("a picture of directions needs differential constraints and at least two coordinates")
    if not is_linear(stage.arrangement):
        raise NoFormsError("a picture of directions needs constraints that are linear in the velocities")
    distribution = Distribution(stage.arrangement)
    if not distribution.fields:
        raise NoFormsError("no admissible direction was found at this configuration")
    found = directions_of(distribution)
    shown = _shown(distribution, found)
    shapes = [*elements(distribution, shown, HALF)] if len(shown) > 1 else []
    shapes += _at_start(distribution, found, shown)
    shapes += _square(distribution, shown)
    names = [distribution.names[k] for k in shown]
    axes = f"hown: {', '.join(names)}."
    if len(names) < len(distribution.names):
        axes += f" Not shown: {', '.join(n for n in distribution.names if n not in names)}."
    if distribution.timed:
        axes += " Time is fixed."
    note = f"{_growth(report, found)}; s{axes}"
    return Sketch(
        title=f"{stage.scene.title or stage.scene.name}: directions",
        dimension=max(2, len(shown)),
        shapes=tuple(shapes),
        poses={GROUND: AT_REST},
        size=2 * HALF,
        answer=answer(report),
        alternative=f"{alternative(stage.scene, report)} {note if report.growth_vector is None else f'S{axes}'}",
        notes=(note, *(f"{d.name}: {_told(distribution, d)}" for d in found[:4]), *notes_of(stage)),
        axes=tuple(names),
    )


def _growth(report: Report, found: Sequence[Direction3]) -> str:
    """The report's growth vector; where it has none, what the brackets at this place make likely."""
    if report.growth_vector is not None:
        return f"Growth vector ({', '.join(map(str, report.growth_vector))}){sure(report, 'growth_vector')}"
    seen = (str(sum(d.order <= k for d in found)) for k in range(1, 1 + max(d.order for d in found)))
    return f"The growth vector is undecided; in floating point it is ({', '.join(seen)}) at this point"


def _told(distribution: Distribution, direction: Direction3) -> str:
    pairs = zip(distribution.names, direction.vector, strict=True)
    return " + ".join(f"{v:.3g} d/d{n}" for n, v in pairs if abs(v) > 1e-6).replace("+ -", "- ")


def directions_of(distribution: Distribution) -> list[Direction3]:
    """The fields at the start, then the brackets that add a direction, by order: as many as the growth vector tells."""
    start, count = distribution.start, distribution.fields

    def field(k: int) -> _Field:
        return lambda q: distribution.at(q)[k]

    names = [f"X{k + 1}" for k in range(count)]
    level: list[tuple[str, _Field]] = [(name, field(k)) for k, name in enumerate(names)]
    found = [Direction3(name, x(start), 1) for name, x in level]
    first = list(level)
    for order in range(2, DEEPEST + 1):
        following = []
        for name, x in first:
            for other, y in level:
                if order == 2 and other <= name:
                    continue
                bracket = _bracket(x, y, STEP * 4.0 ** (order - 2))
                vector = bracket(start)
                following.append((f"[{name}, {other}]", bracket))
                if _adds(found, vector):
                    found.append(Direction3(f"[{name}, {other}]", vector, order))
        level = following
        if len(found) == len(start) or not any(d.order >= order - 1 for d in found):
            break
    return found


def _bracket(x: _Field, y: _Field, step: float) -> _Field:
    """[X, Y] = DY X - DX Y, by differences along both."""

    def along(f: _Field, q: Array, v: Array) -> Array:
        return np.asarray((f(q + step * v) - f(q - step * v)) / (2 * step))

    return lambda q: along(y, q, x(q)) - along(x, q, y(q))


def _adds(found: Sequence[Direction3], vector: Array) -> bool:
    """Is a vector clear of what is spanned already?"""
    size = float(np.linalg.norm(vector))
    if size < NEW or not np.isfinite(size):
        return False
    rows = np.array([d.vector / np.linalg.norm(d.vector) for d in found] + [vector / size])
    return int(np.linalg.matrix_rank(rows, tol=NEW)) > len(found)


def _shown(distribution: Distribution, found: Sequence[Direction3]) -> list[int]:
    """Up to three coordinates: those in which brackets show, then the first."""
    count = len(distribution.names)
    if count <= 3:
        return list(range(count))
    weights = sum((np.abs(d.vector) > 1e-6).astype(float) * (10.0 if d.order > 1 else 0.0) for d in found)
    varying = _varying(distribution)
    ranked = sorted(range(count), key=lambda k: (-float(np.atleast_1d(weights)[k % count]) - 20.0 * varying[k], k))
    return sorted(ranked[:3])


def _varying(distribution: Distribution) -> list[bool]:
    """Which coordinates the allowed directions depend on."""
    found, here = [], distribution.at(distribution.start)
    for k in range(len(distribution.names)):
        moved = distribution.start.copy()
        moved[k] += 0.37
        found.append(bool(np.max(np.abs(distribution.at(moved) - here)) > 1e-6))
    return found


def _at_start(distribution: Distribution, found: Sequence[Direction3], shown: Sequence[int]) -> Iterator[Shape]:
    """What is allowed where the scene stands, large; and each new direction of a bracket as an arrow."""
    start = distribution.start[list(shown)]
    allowed = np.array([d.vector[list(shown)] for d in found if d.order == 1])
    yield from element(start, allowed, 0.55 * LONG)
    for direction in found:
        seen = direction.vector[list(shown)]
        size = float(np.linalg.norm(seen))
        if size < 1e-6:
            continue
        role: Role = "guide" if direction.order == 1 else "bracket" if direction.order == 2 else "further"
        tip = start + LONG * seen / size
        yield Shape("line", _path([start, tip]), role, owner=direction.name)
        yield Shape("ball", _path([tip]), role, owner=direction.name, size=0.03)
        yield Shape("words", _path([tip]), "name", owner=direction.name, text=direction.name)


def _square(distribution: Distribution, shown: Sequence[int]) -> Iterator[Shape]:
    """Along X1, X2, back along X1, back along X2: where that ends is aside, along the bracket."""
    if distribution.fields < 2 or len(shown) < 3:
        return
    q, path = distribution.start.copy(), [distribution.start.copy()]
    for k, sign in ((0, 1.0), (1, 1.0), (0, -1.0), (1, -1.0)):
        for _ in range(PARTS):
            half = q + sign * SIDE / PARTS / 2 * distribution.at(q)[k]
            q = q + sign * SIDE / PARTS * distribution.at(half)[k]
            path.append(q)
    seen = [p[list(shown)] for p in path]
    yield Shape("line", _path(seen), "trace", owner="square")
    yield Shape("ball", _path([seen[-1]]), "trace", owner="square", size=0.025)


def _path(points: Sequence[Array]) -> tuple[Vertex, ...]:
    return tuple(Vertex(GROUND, place(p)) for p in points)
