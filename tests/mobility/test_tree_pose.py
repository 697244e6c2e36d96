"""Coordinates of open trees of more than 120 coordinates, whose Euler angles are singular as drawn; by hand."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from shared.trees import tree_with_loops

import dofkit
from dofkit.mobility.tree_pose import free_coordinates
from dofkit.scene.lowering import lower


def chosen(*joints: dict[str, Any]) -> list[str] | None:
    """Of bodies a, b and so on, each carried by the one before, the first by the ground."""
    names = ["ground", *"abcdef"[: len(joints)]]
    carried = [{"between": list(pair), **joint} for pair, joint in zip(pairwise(names), joints, strict=True)]
    return free_coordinates(lower(dofkit.load({"bodies": names[1:], "constraints": carried})), frozenset())


HINGE = {"type": "revolute", "at": [0, 0, 0], "axis": [0, 0, 1]}


@pytest.mark.parametrize(
    ("joint", "own"),
    [
        # A hinge off the origin moves the origin of the body, at a generic angle along x too.
        ({"type": "revolute", "at": [1, 0, 0], "axis": [0, 0, 1]}, ["x"]),
        # Through the origin it turns it in place: upright by psi, tilted about x by theta.
        (HINGE, ["psi"]),
        ({"type": "revolute", "at": [0, 0, 0], "axis": [1, 0, 0]}, ["theta"]),
        ({"type": "prismatic", "axis": [0, 0, 1]}, ["z"]),
        ({"type": "cylindrical", "at": [0, 0, 0], "axis": [0, 0, 1]}, ["z", "psi"]),
        ({"type": "screw", "at": [0, 0, 0], "axis": [0, 0, 1], "pitch": 2}, ["z"]),
        ({"type": "spherical", "at": [0, 0, 0]}, ["phi", "theta", "psi"]),
        # The origin goes around the joint and takes the body's z axis along: what is left is the turn about it.
        ({"type": "spherical", "at": [0, 0, 3]}, ["x", "y", "psi"]),
        ({"type": "planar", "at": [0, 0, 0], "axis": [0, 0, 1]}, ["x", "y", "psi"]),
        # About z and then about its own x axis: the z axis goes anywhere, and psi stays 0.
        ({"type": "universal", "at": [0, 0, 0], "axes": [[0, 0, 1], [1, 0, 0]]}, ["phi", "theta"]),
        ({"type": "weld"}, []),
    ],
)
def test_one_joint(joint: dict[str, Any], own: list[str]) -> None:
    assert chosen(joint) == [f"{name}_a" for name in own]


@pytest.mark.parametrize(
    ("joint", "own"),
    [
        # On a body that turns about z: a slider along its x axis goes along x; two hinges about z leave upright.
        ({"type": "prismatic", "axis": [1, 0, 0]}, ["psi_a", "x_b"]),
        (HINGE, ["psi_a", "psi_b"]),
        # A hinge about its x axis: phi is known, theta is free, psi is 0.
        ({"type": "revolute", "at": [0, 0, 0], "axis": [1, 0, 0]}, ["psi_a", "theta_b"]),
    ],
)
def test_a_body_on_one_that_turns(joint: dict[str, Any], own: list[str]) -> None:
    assert chosen(HINGE, joint) == own


def test_a_long_chain() -> None:
    """Hinges about x and y in turns, a unit apart along z: each moves the origin of the body after it."""
    names = ["ground", *(f"b{k}" for k in range(30))]
    joints = [
        {"type": "revolute", "between": list(pair), "at": [0, 0, k], "axis": [1 - k % 2, k % 2, 0]}
        for k, pair in enumerate(pairwise(names))
    ]
    report = dofkit.classify(dofkit.load({"bodies": names[1:], "constraints": joints}))
    assert (report.dof, report.verdict) == (30, "probable")
    assert [name.split("_")[1] for name in report.generalized_coordinates or []] == names[1:]


@pytest.mark.parametrize("seed", range(3))
def test_as_many_as_the_freedom(seed: int) -> None:
    scene, dof = tree_with_loops(40, 0, seed)
    report = dofkit.classify(dofkit.load(scene))
    assert (report.dof, len(set(report.generalized_coordinates or []))) == (dof, dof)


def test_what_is_no_open_tree_is_left_to_others() -> None:
    scene, _ = tree_with_loops(4, 1, 0)
    assert free_coordinates(lower(dofkit.load(scene)), frozenset()) is None
    flat = {"dimension": 2, "bodies": ["a"], "constraints": [{"type": "weld", "between": ["ground", "a"]}]}
    assert free_coordinates(lower(dofkit.load(flat)), frozenset()) is None
