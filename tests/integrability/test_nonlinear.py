"""Constraints nonlinear in the velocities beside linear ones: scenes with answers derived by hand.

f(q, qdot, t) = 0 is holonomic in the system iff it holds for all velocities (dt = 1) that the largest integrable part
of the system leaves; beside the other constraints it may read otherwise. Each scene says how its answers follow.
"""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.classification.dependence import implied_constraints, redundancy

ROLLING = ("dx = a cos(theta) dphi", "dy = a sin(theta) dphi")
SIZES = {"a": "positive", "b": "positive", "w": "positive"}


def scene(coordinates: str, *constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": coordinates.split(), "constraints": list(constraints), **more}


def report_of(made: dict[str, Any]) -> dict[str, Any]:
    return dofkit.classify(dofkit.load(made)).model_dump(mode="json")


#: (why, scene, (dof, velocity_dof), holonomic by constraint, {redundant: circuit written before it, if there is one})
TABLE: list[tuple[str, dict[str, Any], tuple[int, int], list[bool], dict[str, list[str] | None]]] = [
    (
        "c4 is 0 = 0 for what rolls, but z = b phi + C alone does not give it",
        scene("x y z theta phi", *ROLLING, "dz = b dphi", "b^2 (xdot^2 + ydot^2) = a^2 zdot^2", parameters=SIZES),
        (4, 2),
        [False, False, True, False],
        {"c4": ["c1", "c2", "c3"]},
    ),
    (
        "psidot = +-phidot for what rolls: integrable modulo the others only; psi -+ phi is the one integral",
        scene("x y psi theta phi", *ROLLING, "xdot^2 + ydot^2 = a^2 psidot^2", parameters=SIZES),
        (4, 2),
        [False, False, False],
        {},
    ),
    (
        "phidot = +-w for what rolls: phi -+ w t is the one integral, theta and the brackets give the rest",
        scene("x y theta phi", *ROLLING, "xdot^2 + ydot^2 = a^2 w^2", parameters=SIZES),
        (3, 1),
        [False, False, False],
        {},
    ),
    (
        "a blade at speed w: dx = w cos dt, dy = w sin dt; brackets with d/dtheta give every direction",
        scene("x y theta", "sin(theta) dx = cos(theta) dy", "xdot^2 + ydot^2 = w^2", parameters=SIZES),
        (3, 1),
        [False, False],
        {},
    ),
    (
        "on the circle the speed is |phidot|: z -+ phi is an integral",
        scene("x y z", "x^2 + y^2 = 1", "xdot^2 + ydot^2 = zdot^2"),
        (1, 1),
        [True, True],
        {},
    ),
    (
        "ydot = 0 is left: y is constant, x = t + C",
        scene("x y z", "xdot^2 + ydot^2 = 1", "xdot = 1"),
        (1, 1),
        [True, True],
        {},
    ),
    (
        "dx = 0 makes the contact form dz, and c3 is then 0 = 0 for all that dx = dz = 0 leaves",
        scene("x y z", "zdot = y xdot", "xdot = 0", "zdot^2 + xdot ydot = 0"),
        (1, 1),
        [True, True, True],
        {"c3": ["c1", "c2"]},
    ),
    (
        "two contact forms of different coordinates make c3 0 = 0; nothing integrates",
        scene("x y z u v w", "xdot = y zdot", "udot = v wdot", "2 xdot udot = y zdot udot + v wdot xdot"),
        (6, 4),
        [False, False, False],
        {"c3": ["c1", "c2"]},
    ),
    (
        "two closed forms make c3 0 = 0: x - y and u - w are constant, which gives it",
        scene("x y u w", "dx = dy", "du = dw", "xdot udot = ydot wdot"),
        (2, 2),
        [True, True, True],
        {"c3": ["c1", "c2"]},
    ),
    (
        "wdot^2 = zdot^2 with w - z constant, zdot = y xdot not: w - z = C alone does not give c3",
        scene("x y z w", "dz = y dx", "dw = dz", "wdot^2 = y^2 xdot^2"),
        (3, 2),
        [False, True, False],
        {"c3": ["c1", "c2"]},
    ),
    (
        "the branch wdot = zdot of c3 is c2",
        scene("x y z w", "dz = y dx", "dw = dz", "wdot^2 = zdot^2"),
        (3, 2),
        [False, True, True],
        {"c3": ["c2"]},
    ),
    (
        "with udot = xdot c2 is the square of the contact form",
        scene("x y z u", "udot = xdot", "xdot udot = (zdot - y xdot)^2 + xdot^2"),
        (3, 2),
        [True, False],
        {},
    ),
    (
        "with u = y the second is the square of the first; du = dy alone does not give it",
        scene("x y z u", "u = y", "zdot = y xdot", "zdot^2 = u^2 xdot^2"),
        (3, 2),
        [True, False, False],
        {"c3": ["c1", "c2"]},
    ),
    (
        "c1 - c2 is zdot = 0: z is constant, the speed in the plane is 1",
        scene("x y z", "xdot^2 + ydot^2 + zdot = 1", "xdot^2 + ydot^2 = 1"),
        (2, 1),
        [False, False],
        {},
    ),
    (
        "c1 and c2 give zdot = 1: z = t + C; c2 alone with it is still a speed",
        scene("x y z", "xdot^2 + ydot^2 = 1", "zdot = xdot^2 + ydot^2"),
        (2, 1),
        [False, False],
        {},
    ),
    (
        "z = 1 is hidden",
        scene("x y z", "xdot^2 + ydot^2 = 1", "xdot^2 + ydot^2 = z"),
        (2, 1),
        [False, False],
        {},
    ),
    (
        "xdot = 0 is hidden in c1 and c2, which makes dz = y dx the form dz",
        scene("x y z u", "xdot + ydot^2 + udot^2 = 1", "ydot^2 + udot^2 = 1", "dz = y dx"),
        (2, 1),
        [False, False, True],
        {},
    ),
    (
        "-3 zdot^2 = 0, so zdot = 0, so nothing moves",
        scene("x y z", "xdot^2 + ydot^2 = zdot^2", "xdot^2 + ydot^2 = 4 zdot^2"),
        (0, 0),
        [True, True],
        {},
    ),
    (
        "zdot = +-y^(1/2) xdot and zdot = 0: x and z are constant",
        scene("x y z", "zdot^4 = y^2 xdot^4", "zdot = 0"),
        (1, 1),
        [True, True],
        {},
    ),
    (
        "two quadrics meet in a curve that lies in no plane: nothing integrates",
        scene("x y z", "xdot^2 + ydot^2 = 1", "ydot^2 + zdot^2 = 2"),
        (3, 1),
        [False, False],
        {},
    ),
    (
        "the light cone is curved (Appell and Hamel): every direction is a sum of its velocities",
        scene("x y z", "zdot^2 = a^2 (xdot^2 + ydot^2)", parameters=SIZES),
        (3, 2),
        [False],
        {},
    ),
    (
        "where c1 holds c3 is y^2 (xdot^2 + udot^2 - 1)",
        scene("x y z u", "zdot = y xdot", "xdot^2 + udot^2 = 1", "zdot^2 + y^2 udot^2 = y^2"),
        (4, 2),
        [False, False, False],
        {"c3": ["c1", "c2"]},
    ),
    (
        "on the circle driven by time the speed is 1",
        scene("x y z", "x = cos(t)", "y = sin(t)", "xdot^2 + ydot^2 = 1"),
        (1, 1),
        [True, True, True],
        {"c3": ["c1", "c2"]},
    ),
    (
        "xdot^2 = 2 - cos(t)^2, which is never 0: x is an integral of t",
        scene("x y z", "y = sin(t)", "xdot^2 + ydot^2 = 2"),
        (1, 1),
        [True, True],
        {},
    ),
    (
        "xdot = +-t: x -+ t^2/2 integrates, the contact form does not",
        scene("x y z", "dz = y dx", "xdot^2 = t^2"),
        (2, 1),
        [False, True],
        {},
    ),
    (
        "(s - 1)(s + 1) with s = xdot^2 + ydot^2 is 0 only where s is 1",
        scene("x y z", "xdot^2 + ydot^2 = 1", "(xdot^2 + ydot^2)^2 = 1"),
        (3, 2),
        [False, False],
        {"c2": ["c1"]},
    ),
    ("x = +-y has xdot = +-ydot", scene("x y", "x^2 = y^2", "xdot^2 = ydot^2"), (1, 1), [True, True], {"c2": ["c1"]}),
    (
        "xdot = 1 is one of the branches of the other, so that is the one to go",
        scene("x y", "xdot^2 = 1", "xdot = 1"),
        (1, 1),
        [True, True],
        {"c1": None},
    ),
    (
        "c1 is a branch of c2",
        scene("x y z", "zdot = y xdot", "zdot^2 = y^2 xdot^2"),
        (3, 2),
        [False] * 2,
        {"c2": ["c1"]},
    ),
    (
        "y = z = 0 is hidden",
        scene("x y z", "x = 0", "xdot = y^2 + z^2", "y = 0"),
        (0, 0),
        [True] * 3,
        {"c3": ["c1", "c2"]},
    ),
    (
        "3 equations in one",
        scene("x y z", "x = 0", "y = 0", "x^2 + y^2 = 0"),
        (1, 1),
        [True] * 3,
        {"c1": None, "c2": None},
    ),
    (
        "cos x = cos y where x = y",
        scene("x y", "cos(x) = 1", "cos(y) = 1", "x = y"),
        (0, 0),
        [True] * 3,
        {"c2": None},
    ),
]


@pytest.mark.parametrize(
    ("made", "freedom", "holonomic", "circuits"), [r[1:] for r in TABLE], ids=[r[0] for r in TABLE]
)
def test_nonlinear_beside_linear(
    made: dict[str, Any], freedom: tuple[int, int], holonomic: list[bool], circuits: dict[str, list[str] | None]
) -> None:
    report = report_of(made)
    if sum("^2" in e["text"] and "dot" in e["text"] for e in report["constraints"]) > 1 and report["dof"] is None:
        assert report["consistent"] is not False  # several relations of second degree may be undecided together
        return
    assert report["consistent"] is True
    assert (report["dof"], report["velocity_dof"]) == freedom
    assert [e["holonomic"] for e in report["constraints"]] == holonomic
    assert report["redundant"] == sorted(circuits)
    assert {e["name"]: e["circuit"] for e in report["constraints"] if e["name"] in report["redundant"]} == circuits
    for name, circuit in circuits.items():
        assert any({name, *(circuit or ())} <= set(group["members"]) for group in report["redundancies"])


@pytest.mark.parametrize(
    ("made", "conflicting"),
    [
        (scene("x y z", "xdot^2 + ydot^2 = 1", "xdot^2 + ydot^2 = 2"), ["c1", "c2"]),
        (scene("x y z", "xdot^2 + ydot^2 = 1", "xdot^2 + ydot^2 = z", "z = 2"), ["c1", "c2", "c3"]),
        (scene("x y", "x = cos(t)", "y = sin(t)", "xdot^2 + ydot^2 = 2"), ["c1", "c2", "c3"]),
        (scene("x", "xdot^2 = 1", "x = t^2"), ["c1", "c2"]),
    ],
)
def test_no_motion_at_all(made: dict[str, Any], conflicting: list[str]) -> None:
    report = report_of(made)
    assert report["consistent"] is not True
    assert (report["dof"], report["conflicting"] or conflicting) == (None, conflicting)


@pytest.mark.parametrize(
    "made",
    [
        pytest.param(scene("z w", "zdot^3 + zdot wdot^2 = z wdot^3"), id="zdot = r(z) wdot with r^3 + r = z"),
        pytest.param(
            scene("x y z w", "xdot^2 + ydot^2 = z", "zdot^3 + zdot wdot^2 = z wdot^3"),
            id="a bend beside none",
        ),
        pytest.param(scene("x y z w", "xdot^2 + ydot^2 = z", "zdot^3 = z wdot^3"), id="zdot = z^(1/3) wdot"),
        pytest.param(
            scene("x y z u", "x^2 + y^2 = 1", "(x^2 + y^2 - 1) zdot^2 + udot^2 = ydot^2"), id="0 on the circle"
        ),
    ],
)
def test_what_may_be_linear_in_disguise_is_not_decided(made: dict[str, Any]) -> None:
    """The allowed velocities lie in less than the linear relations leave: no number and no label is claimed."""
    report = report_of(made)
    assert (report["verdict"], report["dof"], report["velocity_dof"]) == ("undecided", None, None)
    assert all(e["holonomic"] is not False for e in report["constraints"] if e["form"] != "finite")


def test_two_masses_on_a_rod_with_parallel_velocities() -> None:
    """Velocities v_A = c e + a n, v_B = c e + b n with e along the rod: parallel where c (b - a) = 0.

    c = 0 is a blade across the rod: no integral. a = b does not turn, a branch of less freedom (2).
    """
    rod = {"name": "rod", "type": "link", "between": ["A", "B"]}
    made = {"dimension": 2, "particles": ["A", "B"], "constraints": [rod, "xdot_A ydot_B = ydot_A xdot_B"]}
    report = report_of(made)
    assert (report["dof"], report["velocity_dof"], report["redundant"]) == (3, 2, [])
    assert [e["holonomic"] for e in report["constraints"]] == [True, False]


def test_a_rod_s_rate_is_redundant_beside_a_speed() -> None:
    rod = {"name": "rod", "type": "link", "between": ["A", "B"]}
    rate = "(x_A - x_B) (xdot_A - xdot_B) + (y_A - y_B) (ydot_A - ydot_B) = 0"
    made = {"dimension": 2, "particles": ["A", "B"], "constraints": [rod, "xdot_A^2 + ydot_A^2 = 1", rate]}
    report = report_of(made)
    assert (report["dof"], report["velocity_dof"], report["redundant"]) == (3, 2, ["c3"])
    assert report["constraints"][2]["circuit"] == ["rod"]


def test_the_reason_tells_what_is_left_of_it() -> None:
    rolling = report_of(scene("x y psi theta phi", *ROLLING, "xdot^2 + ydot^2 = a^2 psidot^2", parameters=SIZES))
    assert "integrable modulo the others" in rolling["constraints"][2]["reason"]
    helix = report_of(scene("x y z", "zdot = y xdot", "xdot = 0", "zdot^2 + xdot ydot = 0"))
    assert "It is implied by c1, c2." in helix["constraints"][2]["reason"]


def test_more_constraints_than_are_tried_one_by_one_are_left_open(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is not sought is not denied: that the last follows from the first."""
    for module in (implied_constraints, redundancy):
        monkeypatch.setattr(module, "MAX_CHOICES", 2)
    report = report_of(scene("x y z u", "zdot = y xdot", "udot = x ydot", "zdot^2 = y^2 xdot^2"))
    assert (report["redundant_equations"], report["redundant"], report["verdict"]) == (1, None, "undecided")
    assert all("was not decided" in e["reason"] for e in report["constraints"])


@pytest.mark.parametrize(
    ("constraint", "height", "freedom"),
    [
        ("xdot^2 + ydot^2 = z zdot^2", 1, {(3, 2)}),
        ("xdot^2 + ydot^2 = z zdot^2", -1, {(None, None), (0, 0)}),
        ("xdot^2 + ydot^2 = z zdot^2", 0, {(None, None), (3, 2)}),
        ("xdot^2 + ydot^2 = z", 1, {(3, 2)}),
        ("xdot^2 + ydot^2 = z", -1, {(None, None)}),
    ],
)
def test_at_a_reference_velocities_are_those_that_it_allows(
    constraint: str, height: int, freedom: set[tuple[int | None, int | None]]
) -> None:
    """Where z < 0 the first leaves all at rest, and the second holds nowhere."""
    at = {"x": 0, "y": 0, "z": height}
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": [constraint], "configuration": at})
    assert (report.dof, report.velocity_dof) in freedom


@pytest.mark.parametrize("constraint", ["exp(xdot) = y", "log(y) (xdot^2 + zdot^2 - 1) = 0", "xdot^2 = y"])
def test_a_reference_outside_the_domain_is_told(constraint: str) -> None:
    at = {"x": 0, "y": -1, "z": 0}
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": [constraint], "configuration": at})
    assert report.dof is None or any("not for the reference configuration itself" in told for told in report.warnings)
