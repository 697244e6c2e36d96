"""Ordinary things, a line of hand work each: what stands beside a mechanism, and what an equation says at once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import pytest

import dofkit

Document = Mapping[str, Any]

FOUR_BAR = [
    {"name": "A", "type": "revolute", "between": ["ground", "crank"], "at": [0, 0]},
    {"name": "B", "type": "revolute", "between": ["crank", "rod"], "at": [1, 2]},
    {"name": "C", "type": "revolute", "between": ["rod", "rocker"], "at": [5, 3]},
    {"name": "D", "type": "revolute", "between": ["rocker", "ground"], "at": [4, 0]},
]
LINKS = ["crank", "rod", "rocker"]


def told(document: Document) -> dict[str, Any]:
    report = dofkit.classify(dofkit.load(document))
    return {key: getattr(report, key) for key in ("consistent", "dof", "velocity_dof", "instantaneous_dof", "singular")}


def moves(dof: int, first_order: int | None, singular: bool | None = False) -> dict[str, Any]:
    expected = {"consistent": True, "dof": dof, "velocity_dof": dof, "instantaneous_dof": first_order}
    return {**expected, "singular": singular}


@pytest.mark.parametrize(
    ("beside", "dof"),
    [
        ({"bodies": [*LINKS, "free"]}, 1 + 3),
        ({"particles": ["P"], "bodies": LINKS}, 1 + 2),
        ({"coordinates": ["s", "w"], "bodies": LINKS}, 1 + 2),
        ({"bodies": [*LINKS, "free"], "particles": ["P"], "coordinates": ["s"]}, 1 + 3 + 2 + 1),
    ],
)
def test_what_nothing_constrains_stands_anywhere_in_the_drawing(beside: Document, dof: int) -> None:
    assert told({"dimension": 2, "constraints": FOUR_BAR, **beside}) == moves(dof, dof)


def test_what_is_constrained_and_not_drawn_is_named() -> None:
    table = {"type": "equation", "text": "y_P = 1"}
    scene = {"dimension": 2, "bodies": LINKS, "particles": ["P"], "constraints": [*FOUR_BAR, table]}
    report = dofkit.classify(dofkit.load(scene))
    assert (report.dof, report.instantaneous_dof) == (2, None)
    assert "There is no reference configuration: P is not drawn." in report.warnings


def test_nothing_drawn_is_no_reference() -> None:
    assert told({"coordinates": ["x", "y"], "constraints": ["x = 1"]}) == moves(1, None, None)
    assert told({"coordinates": ["x", "y"]}) == moves(2, None, None)


def arm(*more: str) -> dict[str, Any]:
    """A mobile manipulator whose gripper is welded to the world: 4 sliders, 9 hinges and 2 fingers are 15 freedoms,
    less the 6 of the weld (three slides and three directions of axes in the chain to the gripper)."""
    chain: list[tuple[str, Sequence[float]]] = [
        ("shoulder_pan", (0.1195, 0.3486)), ("shoulder_lift", (0.117, 0.06)), ("upper_arm", (0.219, 0)),
        ("elbow", (0.133, 0)), ("forearm", (0.197, 0)), ("wrist_flex", (0.1245, 0)), ("wrist_roll", (0.1385, 0)),
    ]  # fmt: skip
    axes = [[0, 0, 1], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0]]
    slides = ["ground", "base_x", "base_y", "base", "torso"]
    ways = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1]]
    joints: list[dict[str, Any]] = [
        {"type": "prismatic", "between": list(pair), "axis": axis}
        for pair, axis in zip(pairwise(slides), ways, strict=True)
    ]
    joints += [
        {"type": "revolute", "between": ["torso", "head_pan"], "at": [0.3711, 0.48, 0.9804], "axis": [0, 0, 1]},
        {"type": "revolute", "between": ["head_pan", "head_tilt"], "at": [0.5136, 0.48, 1.0384], "axis": [0, 1, 0]},
    ]
    x, z, before = 0.318, 0.3774, "torso"
    for (name, (dx, dz)), axis in zip(chain, axes, strict=True):
        x, z = round(x + dx, 6), round(z + dz, 6)
        joints.append({"type": "revolute", "between": [before, name], "at": [x, 0.48, z], "axis": axis})
        before = name
    joints += [{"type": "prismatic", "between": [before, f], "axis": [0, 1, 0]} for f in ("left", "right")]
    joints.append({"type": "weld", "between": ["ground", before]})
    bodies = [*slides[1:], "head_pan", "head_tilt", *(name for name, _ in chain), "left", "right", *more]
    return {"bodies": bodies, "constraints": joints}


def test_pick_and_place() -> None:
    assert told(arm()) == moves(9, 9)
    assert told(arm("block")) == moves(15, 15)
    lying = arm("block")
    lying["constraints"].append({"type": "equation", "text": "z_block = 1/2"})
    assert told(lying) == moves(14, None, None)
