"""Blocks that joints without loops hold together are answered as they would be whole."""

from __future__ import annotations

from typing import Any

import pytest
from shared.reductions import study_of
from shared.trees import tree_with_loops

import dofkit
from dofkit.classification.passes import GENERIC, examined
from dofkit.expressions.renaming import Unwritten
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
    whole = study_of(scene, ("bridges",), GENERIC).report
    assert apart.dof == dof
    assert dofkit.derived_flag(scene) == [apart.count.coordinates - dof]
    told = "consistent dof velocity_dof instantaneous_dof singular redundant redundancies redundant_equations"
    for field in (*told.split(), "generalized_coordinates", "joint_coordinates", "warnings", "verdict", "witness"):
        assert getattr(apart, field) == getattr(whole, field), field
    for one, other in zip(apart.constraints, whole.constraints, strict=True):
        same = {"verdicts"}
        assert one.model_dump(exclude=same) == other.model_dump(exclude=same)


#: An arm of the plane beside what is not drawn: an equation of coordinates that have no values.
SLIDER = {"type": "prismatic", "between": ["h", "q"], "axis": [1, 1]}
ARM = [{"type": "revolute", "between": ["ground", "p"], "at": [1, 0]},
       {"type": "revolute", "between": ["p", "h"], "at": [2, 5]}, SLIDER]  # fmt: skip
UNDRAWN = {"dimension": 2, "bodies": ["p", "h", "q"], "coordinates": ["s", "u"], "constraints": [*ARM, "u = 2 s"]}
TREE, TREE_DOF = tree_with_loops(3, 0, 8)
#: With their freedom by hand: two hinges, a slider and s; the tree's and s; a four-bar with a tool, afloat, and s.
BESIDE: dict[str, tuple[dict[str, Any], int]] = {
    "in the plane": (UNDRAWN, 4),
    "in space": ({**TREE, "coordinates": ["s", "u"], "constraints": [*TREE["constraints"], "u = 2 s"]}, TREE_DOF + 1),
    "with a loop": (
        {**UNDRAWN, "bodies": BODIES, "constraints": [*FLAT[:4], FLAT[5], "u = 2 s"]},
        6,
    ),
}


@pytest.mark.parametrize("name", BESIDE)
def test_a_tree_beside_what_is_not_drawn(name: str) -> None:
    scene, dof = BESIDE[name]
    system = lower(dofkit.load(scene))
    apart = examined(system, passes=GENERIC).report
    whole = study_of(scene, ("bridges",), GENERIC).report
    assert (apart.dof, apart.velocity_dof, apart.instantaneous_dof) == (dof, dof, None)
    assert (apart.verdicts["dof"].verdict, apart.verdicts["dof"].about) == ("proved", "everywhere")
    for field in ("consistent", "dof", "velocity_dof", "redundant", "redundant_equations", "singular", "warnings"):
        assert getattr(apart, field) == getattr(whole, field), field
    assert len(apart.generalized_coordinates or ()) == dof


def test_of_a_tree_in_the_plane_beside_what_is_not_drawn_angles_are_chosen() -> None:
    told = examined(lower(dofkit.load(UNDRAWN))).report
    assert told.generalized_coordinates == ["theta_p", "theta_h", "x_q", "s"]
    assert told.verdicts["generalized_coordinates"].verdict == "proved"
    assert told.witness is not None
    assert {told.witness[f"{q}_{b}"] for q in ("x", "y", "theta") for b in ("p", "h", "q")} == {"0"}


@pytest.mark.parametrize("axis", [[0, 1], [1, 0], [1, 1]])
def test_sliders_of_which_one_coordinate_stands_still_against_the_other(axis: list[int]) -> None:
    """b slides on a, which slides along x: along y it is x_b = x_a + 1, along x it is y_b = 2."""
    sliders = [
        {"type": "prismatic", "between": ["ground", "a"], "axis": [1, 0]},
        {"type": "prismatic", "between": ["a", "b"], "axis": axis},
    ]
    scene = {"dimension": 2, "bodies": ["a", "b"], "coordinates": ["s", "u"], "configuration": {"x_b": 1, "y_b": 2}}
    told = examined(lower(dofkit.load({**scene, "constraints": [*sliders, "u = 2 s"]}))).report
    chosen = frozenset(told.generalized_coordinates or ())
    pairs = {(0, 1): [{"x_a", "y_b"}, {"x_b", "y_b"}], (1, 0): [{"x_a", "x_b"}]}
    wanted = pairs.get(tuple(axis), [{"x_a", "x_b"}, {"x_a", "y_b"}, {"x_b", "y_b"}])
    assert any(chosen == {*pair, "s"} for pair in wanted)


def test_a_level_body_whose_angles_texts_name_is_answered_whole() -> None:
    """theta = 0 on a hinge about z turns phi and psi alike: the numbers stay open, with or without the joint."""
    level = {
        "bodies": ["a"],
        "coordinates": ["s", "u"],
        "constraints": [
            {"type": "revolute", "between": ["ground", "a"], "at": [1, 0, 0], "axis": [0, 0, 1]},
            "theta_a = 0",
            "u = 2 s",
        ],
    }
    assert examined(lower(dofkit.load(level))).report.dof is None


def test_equations_of_a_large_tree_are_not_written() -> None:
    hinges = [
        {"type": "revolute", "between": [f"b{i - 1}" if i else "ground", f"b{i}"], "at": [i, 1, 0], "axis": [0, 3, 4]}
        for i in range(30)
    ]
    system = lower(dofkit.load({"bodies": [f"b{i}" for i in range(30)], "constraints": hinges}))
    assert examined(system).report.dof == 30
    assert all(isinstance(c.relations, Unwritten) and "written" not in vars(c.relations) for c in system.constraints)
