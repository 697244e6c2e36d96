"""From a scene and its report to a sketch of the mechanism."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.expressions.tree import parameter
from dofkit.pictures.alternative import alternative, answer
from dofkit.pictures.bodies import body_shapes, force_shapes, particle_shapes, rail_shapes
from dofkit.pictures.loci import meeting_shapes
from dofkit.pictures.runs import run_shapes
from dofkit.pictures.shapes import Shape, Sketch, State, Vertex, place
from dofkit.pictures.stage import StagedScene
from dofkit.pictures.symbols import joint_shapes, name_of

#: More names of constraints than this are left out, and so many equations are told below.
MOST_NAMES, MOST_TEXTS = 24, 4
_WEIGHT: tuple[State, ...] = ("plain", "moving", "redundant", "conflicting")
FREE_PLACES = "Schematic: the scene gives no positions of its joints."


def sketch_of(stage: StagedScene) -> Sketch:
    """The sketch of a mechanism."""
    shapes = [*rail_shapes(stage), *body_shapes(stage), *force_shapes(stage)]
    for number in range(len(stage.system.constraints)):
        shapes += run_shapes(stage, number)
        shapes += joint_shapes(stage, number)
    shapes += [*meeting_shapes(stage), *particle_shapes(stage), *_names(stage)]
    return Sketch(
        title=stage.scene.title or stage.scene.name,
        dimension=stage.system.dimension,
        shapes=tuple(shapes),
        poses=stage.arrangement.poses,
        size=stage.size,
        answer=answer(stage.report),
        alternative=alternative(stage.scene, stage.report),
        notes=tuple(notes_of(stage)),
        meanings=stage.meanings,
        measurable=stage.measurable,
    )


def _names(stage: StagedScene) -> Iterator[Shape]:
    """The names that were given to constraints, one for those at one place."""
    told: dict[tuple[Vertex, ...], list[int]] = {}
    named = [k for k, c in enumerate(stage.scene.constraints) if c.name is not None]
    for number in named if len(named) <= MOST_NAMES else ():
        anchor = _anchor(stage, number)
        if anchor:
            told.setdefault(anchor, []).append(number)
    for anchor, numbers in told.items():
        names = [stage.system.constraints[k].name for k in numbers]
        states: list[State] = [stage.state(name) for name in names]
        yield name_of(stage, ", ".join(names), anchor, max(states, key=_WEIGHT.index))


def _anchor(stage: StagedScene, number: int) -> tuple[Vertex, ...]:
    """What the name of a constraint stands beside."""
    connection, at = stage.system.connections[number], stage.places[number]
    symbol = stage.symbol(number)
    if symbol.run in ("bar", "bars", "rope"):
        return tuple(stage.vertices(connection))[:2]
    if symbol.run == "teeth":
        pins = [stage.places[k] for k, c in enumerate(stage.system.connections) if c.facts.axial]
        spots = [Vertex(m, p) for m, p in zip(connection.members, pins, strict=False) if p is not None]
        return tuple(spots[-2:])
    if at is None or not connection.members:
        return ()
    member = next((m for m in connection.members if m in stage.system.bodies), connection.members[0])
    return (Vertex(member, place(stage.spot(number, member))),)


def notes_of(stage: StagedScene) -> Iterator[str]:
    """What is told below a picture."""
    if stage.unseen is not None:
        yield stage.unseen
    if stage.schematic:
        yield FREE_PLACES
    elif stage.arrangement.note is not None:
        yield stage.arrangement.note
    used = {s for c in stage.system.constraints for r in c.relations for s in r.expr.symbols}
    shown = [p for p in stage.system.parameters if parameter(p) in used]
    if shown:
        told = ", ".join(f"{p} = {stage.arrangement.numbers.get(parameter(p), 1.0):.4g}" for p in shown[:6])
        yield f"Drawn with {told}."
    if stage.system.functions:
        yield f"Unknown functions ({', '.join(stage.system.functions)}) are drawn as an example."
    yield from equations_told(stage)


def equations_told(stage: StagedScene) -> Iterator[str]:
    """The equations of a scene, as they are written."""
    written = [c for c in stage.system.constraints if c.facts.written]
    for constraint in written[:MOST_TEXTS]:
        yield f"{constraint.name}: {constraint.text}"
    if len(written) > MOST_TEXTS:
        yield f"{len(written) - MOST_TEXTS} more equations are not listed."
