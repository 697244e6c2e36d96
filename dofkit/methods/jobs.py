"""What workers are asked to do: functions of one payload, which say what json can write."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

from dofkit.base.errors import SceneError
from dofkit.base.workers import Json
from dofkit.classification.passes import stages
from dofkit.methods.table import MethodName
from dofkit.scene.scene import Scene
from dofkit.system import System


def classified(payload: tuple[Scene | System, float, MethodName]) -> Iterator[Json]:
    """Of a scene, a budget in seconds and a method: its report, after a sketch of it; or its faults."""
    scene, budget, method = payload
    try:
        for report in stages(scene, budget, method):
            yield {"report": report.model_dump(mode="json")}
    except SceneError as error:
        yield {"faults": [asdict(fault) for fault in error.faults], "source": error.source}
