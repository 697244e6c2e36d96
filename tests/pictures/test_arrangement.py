"""Where things stand in a picture: the drawing's own places, and places that meet the constraints."""

from __future__ import annotations

import math
from typing import Any

import pytest

import dofkit
from dofkit.expressions.tree import TIME, coordinate
from dofkit.pictures.arrangement import MOMENT, SCHEMATIC, Arrangement, arrangement_of, free_motions, movers
from dofkit.scene.lowering import lower


def numbers(scene: Any) -> dict[str, float]:
    found = arrangement_of(lower(dofkit.load(scene)))
    return {str(s.args[1]): v for s, v in found.numbers.items()}


def test_a_drawing_is_taken_as_it_is() -> None:
    found = arrangement_of(lower(dofkit.load("pinned-truss")))
    assert found.note is None
    assert found.met
    assert [found.poses[p].shift.tolist() for p in "AB"] == [[0, 0, 0], [4, 0, 0]]


def test_places_that_are_undecided_meet_the_constraints() -> None:
    found = numbers("double-pendulum-links")
    assert math.hypot(found["x_A"], found["y_A"]) == pytest.approx(1, abs=1e-8)
    assert math.hypot(found["x_B"] - found["x_A"], found["y_B"] - found["y_A"]) == pytest.approx(1, abs=1e-8)
    assert found["y_B"] < found["y_A"] < 0  # it hangs


def test_a_bead_on_a_curve_is_where_that_is_nearest_and_a_pendulum_hangs() -> None:
    """Nearest to (0.9, 0.7) is (0.87, 0.75) on the parabola; to the circle (0.9, 0.7) and (0.9, -0.7) are as near."""
    bead = {"dimension": 2, "particles": ["P"], "constraints": ["y_P = x_P^2"]}
    assert numbers(bead)["x_P"] == pytest.approx(0.87, abs=0.02)
    circle = {"type": "on", "members": ["P", [0, 1]], "surface": "x^2 + y^2 = 1"}
    assert numbers({**bead, "constraints": [circle]})["y_P"] < -0.5


def test_what_is_driven_is_drawn_at_a_moment_where_it_is_not_special() -> None:
    """At t = 0 the rod y = x tan(t) would be the x axis; a reference is drawn when it is given, at t = 0."""
    rod = {"dimension": 2, "particles": ["P"], "constraints": ["y_P = x_P tan(t)"]}
    assert numbers(rod)["t"] == MOMENT
    assert numbers(rod)["y_P"] == pytest.approx(numbers(rod)["x_P"] * math.tan(MOMENT))
    assert numbers({**rod, "configuration": {"x_P": 1, "y_P": 0}})["t"] == 0
    clip = dofkit.animate(rod).clips[0]
    assert any(abs(q[TIME] - MOMENT) < 1e-9 for q in clip.path)
    assert "Drawn with t = 0.5." in dofkit.draw(rod).sketch.notes


def test_inequalities_are_met_too() -> None:
    inside = {"particles": [{"name": "P"}], "constraints": ["x_P^2 + y_P^2 + z_P^2 <= 1/100"]}
    found = numbers(inside)
    assert found["x_P"] ** 2 + found["y_P"] ** 2 + found["z_P"] ** 2 <= 0.0100001


def test_what_cannot_be_met_is_a_schematic() -> None:
    found = arrangement_of(lower(dofkit.load({"coordinates": ["x"], "constraints": ["x = 1", "x = 2"]})))
    assert not found.met
    assert found.note == SCHEMATIC


def test_a_body_of_space_turns_by_its_gibbs_vector() -> None:
    system = lower(dofkit.load({"bodies": ["b"]}))
    values = dict(zip([coordinate(c.name) for c in system.coordinates], [0, 0, 0, 0, 0, 1.0], strict=True))
    pose = Arrangement(system, values, None, True).poses["b"]  # g = tan(45 deg) e_z: a right angle
    assert pose.moved((1, 0, 0)) == pytest.approx([0, 1, 0])
    assert pose.back(pose.moved((1, 2, 3))) == pytest.approx((1, 2, 3))


def test_the_velocities_of_a_four_bar_are_those_of_its_poles() -> None:
    """v_B = (-2, 0) for a crank at 1; (v_C - v_B).(C - B) = 0 with v_C = w (-3, -1) gives w = 8/13 of the rocker."""
    found = arrangement_of(lower(dofkit.load("four-bar-linkage")))
    (motion,) = free_motions(found, ["theta_crank"])
    rates = {str(s.args[1]): v for s, v in motion.rates.items()}
    assert rates["theta_crank"] == 1
    assert rates["theta_rocker"] == pytest.approx(8 / 13, abs=1e-6)
    assert movers(found, [motion]) == {"crank", "coupler", "rocker"}


def test_only_what_moves_is_said_to_move() -> None:
    found = arrangement_of(lower(dofkit.load("frame-held-fast")))
    assert movers(found, free_motions(found)) == {"rod"}
    assert free_motions(arrangement_of(lower(dofkit.load("crank-held-at-angle")))) == []


def test_what_is_driven_moves_with_time() -> None:
    found = arrangement_of(lower(dofkit.load("four-bar-driven-crank")))
    (motion,) = free_motions(found)
    assert motion.name == "time"
    assert movers(found, [motion]) == {"crank", "coupler", "rocker"}
