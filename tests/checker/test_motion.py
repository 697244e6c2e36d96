"""The equations of motion of the lectures are verified, and refused where one is changed."""

from __future__ import annotations

from copy import deepcopy

import pytest

import dofkit
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
