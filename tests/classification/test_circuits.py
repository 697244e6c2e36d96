"""What a redundant constraint follows from: no more constraints than it takes."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit


def hinge(name: str, one: str, other: str, at: list[int]) -> dict[str, Any]:
    return {"name": name, "type": "revolute", "between": [one, other], "at": at, "axis": [0, 0, 1]}


def slider(name: str, one: str, other: str) -> dict[str, Any]:
    return {"name": name, "type": "prismatic", "between": [one, other], "axis": [1, 0, 0]}


def test_a_joint_that_is_partly_redundant_itself_is_a_circuit_alone() -> None:
    """Four equations of the slider j1 follow from the hinge j0; j3 is j1 seen from the other body: it needs no more."""
    joints = [hinge("j0", "a", "b", [0, -1, 0]), slider("j1", "b", "a"), slider("j3", "a", "b")]
    report = dofkit.classify({"bodies": ["a", "b"], "constraints": joints})
    assert [e.independent for e in report.constraints] == [5, 1, 0]
    assert report.redundant == ["j3"]
    assert report.constraints[2].circuit == ["j1"]


def test_a_ball_between_two_bodies_that_turn_alike_and_stand_still_does_not_need_what_else_holds_them() -> None:
    """The rod slides along y and its hinge to the rocker about z stands off that of the rocker: both stand still.

    So a ball between them follows from the slider and the two hinges, whatever else hangs on the rocker.
    """
    scene = {
        "bodies": ["hung", "rocker", "rod"],
        "constraints": [
            {"type": "spherical", "name": "j0", "between": ["hung", "ground"], "at": [1, 2, 0]},
            {"type": "spherical", "name": "j1", "between": ["rocker", "hung"], "at": [2, 2, 0]},
            {"name": "j2", "type": "prismatic", "between": ["ground", "rod"], "axis": [0, 1, 0]},
            hinge("j3", "rocker", "rod", [-1, 0, 0]),
            hinge("j4", "ground", "rocker", [1, -1, 0]),
            {"type": "spherical", "name": "j5", "between": ["rocker", "rod"], "at": [0, -1, 0]},
        ],
    }
    assert dofkit.classify(scene).constraints[-1].circuit == ["j2", "j3", "j4"]


def test_a_coupling_of_a_joint_with_itself_says_nothing() -> None:
    """The angle of a against the ground is minus that of the ground against a, so that p = -q always."""
    joints = [hinge("j0", "ground", "a", [0, 0, 0]), hinge("j1", "a", "ground", [0, 0, 0])]
    coupling = {"name": "c", "type": "coupling", "joints": {"p": "j0", "q": "j1"}, "text": "p = -q"}
    report = dofkit.classify({"bodies": ["a"], "constraints": [*joints, coupling]})
    assert (report.dof, report.redundant) == (1, ["j1", "c"])
    assert [e.independent for e in report.constraints] == [5, 0, 0]
    assert report.constraints[2].circuit == []


def test_of_many_hinges_on_one_line_all_but_the_first_can_go() -> None:
    door = [{**hinge(f"h{k}", "ground", "door", [0, 0, 0]), "at": [0, 0, k]} for k in range(16)]
    assert dofkit.classify({"bodies": ["door"], "constraints": door}).redundant == [f"h{k}" for k in range(1, 16)]


def test_creases_through_one_vertex_are_three_too_many_where_they_are_flat() -> None:
    """All axes meet, so that three of the four creases keep the vertex in its place and the fourth does so again."""
    axes = [[1, 0, 0], [3, 4, 0], [-1, 0, 0], [3, -4, 0]]
    panels = ["ground", "p1", "p2", "p3", "ground"]
    creases = [
        {"type": "revolute", "between": panels[k : k + 2], "at": axis, "axis": axis} for k, axis in enumerate(axes)
    ]
    report = dofkit.classify({"bodies": panels[1:4], "constraints": creases})
    assert [group.nullity for group in report.redundancies] == [3]


@pytest.mark.parametrize(
    ("texts", "circuit"),
    [
        (["x^2 + y^2 = 1", "x dx + y dy = 0"], ["c1"]),  # half of the differential
        (["dz = y dx", "dw = z dx", "dz + y dw = (y + y z) dx"], ["c1", "c2"]),  # c1 + y c2
        (["x^2 + y^2 + z^2 = 1", "w = x y", "dw = y dx + x dy"], ["c2"]),
    ],
)
def test_a_form_that_is_a_combination_of_others_by_an_identity_is_proved_redundant(texts: Any, circuit: Any) -> None:
    names = [name for name in "xyzw" if any(name in text for text in texts)]
    report = dofkit.classify({"coordinates": names, "constraints": texts})
    assert (report.redundant, report.constraints[-1].circuit) == ([f"c{len(texts)}"], circuit)
    assert report.velocity_dof == len(names) - len(texts) + 1
    assert {report.verdicts[key].verdict for key in ("velocity_dof", "redundant", "redundancies")} == {"proved"}
    assert report.constraints[-1].verdicts["circuit"].verdict == "proved"


def test_what_only_touches_a_dependent_set_is_in_no_group() -> None:
    at = {"x": 0, "y": 0, "z": 1, "w": 2}
    texts = ["z = 1", "x^2 + y^2 + z^2 = 1", "x = 0", "w = x + 2"]
    report = dofkit.classify({"coordinates": [*at], "constraints": texts, "configuration": at})
    assert [group.members for group in report.redundancies] == [["c1", "c2", "c3"]]
