"""Blocks that joints without loops hold together are answered as they would be whole."""

from __future__ import annotations

from typing import Any

import pytest
from shared.trees import tree_with_loops

import dofkit
from dofkit.classification.passes import GENERIC, examined
from dofkit.expressions.unwritten import Unwritten
from dofkit.relations.reductions import ALL
from dofkit.scene.lowering import lower

PINS = {("h", "p"): (0, 0), ("p", "q"): (1, 2), ("q", "r"): (5, 3), ("r", "h"): (4, 0)}
FOUR_BAR = [
    {"type": "revolute", "between": list(pair), "at": [x, y, 1], "axis": [0, 0, 1]} for pair, (x, y) in PINS.items()
]
ROOT = {"name": "root", "type": "spherical", "between": ["ground", "h"], "at": [7, 1, 2]}
TOOL = {"name": "tool", "type": "cylindrical", "between": ["q", "w"], "at": [2, 2, 2], "axis": [1, 2, 2]}
BODIES = ["h", "p", "q", "r", "w"]
FLAT = [
    {"type": "revolute", "between": pin["between"], "at": pin["at"][:2], "name": f"p{k}"}
    for k, pin in enumerate([*FOUR_BAR, ROOT, TOOL])
]
#: Scenes with their freedom, by hand: a four-bar on a ball joint with a sleeve on its coupler has 3 + 1 + 2.
CASES: dict[str, tuple[dict[str, Any], int]] = {
    "a four-bar on a joint": ({"bodies": BODIES, "constraints": [ROOT, *FOUR_BAR, TOOL]}, 6),
    "the same afloat": ({"bodies": BODIES, "constraints": [*FOUR_BAR, TOOL]}, 9),
    "the same with a text": ({"bodies": BODIES, "constraints": [ROOT, *FOUR_BAR, TOOL, "x_h = 0"]}, 5),
    "with a text on the tool": ({"bodies": BODIES, "constraints": [ROOT, *FOUR_BAR, TOOL, "x_w = 0"]}, 5),
    "in the plane": ({"dimension": 2, "bodies": BODIES, "constraints": FLAT}, 3),
    "in the plane with a text": ({"dimension": 2, "bodies": BODIES, "constraints": [*FLAT[:4], FLAT[5], "x_q = 0"]}, 4),
    "a tree": tree_with_loops(4, 0, 3),
    "a tree with a loop": tree_with_loops(3, 1, 5),
}


#: Those that are answered soon.
SOON = ("in the plane", "in the plane with a text", "a tree")


@pytest.mark.parametrize("name", [pytest.param(c, marks=() if c in SOON else pytest.mark.sweep) for c in CASES])
def test_by_parts_as_whole(name: str) -> None:
    scene, dof = CASES[name]
    system = lower(dofkit.load(scene))
    apart = examined(system, passes=GENERIC).report
    whole = examined(system, reductions=ALL - {"bridges"}, passes=GENERIC).report
    assert apart.dof == dof
    told = "consistent dof velocity_dof instantaneous_dof singular redundant redundancies redundant_equations"
    for field in (*told.split(), "generalized_coordinates", "joint_coordinates", "warnings", "verdict", "witness"):
        assert getattr(apart, field) == getattr(whole, field), field
    for one, other in zip(apart.constraints, whole.constraints, strict=True):
        same = {"verdicts"}
        assert one.model_dump(exclude=same) == other.model_dump(exclude=same)


def test_equations_of_a_large_tree_are_not_written() -> None:
    hinges = [
        {"type": "revolute", "between": [f"b{i - 1}" if i else "ground", f"b{i}"], "at": [i, 1, 0], "axis": [0, 3, 4]}
        for i in range(30)
    ]
    system = lower(dofkit.load({"bodies": [f"b{i}" for i in range(30)], "constraints": hinges}))
    assert examined(system).report.dof == 30
    assert all(isinstance(c.relations, Unwritten) and "written" not in vars(c.relations) for c in system.constraints)
