"""Equations of motion worked out by hand are verified; each way of being wrong is refused."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from typing import Any

import pytest
from checker.certified import certificate

import dofkit
from dofkit.checker import verify
from dofkit.methods.certificates.motion_evidence import certificate_of_motion

Parts = dict[str, Any]


def fault(document: Mapping[str, Any], claim: Parts, **parts: Any) -> str:
    """Why the claim fails; "" where it is verified."""
    found = verify(document, certificate(document, [{"path": "/motion", "rule": "lagrange", **claim}], **parts))
    assert found.claims == 1
    return found.failed[0]["why"] if found.failed else ""


def told(coordinates: str, lagrangian: str, equations: list[str], **more: Any) -> Parts:
    names = coordinates.split()
    plain: Parts = {"constraints": [], "multipliers": [], "eliminated": {}}
    return {"coordinates": names, "lagrangian": lagrangian, "equations": equations, **plain, **more}


#: A bead of mass m on the parabola y = x^2, and the same with y eliminated.
BEAD: Parts = {
    "dimension": 2,
    "parameters": {"m": "positive", "g": "positive"},
    "particles": [{"name": "P", "coordinates": ["x", "y"], "mass": "m"}],
    "constraints": ["y = x^2"],
    "forces": [{"type": "gravity", "acceleration": "g"}],
}
KEPT = told(
    "x y",
    "m (xdot^2 + ydot^2)/2 - m g y",
    ["m xddot + 2 lam1 x = 0", "m yddot + m g - lam1 = 0"],
    momenta={"x": "m xdot", "y": "m ydot"},
    forces={"x": "0", "y": "-m g"},
    constraints=["y - x^2 = 0"],
    multipliers=["lam1"],
)
ELIMINATED = told(
    "x",
    "m (1 + 4 x^2) xdot^2/2 - m g x^2",
    ["m (1 + 4 x^2) xddot + 4 m x xdot^2 + 2 m g x = 0"],
    momenta={"x": "m (1 + 4 x^2) xdot"},
    forces={"x": "4 m x xdot^2 - 2 m g x"},
    eliminated={"y": "x^2"},
)
AT: Parts = {"points": [{"id": "P", "values": {"m": "1", "g": "2", "x": "1/2", "y": "1/4"}}]}
ROW: Parts = {"at": "P", "rows": ["c1"], "columns": ["y"]}


def test_a_bead_with_a_multiplier_and_without() -> None:
    assert fault(BEAD, {"value": KEPT, "minor": ROW, "c": {"c1": {"lam1": "1"}}}, **AT) == ""
    assert fault(BEAD, {"value": ELIMINATED, "minor": ROW}, **AT) == ""


def changed(value: Parts, **parts: Any) -> Parts:
    return {**deepcopy(value), **parts}


FALSE: dict[str, tuple[Parts, str]] = {
    "a sign of an equation": (
        changed(ELIMINATED, equations=["m (1 + 4 x^2) xddot - 4 m x xdot^2 + 2 m g x = 0"]),
        "the equation of x",
    ),
    "a momentum": (changed(ELIMINATED, momenta={"x": "m xdot"}), "the momentum of x"),
    "a force": (changed(ELIMINATED, forces={"x": "-2 m g x"}), "the force along x"),
    "another mass": (changed(ELIMINATED, lagrangian="m (1 + 4 x^2) xdot^2 - m g x^2"), "the Lagrangian, by"),
    "another curve": (changed(ELIMINATED, eliminated={"y": "x^2 + 1"}), "where coordinates are put in"),
    "by a velocity": (changed(ELIMINATED, eliminated={"y": "x^2 + xdot - xdot"}), "by such, or by velocities"),
    "a momentum of nothing": (changed(ELIMINATED, momenta={**ELIMINATED["momenta"], "y": "0"}), "the evidence gives"),
    "something more": (changed(ELIMINATED, conserved=["x"]), "the evidence gives"),
    "a coordinate left out": (changed(ELIMINATED, eliminated={}), "each coordinate is kept or eliminated"),
}


@pytest.mark.parametrize("what", FALSE)
def test_what_is_false_of_a_motion_is_refused(what: str) -> None:
    value, why = FALSE[what]
    assert why in fault(BEAD, {"value": value, "minor": ROW}, **AT)


def test_a_coordinate_that_nothing_ties_is_not_eliminated() -> None:
    """Without the constraint y = x^2 is one motion among others: a free particle need not stay on it."""
    free = {**BEAD, "constraints": []}
    assert "one row for each" in fault(free, {"value": ELIMINATED, "minor": {**ROW, "rows": [], "columns": []}}, **AT)
    slope = {**BEAD, "constraints": ["x ydot - y xdot = 0"]}
    assert "where coordinates are put in" in fault(slope, {"value": ELIMINATED, "minor": ROW}, **AT)


def test_a_constraint_that_is_told_is_one_of_the_scene() -> None:
    """The particle is free, and no multiplier acts on it."""
    free = {**BEAD, "constraints": []}
    assert fault(free, {"value": KEPT, "minor": {**ROW, "rows": [], "columns": []}}, **AT)
    assert fault(
        BEAD, {"value": changed(KEPT, constraints=["y - 2 x^2 = 0"]), "minor": ROW, "c": {"c1": {"lam1": "1"}}}, **AT
    )


def test_a_constraint_that_is_left_out_is_missed() -> None:
    """Two planes leave the line x = y = 0; the equations of one alone have too few multipliers."""
    two = {**BEAD, "constraints": ["y = x^2", "y = 0"]}
    assert "where coordinates are put in" in fault(
        two,
        {"value": KEPT, "minor": ROW, "c": {"c1": {"lam1": "1"}}},
        points=[{"id": "P", "values": {"x": "0", "y": "0"}}],
    )


def test_a_finite_relation_is_no_multiple_of_a_form() -> None:
    """x = 0 is x/xdot times xdot = 0, which says something else where x is not 0."""
    wall = {**BEAD, "constraints": ["x = 0"]}
    value = changed(KEPT, constraints=["xdot = 0"], equations=["m xddot - lam1 = 0", "m yddot + m g = 0"])
    claim = {"value": value, "minor": {**ROW, "columns": ["x"]}, "c": {"c1": {"lam1": "x/xdot"}}}
    point = {"id": "P", "values": {"m": "1", "g": "2", "x": "0", "y": "0", "xdot": "1"}}
    assert "a cofactor contains velocities" in fault(wall, claim, points=[point])


def test_the_other_branch_is_not_that_of_the_drawing() -> None:
    """On the circle through the drawing at the bottom y = -sqrt(1 - x^2), and no other."""
    circle = {**BEAD, "constraints": ["x^2 + y^2 = 1"], "configuration": {"x": 0, "y": -1}}
    for sign, why in (("-", ""), ("", "the point does not satisfy")):
        slope = f"({sign}1)*(-x)/sqrt(1 - x^2)"
        value = told(
            "x",
            f"m xdot^2/(2 (1 - x^2)) - m g ({sign}1) sqrt(1 - x^2)",
            [f"m xddot/(1 - x^2) + m x xdot^2/(1 - x^2)^2 + m g {slope} = 0"],
            momenta={"x": "m xdot/(1 - x^2)"},
            forces={"x": f"m x xdot^2/(1 - x^2)^2 - m g {slope}"},
            eliminated={"y": f"({sign}1) sqrt(1 - x^2)"},
        )
        point = {"id": "P", "values": {"m": "1", "g": "2", "x": "0", "y": "-1"}}
        found = fault(circle, {"value": value, "minor": ROW}, points=[point])
        assert (why in found) if why else found == ""


def test_a_multiplier_has_no_name_of_the_scene() -> None:
    scene = {**BEAD, "parameters": {**BEAD["parameters"], "lam1": "real"}}
    assert "the name of another" in fault(scene, {"value": KEPT, "minor": ROW, "c": {"c1": {"lam1": "1"}}}, **AT)


def test_a_constant_is_none_that_texts_know() -> None:
    """y = C x is a motion for every C, y = pi x not that through (1, 2)."""
    slope = {**BEAD, "constraints": ["x ydot - y xdot = 0"], "configuration": {"x": 1, "y": 2}}
    for name, why in (("C", ""), ("pi", "the name of another"), ("E", "the name of another")):
        value = told(
            "x",
            f"m (1 + {name}^2) xdot^2/2 - m g {name}*x",
            [f"m (1 + {name}^2) xddot + m g {name} = 0"],
            momenta={"x": f"m (1 + {name}^2) xdot"},
            forces={"x": f"-m g {name}"},
            eliminated={"y": f"{name}*x"},
        )
        point = {"id": "P", "values": {"m": "1", "g": "2", "x": "1", "y": "2"}}
        for chosen, wrong in (("2", why), ("3", why or "the point does not satisfy")):
            found = fault(slope, {"value": value, "minor": ROW, "constants": {name: chosen}}, points=[point])
            assert (wrong in found) if wrong else found == ""


def test_what_pulls_in_ways_that_are_not_known_is_refused() -> None:
    for odd in ({"type": "drag", "damping": 1}, {"type": "gravity", "acceleration": "g", "wind": 2}):
        scene = {**BEAD, "forces": [*BEAD["forces"], odd]}
        assert fault(scene, {"value": ELIMINATED, "minor": ROW}, **AT)
    typing_error = {**BEAD, "energies": {"forces": {"z": "1"}}}
    assert "no coordinate" in fault(typing_error, {"value": ELIMINATED, "minor": ROW}, **AT)


def test_a_body_with_cayley_parameters_has_no_equations() -> None:
    assert "by its angles" in fault(BEAD, {"value": ELIMINATED, "minor": ROW, "cayley": True}, **AT)


#: An elimination, a factor that the equation was divided by, and multipliers; the others are as these.
FEW = ("bead-on-parabola", "damped-motion-exponential")
REST = ("atwood-machine", "disc-string-springs-mass", "double-pendulum-lagrangian", "spherical-pendulum-cartesian")


@pytest.mark.parametrize("name", [*FEW, *(pytest.param(name, marks=pytest.mark.sweep) for name in REST)])
def test_the_lectures_motions_are_verified(name: str) -> None:
    scene = dofkit.load(name)
    report = dofkit.lagrange(scene)
    found = certificate_of_motion(scene, report.model_dump(mode="json"), report.classification)
    shown = dofkit.verify(scene, found)
    assert (shown.verified, shown.failed, shown.uncovered) == (1, [], [])
    wrong = deepcopy(found)
    wrong["claims"][0]["value"]["equations"][0] = wrong["claims"][0]["value"]["equations"][0].replace(
        " = 0", " + 1 = 0"
    )
    assert dofkit.verify(scene, wrong).verified == 0
