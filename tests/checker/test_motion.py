"""The equations of motion of the lectures are verified, and refused where one is changed."""

from __future__ import annotations

import json
from copy import deepcopy
from importlib.resources import files

import pytest

import dofkit
from dofkit.checker import verify
from dofkit.checker.problem import sha256_of
from dofkit.methods.certificates.motion_evidence import certificate_of_motion

#: An elimination, a factor that the equation was divided by, and multipliers; the others are as these.
FEW = ("bead-on-parabola", "damped-motion-exponential")
REST = ("atwood-machine", "disc-string-springs-mass", "double-pendulum-lagrangian", "spherical-pendulum-cartesian")


@pytest.mark.parametrize("name", [*FEW, *(pytest.param(name, marks=pytest.mark.sweep) for name in REST)])
def test_the_lectures_motions_are_verified(name: str) -> None:
    scene = dofkit.load(name)
    report = dofkit.lagrange(scene)
    found = certificate_of_motion(scene, report.model_dump(mode="json"), report.classification)
    shown = dofkit.verify(scene, found)
    assert (shown.verified, shown.failed, shown.uncovered) == (1, [], [])
    wrong = deepcopy(found)
    wrong["claims"][0]["value"]["equations"][0] = wrong["claims"][0]["value"]["equations"][0].replace(
        " = 0", " + 1 = 0"
    )
    assert dofkit.verify(scene, wrong).verified == 0


def test_the_example_of_the_page() -> None:
    """A mass slides along y = x: L = m xdot^2 - m g x."""
    document = {
        "parameters": {"m": "positive", "g": "positive"},
        "coordinates": ["x", "y"],
        "constraints": ["y = x"],
        "energies": {"kinetic": "m (xdot^2 + ydot^2)/2", "potential": "m g y"},
    }
    (line,) = (one for one in files("dofkit.checker").joinpath("FORMAT.md").open("r") if '"rule": "lagrange"' in one)
    certificate = {
        "certificate": 1,
        "scene": {"name": "slide", "sha256": sha256_of(document)},
        "points": [{"id": "P", "values": {"x": "1/2", "y": "1/2"}}],
        "minors": [{"id": "M", "at": "P", "rows": ["c1"], "columns": ["y"]}],
        "claims": [json.loads(line)],
    }
    assert verify(document, certificate).verified == 1
    certificate["points"] = [{"id": "P", "values": {"x": "1/2", "y": "1"}}]
    assert verify(document, certificate).verified == 0
