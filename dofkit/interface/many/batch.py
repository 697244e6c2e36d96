"""A batch of scenes in a worker: each read and answered, none of them stopping the others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from dofkit.base.memory import unhurried
from dofkit.base.workers import Json
from dofkit.base.workers.limits import allow
from dofkit.interface.many.scene_files import SceneGiven
from dofkit.interface.one_file import lines_after_reading
from dofkit.interface.supervised import Given, limits_of


@dataclass(frozen=True)
class SceneBatch:
    """Scenes, and what is asked of all of them."""

    asked: Given
    scenes: tuple[SceneGiven, ...]


def given_of(asked: Given, scene: SceneGiven) -> Given:
    """What is asked of all, of one."""
    return replace(asked, file=scene.file, data=scene.data, certificate=scene.certificate)


def batch_reports(batch: SceneBatch) -> Iterator[Json]:
    """The number of the scene that comes next, of each; at the end ``{"printed": ...}``, of all.

    Once a scene is read this process ends where its report takes longer than it may.
    """
    with unhurried():
        yield from _told(batch)


def _told(batch: SceneBatch) -> Iterator[Json]:
    printed: list[Json] = []
    for number, scene in enumerate(batch.scenes):
        yield {"next": number}
        given = given_of(batch.asked, scene)
        told: list[Json] = [None]
        for told[0] in lines_after_reading(given):
            allow(limits_of(given)[1])
        printed += told
    yield {"printed": printed}
