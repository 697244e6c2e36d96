"""What is left to say of a scene that was never read as mathematics."""

from __future__ import annotations

from dofkit.classification.undecided import open_entry, open_report, why_nothing
from dofkit.report import Count, ForceEntry, Report
from dofkit.scene.elaboration import names_by_position
from dofkit.scene.scene import Scene
from dofkit.system import BODY_ROLES, Constraint


def blank(scene: Scene, why: str) -> Report:
    """A report on a scene that could not even be read as mathematics in time: its equations are not counted."""
    d, particles, bodies = scene.dimension, len(scene.particles), len(scene.bodies)
    coordinates = d * particles + len(BODY_ROLES[d]) * bodies + len(scene.coordinates)
    told = Count(
        particles=particles,
        bodies=bodies,
        dimension=d,
        coordinates=coordinates,
        constraints=0,
        independent=None,
        naive_dof=coordinates,
        formula=f"f = n - k = {coordinates} - k",
        errs="the equations were not counted",
    )
    names = names_by_position("c", [c.name for c in scene.constraints])
    given = [
        Constraint(name, c.kind(), c.facts, c.in_words, ()) for name, c in zip(names, scene.constraints, strict=True)
    ]
    named = zip(names_by_position("f", [f.name for f in scene.forces]), scene.forces, strict=True)
    forces = [ForceEntry(name=name, reason=f.reason) for name, f in named]
    return open_report(scene.name, told, [open_entry(c, why) for c in given], forces, [why_nothing(why)])
