"""Joint coordinates of trees, counted by hand."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit

Z = [0, 0, 1]
SHOULDER = {"name": "shoulder", "type": "revolute", "between": ["ground", "a"], "at": [0, 0, 0], "axis": Z}
ELBOW = {"name": "elbow", "type": "revolute", "between": ["a", "b"], "at": [1, 0, 0], "axis": Z}
SLEEVE = {"name": "sleeve", "type": "cylindrical", "between": ["a", "b"], "at": [1, 0, 0], "axis": Z}
BALL = {"name": "ball", "type": "spherical", "between": ["a", "b"], "at": [1, 0, 0]}
CASES: dict[str, tuple[list[dict[str, Any]], list[str] | None]] = {
    "two hinges": ([SHOULDER, ELBOW], ["shoulder.angle", "elbow.angle"]),
    "a sleeve": ([SHOULDER, SLEEVE], ["shoulder.angle", "sleeve.angle", "sleeve.displacement"]),
    "a ball": ([SHOULDER, BALL], ["shoulder.angle", "ball.rotation_1", "ball.rotation_2", "ball.rotation_3"]),
    "a weld": ([SHOULDER, {"name": "w", "type": "weld", "between": ["a", "b"]}], ["shoulder.angle"]),
    "one that follows": (
        [SHOULDER, ELBOW, {"type": "coupling", "joints": ["elbow", "shoulder"], "text": "elbow = 2 shoulder"}],
        ["shoulder.angle"],
    ),
    "what floats": ([ELBOW], ["elbow.angle", "x_a", "y_a", "z_a", "phi_a", "theta_a", "psi_a"]),
    "a bound": (
        [SHOULDER, ELBOW, {"type": "coupling", "joints": ["elbow"], "text": "elbow <= 1"}],
        ["shoulder.angle", "elbow.angle"],
    ),
    "a loop": ([SHOULDER, ELBOW, {**ELBOW, "name": "again", "between": ["ground", "b"]}], None),
    "a text": ([SHOULDER, ELBOW, {"type": "equation", "text": "x_b = x_a"}], None),
    "a drive": ([SHOULDER, {**ELBOW, "drive": "t"}], None),
}


@pytest.mark.parametrize("name", CASES)
def test_joint_coordinates(name: str) -> None:
    constraints, wanted = CASES[name]
    report = dofkit.classify({"bodies": ["a", "b"], "constraints": constraints})
    assert report.joint_coordinates == wanted
    assert wanted is None or len(wanted) == report.dof


def test_two_couplings_of_three_joints_leave_one() -> None:
    """p = q and q = r tell p and q by r."""
    joints = [
        {"name": n, "type": "prismatic", "between": ["ground", b], "axis": [1, 0]}
        for n, b in zip("pqr", "abc", strict=True)
    ]
    couplings = [{"type": "coupling", "joints": [*two], "text": f"{two[0]} = {two[1]}"} for two in ("pq", "qr")]
    report = dofkit.classify({"dimension": 2, "bodies": ["a", "b", "c"], "constraints": [*joints, *couplings]})
    assert (report.dof, report.joint_coordinates) == (1, ["r.displacement"])
