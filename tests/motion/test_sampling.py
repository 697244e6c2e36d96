"""Configurations along a motion: what is held, where it leads, and what cannot be sampled."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import dofkit
from dofkit.motion.configurations import NoMotionError

Configuration = dict[str, float]
Array = np.ndarray[Any, Any]


def along(scene: dict[str, Any], *arguments: Any, **options: Any) -> list[Configuration]:
    return dofkit.configurations(dofkit.load(scene), *arguments, **options)


def about(axis: int, angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    found = np.eye(3)
    i, j = [k for k in range(3) if k != axis]
    found[i, i] = found[j, j] = c
    found[i, j], found[j, i] = -s, s
    return found


def standing(q: Configuration, body: str, at: list[float]) -> Array:
    """Where a body's point is that stood at ``at`` when its frame was the world's; the ground's stays."""
    if body == "ground":
        return np.array(at, dtype=float)
    if len(at) == 2:
        turned = about(2, q[f"theta_{body}"])[:2, :2]
        return np.array([q[f"x_{body}"], q[f"y_{body}"]]) + turned @ at
    turned = about(2, q[f"phi_{body}"]) @ about(0, q[f"theta_{body}"]) @ about(2, q[f"psi_{body}"])
    return np.array([q[f"{axis}_{body}"] for axis in "xyz"]) + turned @ at


def joints_close(scene: dict[str, Any], found: list[Configuration], size: float) -> None:
    """At every revolute the two bodies' points coincide, on its axis too."""
    for q in found:
        for joint in scene["constraints"]:
            if joint["type"] == "revolute":
                ends = [joint["at"]]
                if "axis" in joint:
                    ends.append([p + a for p, a in zip(joint["at"], joint["axis"], strict=True)])
                for at in ends:
                    first, second = (standing(q, body, at) for body in joint["between"])
                    assert np.max(np.abs(first - second)) < 1e-11 * size


def revolute(first: str, second: str, at: list[float], **more: Any) -> dict[str, Any]:
    return {"type": "revolute", "between": [first, second], "at": at, **more}


def four_bar(**drive: Any) -> dict[str, Any]:
    """Crank 1, coupler sqrt(20), rocker 3, ground 4: a crank-rocker by Grashof's rule."""
    joints = [
        revolute("ground", "crank", [0, 0], **drive),
        revolute("crank", "coupler", [0, 1]),
        revolute("coupler", "rocker", [4, 3]),
        revolute("rocker", "ground", [4, 0]),
    ]
    return {"dimension": 2, "bodies": ["crank", "coupler", "rocker"], "constraints": joints}


def test_a_crank_rocker_closes_up_after_a_full_turn_of_its_crank() -> None:
    scene = four_bar()
    found = along(scene, 400, 0.1)
    joints_close(scene, found, 4)
    first, last = found[0], found[-1]
    assert abs(abs(last["theta_crank"] - first["theta_crank"]) - 2 * math.pi) < 1e-9
    assert all(abs(last[k] - first[k]) < 1e-9 for k in first if k != "theta_crank")
    assert max(abs(q["theta_rocker"]) for q in found) < math.pi / 2


def test_a_driven_linkage_follows_its_drive() -> None:
    scene = four_bar(drive="2 t")
    found = along(scene, 20, 0.05)
    joints_close(scene, found, 4)
    assert [round(q["t"], 9) for q in found] == [round(0.05 * k, 9) for k in range(-20, 21)]
    assert all(abs(q["theta_crank"] - 2 * q["t"]) < 1e-11 for q in found)


def slider_crank(**drive: Any) -> dict[str, Any]:
    """r = 1 and l = 3, stretched."""
    joints = [
        revolute("ground", "crank", [0, 0]),
        revolute("crank", "rod", [1, 0]),
        revolute("rod", "piston", [4, 0]),
        {"type": "prismatic", "between": ["ground", "piston"], "axis": [1, 0], **drive},
    ]
    return {"dimension": 2, "bodies": ["crank", "rod", "piston"], "constraints": joints}


def piston(angle: float) -> float:
    return math.cos(angle) + math.sqrt(9 - math.sin(angle) ** 2) - 4


def test_a_slider_crank_passes_both_dead_centres() -> None:
    found = along(slider_crank(), 60, 0.1)
    angles = [q["theta_crank"] for q in found]
    assert min(angles) < -math.pi < math.pi < max(angles)
    assert all(abs(q["x_piston"] - piston(q["theta_crank"])) < 1e-11 for q in found)


def test_a_piston_drawn_in_from_its_dead_centre_moves_from_then_until_the_other() -> None:
    found = along(slider_crank(drive="-t"), 25, 0.1)
    assert [round(q["t"], 9) for q in found] == [round(0.1 * k, 9) for k in range(len(found))]
    assert 1.8 < found[-1]["t"] <= 2
    assert all(abs(q["x_piston"] + q["t"]) < 1e-11 for q in found)
    assert all(abs(piston(q["theta_crank"]) + q["t"]) < 1e-11 for q in found)


def test_a_motion_that_ends_now_is_followed_backward() -> None:
    scene = {"coordinates": ["x"], "constraints": ["x^2 = -t"], "configuration": {"x": 0}}
    found = along(scene, 5, 0.1)
    assert [round(q["t"], 9) for q in found] == [-0.5, -0.4, -0.3, -0.2, -0.1, 0]
    assert all(abs(q["x"] ** 2 + q["t"]) < 1e-12 for q in found)


def test_a_disc_that_is_turned_at_a_constant_rate_rolls_in_a_circle() -> None:
    """Without forces phi'' = 0, so with theta = t: x = R c sin t, y = R c (1 - cos t), phi = c t."""
    scene = {
        "coordinates": ["x", "y", "theta", "phi"],
        "constraints": ["dx = 2 cos(theta) dphi", "dy = 2 sin(theta) dphi", "theta = t"],
        "configuration": {"x": 0, "y": 0, "theta": 0, "phi": 0},
    }
    found = along(scene, 12, 0.2, along="phi")
    rate = found[-1]["phi"] / found[-1]["t"]
    assert rate > 0.1
    for q in found:
        t = q["t"]
        assert abs(q["theta"] - t) < 1e-12
        assert abs(q["phi"] - rate * t) < 1e-4
        assert math.hypot(q["x"] - 2 * rate * math.sin(t), q["y"] - 2 * rate * (1 - math.cos(t))) < 1e-4


def test_a_form_keeps_what_it_integrates_to() -> None:
    scene = {"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"], "configuration": {"x": 2, "y": 1}}
    assert all(abs(q["x"] * q["y"] - 2) < 1e-6 for q in along(scene, 8, 0.1))


def test_the_coordinate_that_is_driven_leads() -> None:
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["z = x y"], "configuration": {"x": 0, "y": 0, "z": 0}}
    for name, other in (("x", "y"), ("y", "x")):
        found = along(scene, 3, 0.1, along=name)
        assert np.allclose([q[name] for q in found], np.linspace(-0.3, 0.3, 7))
        assert all(abs(q[other]) < 1e-12 for q in found)


def test_a_door_swings_through_half_a_turn() -> None:
    scene = {"bodies": ["door"], "constraints": [revolute("ground", "door", [1, 2, 0], axis=[0, 0, 1])]}
    found = along(scene, 200, 0.1)
    joints_close(scene, found, 1)
    assert abs(found[-1]["psi_door"] - found[0]["psi_door"]) > 2 * math.pi - 0.2


BENNETT = [
    revolute("l3", "ground", [0, 39, 0], axis=[3, 0, 4]),
    revolute("ground", "l1", [0, 0, 0], axis=[0, 0, 1]),
    revolute("l1", "l2", [52, 0, 0], axis=[0, -4, 3]),
    revolute("l2", "l3", [16, -9, -12], axis=[-3, -4, 12]),
]


def test_a_linkage_with_more_equations_than_it_needs() -> None:
    scene = {"bodies": ["l1", "l2", "l3"], "constraints": BENNETT}
    found = along(scene, 12, 0.3)
    joints_close(scene, found, 65)
    assert len(found) == 25


def test_a_motion_that_begins_in_a_cusp() -> None:
    """y^2 = x^3 is left for x > 0 only, and so is y^2 = x^3 in time, x = t."""
    scene = {"coordinates": ["x", "y"], "constraints": ["y^2 = x^3"], "configuration": {"x": 0, "y": 0}}
    found = along(scene, 10, 0.1)
    assert len(found) == 11
    assert all(abs(q["y"] ** 2 - q["x"] ** 3) < 1e-12 for q in found)
    assert found[-1]["x"] > 0.5


def test_generic_lengths_and_parameters_are_chosen_and_told() -> None:
    scene = {
        "dimension": 2,
        "parameters": {"r": "positive"},
        "particles": ["A"],
        "constraints": ["x_A^2 + y_A^2 = r^2"],
    }
    found = along(scene, 5, 0.1)
    assert {q["r"] for q in found} == {found[0]["r"]}
    assert all(abs(math.hypot(q["x_A"], q["y_A"]) - q["r"]) < 1e-11 for q in found)
    assert all(q["r"] == 3 for q in along(scene, 5, 0.1, values={"r": 3}))


def test_a_motion_begins_near_the_values_that_are_given() -> None:
    """Also those of coordinates that no equation restricts, or that forms have with constant coefficients only."""
    scene = {"coordinates": ["x", "s", "phi"], "constraints": ["ds = 2 dphi"]}
    first = along(scene, 0, values={"x": 3, "s": 1, "phi": 0.5})[0]
    assert first == pytest.approx({"x": 3, "s": 1, "phi": 0.5})
    moving = {"coordinates": ["x"], "constraints": ["dx = t dt"]}
    assert along(moving, 0, values={"x": 3, "t": 2})[0] == pytest.approx({"x": 3, "t": 2})


def test_a_ring_of_seven_hinges_in_general_position() -> None:
    bodies = [f"b{i}" for i in range(1, 7)]
    ring = [{"type": "revolute", "between": list(pair)} for pair in pairwise(["ground", *bodies, "ground"])]
    found = along({"bodies": bodies, "constraints": ring}, 3, 0.1)
    assert len(found) == 7
    assert all(found[i] != found[i + 1] for i in range(6))


def test_a_way_ends_before_an_inequality_is_broken() -> None:
    scene = {"coordinates": ["x"], "constraints": ["0 <= x <= 1"], "configuration": {"x": 0.5}}
    places = [q["x"] for q in along(scene, 20, 0.1)]
    assert -1e-6 <= min(places) < 0.11
    assert 0.89 < max(places) <= 1 + 1e-6


@pytest.mark.parametrize(
    ("constraints", "options", "message"),
    [
        (["x = 1", "y = 2"], {}, "nothing moves"),
        (["x = 1", "x = 2"], {}, "nothing satisfies"),
        (["x = 1"], {"along": "z"}, "no coordinate"),
        (["x = 1"], {"along": "x"}, "cannot move"),
        (["xdot^2 + ydot^2 = 1"], {}, "nonlinear"),
        (["x = 1"], {"values": {"c": 2}}, "neither"),
        (["y^2 + x^4 = x^5"], {}, "undecided"),
    ],
)
def test_what_cannot_be_sampled_is_said(constraints: list[str], options: dict[str, Any], message: str) -> None:
    scene = {"coordinates": ["x", "y"], "constraints": constraints}
    if message == "undecided":
        scene["configuration"] = {"x": 0, "y": 0}
    with pytest.raises(NoMotionError, match=message):
        along(scene, **options)


def test_time_stands_still_where_only_an_inequality_holds_it() -> None:
    scene = {
        "coordinates": ["x", "y"],
        "constraints": ["x^2 + y^2 <= 1 + t"],
        "configuration": {"x": 0, "y": 0},
    }
    found = along(scene, steps=40, step=0.1)
    assert len(found) > 10
    assert {c["t"] for c in found} == {0.0}
    assert max(math.hypot(c["x"], c["y"]) for c in found) == pytest.approx(1, abs=0.1)  # to the wall at t = 0
