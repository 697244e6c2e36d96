"""Euler angles of bodies: which are coordinates, and where they are none."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit


def hinged(axis: list[int], *texts: str) -> dict[str, Any]:
    """A door on the ground, with equations for its angles."""
    hinge = {"name": "hinge", "type": "revolute", "between": ["ground", "door"], "at": [0, 0, 0], "axis": axis}
    return {"dimension": 3, "bodies": ["door"], "constraints": [hinge, *texts]}


@pytest.mark.parametrize(
    ("axis", "angle"),
    [([1, 0, 0], "theta_door"), ([0, 1, 0], "theta_door"), ([1, 1, 0], "theta_door"), ([0, 0, 1], "psi_door")],
)
def test_a_door_turns_by_the_angle_about_its_hinge(axis: list[int], angle: str) -> None:
    """R = Rz(phi) Rx(theta) Rz(psi): about a level axis phi and psi are fixed, about the vertical one theta is 0."""
    report = dofkit.classify(hinged(axis))
    assert (report.generalized_coordinates, report.verdict) == ([angle], "proved")


def test_a_door_on_a_slanted_hinge_has_one_coordinate() -> None:
    """All three angles change: each one would do."""
    report = dofkit.classify(hinged([1, 1, 1]))
    assert report.generalized_coordinates is not None
    assert len(report.generalized_coordinates) == report.dof == 1


def test_bodies_that_turn_together_have_their_own_angles() -> None:
    """The differential of a car: twice the turn of the ring is the sum of the turns of the half shafts."""
    at = {"ring": 0, "left": -1, "right": 1}
    hinges = [
        {"name": f"of_{name}", "type": "revolute", "between": ["ground", name], "at": [x, 0, 0], "axis": [1, 0, 0]}
        for name, x in at.items()
    ]
    text = "2 of_ring = of_left + of_right"
    pinions = {"type": "coupling", "joints": ["of_ring", "of_left", "of_right"], "text": text}
    report = dofkit.classify({"dimension": 3, "bodies": [*at], "constraints": [*hinges, pinions]})
    assert (report.dof, report.generalized_coordinates) == (2, ["theta_ring", "theta_left"])


def test_an_angle_of_another_part_of_the_set_is_not_proved_to_be_one_near_the_reference() -> None:
    """A body on a ball joint whose point (1, 0, 0) may be there, or near (1, g, 2 g), and nowhere else.

    With u = y^2 - g y and w = z - 2 y: u + 5 w = 0 and w + 2 u = 0, so that both are 0. As drawn the body turns about
    the x axis: theta changes alone, phi and psi do not. On the other part phi changes.
    """
    surfaces = ["y^2 - y/100 + 5 (z - 2 y)", "z - 2 y + 2 (y^2 - y/100)"]
    ball = {"type": "spherical", "between": ["ground", "b"], "at": [0, 0, 0]}
    held = {"type": "on", "members": [{"on": "b", "at": [1, 0, 0]}], "curve": surfaces}
    report = dofkit.classify({"bodies": ["b"], "constraints": [ball, held]})
    assert report.dof == 1
    sure = report.verdicts["generalized_coordinates"].verdict == "proved"
    assert report.generalized_coordinates == ["theta_b"] or not sure


def test_a_body_drawn_turned_has_the_angles_of_its_drawing() -> None:
    """Drawn with theta = 90 degrees its z axis lies level; about the vertical it turns by phi."""
    scene = hinged([0, 0, 1]) | {"configuration": {"theta_door": "pi/2"}}
    report = dofkit.classify(scene)
    assert (report.generalized_coordinates, report.dof) == (["phi_door"], 1)


@pytest.mark.parametrize("axis", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
@pytest.mark.parametrize("text", ["theta_door = 0", "phi_door = 0", "psi_door = 0", "phi_door = theta_door"])
def test_angles_that_turn_alike_are_no_motion(axis: list[int], text: str) -> None:
    """At theta = 0 the angles phi and psi may change while the door stands: the door has at most 1 degree of freedom.

    With theta = 0 it stands still on a level hinge, so that no other number is right; on a vertical one it turns.
    """
    report = dofkit.classify(hinged(axis, text))
    wanted = {0: 0, 1: 1}[axis[2]] if text == "theta_door = 0" else None
    assert report.dof in ({None, 0, 1} if wanted is None else {None, wanted})
    if report.dof is None:
        assert "Euler angles" in " ".join(report.warnings)


@pytest.mark.parametrize("text", ["theta_door >= -1", "theta_door = 0", "cos(theta_door) <= 2"])
def test_a_welded_body_has_no_freedom_that_its_angles_have(text: str) -> None:
    """Angles (u, 0, -u) are one pose: their line is no motion."""
    weld = {"type": "weld", "between": ["ground", "door"]}
    assert dofkit.classify({"bodies": ["door"], "constraints": [weld]}).dof == 0
    report = dofkit.classify({"bodies": ["door"], "constraints": [weld, text]})
    assert report.dof in (None, 0)
    assert report.velocity_dof in (None, 0)
    assert "Euler angles" in " ".join(report.warnings)


def test_a_welded_body_that_is_drawn_turned_has_no_freedom() -> None:
    weld = {"type": "weld", "between": ["ground", "door"]}
    scene = {"bodies": ["door"], "configuration": {"theta_door": 1}, "constraints": [weld, "theta_door >= -1"]}
    report = dofkit.classify(scene)
    assert (report.dof, report.instantaneous_dof) == (0, 0)
    assert report.warnings == []


@pytest.mark.sweep
@pytest.mark.parametrize("type_", ["weld", "prismatic"])
def test_a_body_that_is_kept_from_turning_is_not_turned_by_a_third(type_: str) -> None:
    """About (1, 1, 1) that takes e1 to e2, e2 to e3, e3 to e1: no e_i keeps what it has along the next."""
    joint = {"type": type_, "between": ["ground", "door"]} | ({"axis": [1, 0, 0]} if type_ == "prismatic" else {})
    report = dofkit.classify({"bodies": ["door"], "constraints": [joint, "cos(theta_door) = 0"]})
    assert report.consistent in (None, False)
