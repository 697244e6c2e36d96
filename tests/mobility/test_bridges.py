"""Joints that close no loop, told by hand; and that nothing else is taken for one."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.mobility.joint_tree import bridges
from dofkit.scene.lowering import lower

Z = [0, 0, 1]


def hinge(name: str, first: str, second: str, at: list[Any], **more: Any) -> dict[str, Any]:
    return {"name": name, "type": "revolute", "between": [first, second], "at": at, "axis": Z, **more}


SHOULDER = hinge("shoulder", "ground", "a", [0, 1, 0])
ELBOW = hinge("elbow", "a", "b", [1, 0, 0])
WRIST = hinge("wrist", "b", "c", [2, 0, 0])
ARM = [SHOULDER, ELBOW, WRIST]
FLAT = [{k: v for k, v in joint.items() if k != "axis"} | {"at": joint["at"][:2]} for joint in ARM]
#: Constraints beside an arm of three hinges, and the joints that close no loop then.
CASES: dict[str, tuple[list[Any], set[str]]] = {
    "nothing": ([], {"shoulder", "elbow", "wrist"}),
    "a text on the second body": (["x_b = 0"], {"wrist"}),
    "a text on the last body": (["x_c = 0"], set()),
    "a form on the first body": (["dx_a = z_a dy_a"], {"elbow", "wrist"}),
    "an inequality on the second body": (["x_b >= -9"], {"wrist"}),
    "a second hinge between two bodies": ([hinge("again", "a", "b", [1, 0, 5])], {"shoulder", "wrist"}),
    "a hinge back to the ground": ([hinge("back", "c", "ground", [3, 0, 0])], set()),
    "a coupling of two joints": (
        [{"type": "coupling", "joints": ["shoulder", "elbow"], "text": "elbow = 2 shoulder"}],
        {"wrist"},
    ),
    "a coupling far from the ground": (
        [{"type": "coupling", "joints": ["elbow", "wrist"], "text": "elbow = 2 wrist"}],
        {"shoulder"},
    ),
    "a link to the world": ([{"type": "link", "between": [{"on": "b", "at": [1, 1, 1]}, [5, 5, 5]]}], {"wrist"}),
    "a link between bodies": (
        [{"type": "link", "between": [{"on": "a", "at": [1, 1, 1]}, {"on": "c", "at": [5, 5, 5]}]}],
        {"shoulder"},
    ),
    "a body held": ([{"type": "fixed", "body": "a"}], {"elbow", "wrist"}),
}


def names(constraints: list[Any], **more: Any) -> set[str]:
    system = lower(dofkit.load({"bodies": ["a", "b", "c"], "constraints": constraints, **more}))
    return {system.constraints[i].name for i in bridges(system).joints}


@pytest.mark.parametrize("case", CASES)
def test_what_is_all_that_holds_bodies_to_the_rest(case: str) -> None:
    beside, wanted = CASES[case]
    assert names([*ARM, *beside]) == wanted


def test_what_nothing_but_such_joints_ties_to_the_ground_is_afloat() -> None:
    """A second hinge and a text on one body: the text knows places, whatever else is said of the body."""
    again = hinge("again", "b", "c", [2, 0, 5])
    system = lower(dofkit.load({"bodies": ["a", "b", "c"], "constraints": [*ARM, again]}))
    assert bridges(system).afloat == {2, 3}
    system = lower(dofkit.load({"bodies": ["a", "b", "c"], "constraints": [ELBOW, WRIST, again, "x_b = 0"]}))
    assert bridges(system).joints == {0}
    assert bridges(system).afloat == set()


def test_in_the_plane_too_and_a_gear_knows_the_ground() -> None:
    assert names(FLAT, dimension=2) == {"shoulder", "elbow", "wrist"}
    gear = {"type": "gear", "between": ["a", "b"], "ratio": 2}
    assert names([*FLAT, gear], dimension=2) == {"wrist"}


def test_what_is_driven_or_drawn_in_roots_or_parameters_is_none() -> None:
    assert names([SHOULDER, ELBOW | {"drive": "t"}, WRIST]) == {"shoulder", "wrist"}
    assert names([SHOULDER, ELBOW | {"at": ["sqrt(2)", 0, 0]}, WRIST]) == {"shoulder", "wrist"}
    assert names([SHOULDER, ELBOW | {"at": ["L", 0, 0]}, WRIST], parameters={"L": "positive"}) == {"shoulder", "wrist"}


def test_without_a_drawing_there_are_none() -> None:
    bare = [{"type": "revolute", "between": [a, b]} for a, b in (("ground", "a"), ("a", "b"), ("b", "c"))]
    assert names(bare) == set()
