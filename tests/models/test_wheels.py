"""Every model inside the wheels of mujoco, dm_control, gymnasium-robotics and example-robot-data, against MuJoCo.

What MuJoCo's own compiler does not take is no model: a part of one, or one whose parts are missing.
"""

from __future__ import annotations

import sys
import time
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import pytest

import dofkit
from dofkit.base.errors import SceneError
from dofkit.models.mjcf import compiled
from dofkit.models.model_document import ModelFile

pytestmark = pytest.mark.sweep

WHEELS = ("mujoco", "dm_control", "gymnasium_robotics")
#: Seconds of the processor for one model, reading apart, and the share that may be open.
SLOWEST, OPEN = 5.0, 0.02
#: Of joints in URDF: what each leaves free.
FREE = {"revolute": 1, "continuous": 1, "prismatic": 1, "fixed": 0, "floating": 6, "planar": 3}
#: What is no robot in the wheel: an SRDF file, and one that mimics joints it has not.
NO_ROBOTS = {"ur3.urdf", "alex_psyonic_hands.urdf"}


class Compared(NamedTuple):
    """What is right of a model, what was answered, and the seconds that took."""

    name: str
    right: int
    report: dofkit.Report
    seconds: float

    @property
    def wrong(self) -> str:
        """Why it is wrong; empty where it is not."""
        told = self.report.instantaneous_dof
        if told is not None and told != self.right:
            return f"{self.name}: {told} for {self.right}"
        if self.report.singular is False and self.report.dof != self.right:
            return f"{self.name}: dof {self.report.dof} for {self.right}"
        return ""


def compared(name: str, path: Path, right: int) -> Compared:
    scene = dofkit.load(path)
    start = time.process_time()
    report = dofkit.classify(scene)
    return Compared(name, right, report, time.process_time() - start)


def folder(wheel: str) -> Path:
    found = find_spec(wheel)
    if found is None or found.origin is None:
        pytest.skip(f"{wheel} is not installed: pip install 'dofkit[sweep]'")
    return Path(found.origin).parent


def models(wheel: str) -> Iterator[tuple[str, Path, int]]:
    """The models of a wheel that MuJoCo compiles, with its own count of each."""
    for path in sorted(folder(wheel).rglob("*.xml")):
        try:
            told = compiled(ModelFile(path.read_bytes(), path.stem, path)).content
        except SceneError:
            continue
        if told["nv"]:
            yield f"{wheel}/{path.name}", path, told["left"]


@pytest.mark.parametrize("wheel", WHEELS)
def test_models_of_mujoco(wheel: str) -> None:
    told = [compared(*found) for found in models(wheel)]
    assert len(told) >= {"mujoco": 1, "dm_control": 30, "gymnasium_robotics": 20}[wheel]
    assert not [one.wrong for one in told if one.wrong]
    assert sum(one.report.instantaneous_dof is None for one in told) <= OPEN * len(told)
    assert [one.name for one in told if one.seconds > SLOWEST] == []


def robots() -> Iterator[tuple[str, Path, int]]:
    """The robots of example-robot-data, with the freedom of their trees: joints less those that mimic others."""
    shared = "cmeel.prefix/share/example-robot-data/robots"
    root = next((place for path in sys.path if (place := Path(path) / shared).is_dir()), Path(shared))
    if not root.is_dir():
        pytest.skip("example-robot-data is not installed")
    for path in sorted(root.rglob("*.urdf")):
        if path.name in NO_ROBOTS:
            continue
        joints = ET.parse(path).getroot().findall("joint")
        free = [(FREE[j.get("type", "")], j.find("mimic") is not None and j.get("type") != "fixed") for j in joints]
        yield path.name, path, sum(own - follows for own, follows in free)


def test_robots_of_example_robot_data() -> None:
    told = [compared(*found) for found in robots()]
    assert len(told) >= 60
    assert not [one.wrong for one in told if one.wrong]
    assert sum(one.report.instantaneous_dof is None for one in told) <= OPEN * len(told)
    assert [one.name for one in told if one.seconds > SLOWEST] == []
