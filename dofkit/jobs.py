"""What workers are asked to do: functions of one payload, which say what json can write."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

from dofkit.classify import stages
from dofkit.errors import SceneError
from dofkit.methods import MethodName
from dofkit.scene import Scene
from dofkit.system import System
from dofkit.workers import Json


def classified(payload: tuple[Scene | System, float, MethodName]) -> Iterator[Json]:
    """Of a scene, a budget in seconds and a method: its report, after a sketch of it; or its faults."""
    scene, budget, method = payload
    try:
        for report in stages(scene, budget, method):
            yield {"report": report.model_dump(mode="json")}
    except SceneError as error:
        yield {"faults": [asdict(fault) for fault in error.faults], "source": error.source}
