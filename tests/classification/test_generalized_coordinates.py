"""Chosen coordinates are independent at the drawing too, not only beside it."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from shared.known_scenes import SCENES

import dofkit

#: A jib that turns about the tower, a trolley on it, and the cable.
CRANE: list[dict[str, Any]] = [
    {"type": "revolute", "between": ["ground", "jib"], "at": [0, 0, 10], "axis": [0, 0, 1]},
    {"type": "prismatic", "between": ["jib", "trolley"], "axis": [1, 0, 0]},
    {"type": "link", "between": [{"on": "trolley", "at": [4, 0, 10]}, "hook"]},
]


def crane(hook: list[float]) -> dict[str, Any]:
    return {"particles": [{"name": "hook", "at": hook}], "bodies": ["jib", "trolley"], "constraints": CRANE}


def test_a_hook_that_hangs_straight_down_is_not_placed_by_its_height() -> None:
    """dz = 0 there to first order, whatever the crane does; its place from above, the jib and the trolley are free."""
    report = dofkit.classify(crane([4, 0, 2]))
    assert report.dof == 4
    assert report.generalized_coordinates == ["x_hook", "y_hook", "psi_jib", "x_trolley"]


def test_a_hook_that_hangs_aslant_may_be() -> None:
    report = dofkit.classify(crane([7, 0, 6]))
    assert report.dof == 4
    assert report.generalized_coordinates == ["x_hook", "y_hook", "z_hook", "psi_jib"]


@pytest.mark.parametrize(
    ("at", "free"), [([1, 0], "y_P"), ([0, 1], "x_P"), (["3/5", "4/5"], "x_P")], ids=["right", "top", "between"]
)
def test_beside_a_form_a_circle_is_reported_by_what_changes_along_it(at: list[Any], free: str) -> None:
    report = dofkit.classify(
        {
            "dimension": 2,
            "particles": [{"name": "P", "at": at}],
            "coordinates": ["q", "r"],
            "constraints": ["x_P^2 + y_P^2 = 1", "qdot = y_P rdot"],
            "configuration": {"q": 0, "r": 0},
        }
    )
    assert report.dof == 3
    assert report.generalized_coordinates == [free, "q", "r"]


@pytest.mark.parametrize("size", [1, 10**7, Fraction(1, 10**7)], ids=["1", "10^7", "10^-7"])
def test_the_unit_of_length_means_nothing(size: Fraction) -> None:
    """Lengths and angles are compared in units of their own: a crank, a rod and a slider, of any size."""
    at = [[0, 0], [3, 4], [12, 4]]
    (a, b, c) = ([str(x * size) for x in place] for place in at)
    mechanism = {
        "dimension": 2,
        "bodies": ["crank", "rod", "slider"],
        "constraints": [
            {"type": "revolute", "between": ["ground", "crank"], "at": a},
            {"type": "revolute", "between": ["crank", "rod"], "at": b},
            {"type": "revolute", "between": ["rod", "slider"], "at": c},
            {"type": "prismatic", "between": ["ground", "slider"], "axis": [1, 0]},
            {"type": "link", "between": [{"on": "slider", "at": c}, "weight"]},
        ],
        "particles": [{"name": "weight", "at": [str(x * size) for x in (12, -6)]}],
    }
    report = dofkit.classify(mechanism)
    assert report.dof == 2
    assert report.generalized_coordinates == ["x_weight", "theta_crank"]


@pytest.mark.parametrize("method", ["auto", "field"])
def test_a_reference_on_no_branch_of_a_relation_has_no_first_order(method: Any) -> None:
    for place, told in ((1, 1), (2, None)):
        scene = {
            "coordinates": ["x", "y", "z"],
            "constraints": ["x^2 = 1", "zdot = y xdot"],
            "configuration": {"x": place, "y": 0, "z": 0},
        }
        assert dofkit.classify(scene, method=method).instantaneous_dof == told


def test_of_a_rigid_framework_the_first_independent_places_are_chosen() -> None:
    """Three points in line along x: B's x is A's, to first order, and B's y turns the whole."""
    at = {"A": [0, 0], "B": [1, 0], "C": [2, 0], "D": [1, 1]}
    links = [{"type": "link", "between": list(pair)} for pair in ("AB", "BC", "AC", "AD", "BD", "CD")]
    points = [{"name": name, "at": place} for name, place in at.items()]
    report = dofkit.classify({"dimension": 2, "particles": points, "constraints": links})
    assert report.dof == 3
    assert report.generalized_coordinates == ["x_A", "y_A", "y_B"]


def test_of_a_body_on_a_ball_joint_somewhere_not_all_places_are_chosen() -> None:
    """They lie on a sphere."""
    report = dofkit.classify({"bodies": ["b"], "constraints": [{"type": "spherical", "between": ["ground", "b"]}]})
    assert report.dof == 3
    assert report.generalized_coordinates == ["x_b", "y_b", "phi_b"]


@pytest.mark.parametrize(
    ("scene", "wanted"),
    [
        # AB lies along x: at the drawing x_B - x_A is stationary in every turn of the whole
        ("desargues-perspective", ["x_A", "y_A", "y_B"]),
        ("collinear-one-one-two", ["x_A", "y_A", "y_B"]),
        # J0 - J1 along y, J0 - J2 along x: turns move x_J1 (about z), z_J1 (about x), z_J2 (about y)
        ("jessen-orthogonal-icosahedron", ["x_J0", "y_J0", "z_J0", "x_J1", "z_J1", "z_J2"]),
    ],
)
def test_at_a_singular_drawing_that_is_rigid_the_orbit_is_a_graph_over_the_choice(
    scene: str, wanted: list[str]
) -> None:
    report = dofkit.classify(next(path for path in SCENES if path.stem == scene))
    assert report.generalized_coordinates == wanted
    assert report.verdicts["generalized_coordinates"].verdict == "proved"


@pytest.mark.parametrize("scene", ["kite-folded", "rhombus-folded", "four-bar-change-point"])
def test_where_branches_cross_the_choice_is_not_told_as_proved(scene: str) -> None:
    report = dofkit.classify(next(path for path in SCENES if path.stem == scene))
    assert report.verdicts["dof"].verdict == "proved"
    assert report.verdicts["generalized_coordinates"].verdict == "probable"


@pytest.mark.parametrize(
    ("axis", "theta", "wanted"),
    [
        # a turn by u about a level axis has the angles c, u, -c, where c is that of the axis to x; about z it is psi
        ([1, 0, 0], 0, "theta_B"),
        ([0, 1, 0], 0, "theta_B"),
        ([1, 1, 0], 0, "theta_B"),
        ([0, 0, 1], 0, "psi_B"),
        # the line of nodes lies along x, and the body's axis along -y
        ([1, 0, 0], "pi/2", "theta_B"),
        ([0, 1, 0], "pi/2", "psi_B"),
        ([0, 0, 1], "pi/2", "phi_B"),
    ],
)
def test_of_a_hinge_the_angle_that_turns_is_chosen(axis: list[int], theta: object, wanted: str) -> None:
    """Euler's angles, and not a component of what stands for them in the relations."""
    hinge = {"type": "revolute", "between": ["ground", "B"], "at": [0, 0, 0], "axis": axis}
    standing = {**dict.fromkeys(("x_B", "y_B", "z_B", "phi_B", "psi_B"), 0), "theta_B": theta}
    report = dofkit.classify({"bodies": ["B"], "configuration": standing, "constraints": [hinge]})
    assert report.generalized_coordinates == [wanted]


def hinge(first: str, second: str, x: int, y: int) -> dict[str, Any]:
    return {"type": "revolute", "between": [first, second], "at": [x, y, 0], "axis": [0, 0, 1]}


#: Two cranks stretched between pivots as far apart as they are long: neither turns, though to first order both do.
STRETCHED = [hinge("ground", "a", 0, 0), hinge("a", "b", 1, 0), hinge("b", "ground", 3, 0)]
HUNG: dict[str, tuple[list[str], list[dict[str, Any]], int]] = {
    "a plate": (["h"], [{"type": "planar", "between": ["b", "h"], "at": [-1, 1, 2], "axis": [1, 0, -1]}], 3),
    "a hinge": (["h"], [hinge("b", "h", 2, 1)], 1),
    "a four-bar": (["h", "g", "f"], [
        hinge("b", "h", 2, 1), hinge("h", "g", 2, 2), hinge("g", "f", 5, 2), hinge("f", "ground", 5, 5)], 1),
    "a link": (["h"], [{"type": "link", "between": [{"on": "b", "at": [2, 1, 0]}, {"on": "h", "at": [2, 2, 0]}]}], 5),
}  # fmt: skip


@pytest.mark.parametrize("name", HUNG)
def test_what_stands_still_at_a_dead_point_is_not_chosen(name: str) -> None:
    """The cranks are two points of a double zero, found to half the digits: that little is no motion."""
    bodies, more, dof = HUNG[name]
    report = dofkit.classify({"bodies": ["a", "b", *bodies], "constraints": [*STRETCHED, *more]})
    assert report.dof == dof
    assert report.generalized_coordinates is not None
    assert len(report.generalized_coordinates) == dof
    assert {q.rpartition("_")[2] for q in report.generalized_coordinates} <= {*bodies}
