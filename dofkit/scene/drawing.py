"""The drawing of a scene: the frames of its bodies, and where its particles stand, before any constraint is read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from dofkit.base.errors import Fault
from dofkit.expressions.enclosures import differs_from_zero
from dofkit.expressions.tree import ONE, ZERO, Expr, coordinate
from dofkit.expressions.vectors import Vec
from dofkit.scene.frames import Chart, Frame, Placed
from dofkit.scene.ledger import Texts
from dofkit.scene.names import Declared, Vocabulary
from dofkit.scene.parts import Particle
from dofkit.system import GROUND


@dataclass(frozen=True)
class Drawing:
    """What particles and bodies of a scene are in its coordinates, and where they are drawn.

    ``configuration``: the values given of coordinates. ``points``: places given as numbers or texts; ``drawn``: the
    bodies that the configuration places. ``faults``: those of the configuration and of the particles' places.
    """

    vocabulary: Vocabulary
    dimension: int
    tolerance: Fraction | None
    configuration: Mapping[str, Expr]
    particles: Mapping[str, Placed]
    ground: Frame
    frames: Mapping[str, Frame]
    points: tuple[Vec, ...]
    drawn: frozenset[str]
    faults: tuple[Fault, ...]


def drawing_of(scene: Declared, vocabulary: Vocabulary, mentioned: frozenset[str]) -> Drawing:
    """The drawing of a scene; a spatial body of whose angles one is ``mentioned`` keeps its Euler angles."""
    configuration, faults = _configuration(scene, vocabulary)
    points: list[Vec] = []
    particles: dict[str, Placed] = {}
    for index, particle in enumerate(scene.particles):
        names, stands = vocabulary.table.particles[particle.name], None
        if particle.at is not None or configuration:
            texts = Texts(vocabulary.texts, ("particles", index), len(vocabulary.faults) + len(faults))
            stands = _place(texts, particle, names, configuration)
            faults += texts.faults
            points += [] if stands is None else [stands]
        particles[particle.name] = Placed(tuple([coordinate(n) for n in names]), ONE, stands, None, particle.name)
    origin = (ZERO,) * scene.dimension
    return Drawing(
        vocabulary=vocabulary,
        dimension=scene.dimension,
        tolerance=scene.tolerance,
        configuration=configuration,
        particles=particles,
        ground=Frame(GROUND, origin, origin, "fixed"),
        frames=_frames(scene.dimension, vocabulary, configuration, mentioned),
        points=tuple(points),
        drawn=frozenset(b for b, names in vocabulary.table.bodies.items() if any(n in configuration for n in names)),
        faults=tuple(faults),
    )


def _configuration(scene: Declared, vocabulary: Vocabulary) -> tuple[dict[str, Expr], list[Fault]]:
    texts = Texts(vocabulary.texts, ("configuration",), len(vocabulary.faults))
    known = [q.name for q in vocabulary.table.coordinates]
    names = frozenset(known)
    values: dict[str, Expr] = {}
    for name, value in scene.configuration.items():
        if name in names:
            values[name] = texts.fixed(value, name)
        else:
            texts.unknown("coordinate", name, known, name)
    return values, texts.faults


def _place(texts: Texts, particle: Particle, names: tuple[str, ...], configuration: Mapping[str, Expr]) -> Vec | None:
    """Where a particle stands in the reference configuration."""
    stands = None if particle.at is None else texts.vector(particle.at, len(names), "at")
    given = [name for name in names if name in configuration]
    if stands is not None and given:
        for name, part in zip(names, stands, strict=True):
            if name in configuration and differs_from_zero(configuration[name] - part):
                message = f"'{particle.name}' is given two positions: `at`, and {name} in `configuration`"
                texts.fault(message, "at", hint="leave one of them out")
    if stands is None and len(given) == len(names):
        stands = tuple(configuration[name] for name in names)
    return stands


def _frames(
    d: int, vocabulary: Vocabulary, configuration: Mapping[str, Expr], mentioned: frozenset[str]
) -> dict[str, Frame]:
    frames: dict[str, Frame] = {}
    for body, names in vocabulary.table.bodies.items():
        values = [configuration.get(name, ZERO) for name in names]
        chart: Chart = "line" if d == 1 else "plane"
        if d == 3:
            chart = "gibbs" if mentioned.isdisjoint(names[3:]) else "euler"
        position = tuple(coordinate(name) for name in names[:d])
        frames[body] = Frame(body, position, tuple(values[:d]), chart, names[d:], tuple(values[d:]))
    return frames
