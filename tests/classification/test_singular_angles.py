"""Bodies whose Euler angles are named in texts, drawn where theta is 0: there phi and psi turn about one axis."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit

WELD = {"type": "weld", "between": ["ground", "B"]}
HINGE = {"type": "revolute", "between": ["ground", "B"], "at": [0, 0, 0], "axis": [0, 1, 0]}
BALL = {"type": "spherical", "between": ["ground", "B"], "at": [0, 0, 0]}


def report(*constraints: Any, **more: Any) -> Any:
    return dofkit.classify({"bodies": ["B"], "constraints": list(constraints), **more})


@pytest.mark.parametrize("text", ["theta_B >= -1", "theta_B = 0", "cos(theta_B) <= 2"])
def test_a_welded_body_has_no_freedom_that_its_angles_have(text: str) -> None:
    """Angles (u, 0, -u) are one pose: their line is no motion."""
    found = report(WELD, text)
    for field in ("dof", "velocity_dof", "instantaneous_dof"):
        assert getattr(found, field) in (None, 0)
        assert found.verdicts[field].verdict == "undecided"
    assert any("theta_B" in warning and "dof" in warning for warning in found.warnings)
    assert report(WELD).dof == 0


def test_an_angle_that_no_turn_changes_is_not_chosen() -> None:
    """Turns about y have the angles (pi/2, u, -pi/2)."""
    found = report(HINGE, "theta_B >= -1")
    assert (found.dof, found.instantaneous_dof) == (1, 1)
    assert found.generalized_coordinates in (None, ["theta_B"])


def test_where_all_equations_are_independent_numbers_are_those_of_poses() -> None:
    found = report(BALL, "theta_B >= -1")
    assert (found.dof, found.velocity_dof, found.instantaneous_dof) == (3, 3, 3)
    assert found.verdicts["dof"].verdict == "proved"
    assert found.generalized_coordinates == ["phi_B", "theta_B", "psi_B"]


def test_elsewhere_angles_are_as_good_as_any_coordinates() -> None:
    standing = {**dict.fromkeys(("x_B", "y_B", "z_B", "phi_B", "psi_B"), 0), "theta_B": 1}
    found = report(WELD, "theta_B >= -1", configuration=standing)
    assert (found.dof, found.instantaneous_dof) == (0, 0)
    assert found.verdicts["dof"].verdict == "proved"
