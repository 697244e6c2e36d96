"""Constraints nonlinear in the velocities beside linear ones: scenes with answers derived by hand.

f(q, qdot, t) = 0 is holonomic in the system iff it holds for all velocities (dt = 1) that the largest integrable part
of the system leaves; beside the other constraints it may read otherwise. Each scene says how its answers follow.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

import dofkit
from dofkit.classification.dependence import implied_constraints, redundancy

ROLLING = ("dx = a cos(theta) dphi", "dy = a sin(theta) dphi")
SIZES = {"a": "positive", "b": "positive", "w": "positive"}


def scene(coordinates: str, *constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": coordinates.split(), "constraints": list(constraints), **more}


def report_of(made: dict[str, Any]) -> dict[str, Any]:
    return dofkit.classify(dofkit.load(made)).model_dump(mode="json")


#: Scenes with (dof, velocity_dof), which constraints are holonomic, and the circuits of those that are redundant.
TABLE = yaml.safe_load((Path(__file__).parent / "nonlinear.yaml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("row", [pytest.param(row, id=row["because"]) for row in TABLE])
def test_nonlinear_beside_linear(row: dict[str, Any]) -> None:
    parameters = dict.fromkeys(row.get("parameters", ()), "positive")
    report = report_of(scene(row["coordinates"], *row["constraints"], parameters=parameters))
    if sum("^2" in e["text"] and "dot" in e["text"] for e in report["constraints"]) > 1 and report["dof"] is None:
        assert report["consistent"] is not False  # several relations of second degree may be undecided together
        return
    circuits = row.get("circuits", {})
    assert report["consistent"] is True
    assert [report["dof"], report["velocity_dof"]] == row["dof"]
    assert [e["holonomic"] for e in report["constraints"]] == row["holonomic"]
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
        pytest.param(scene("u z w", "zdot^3 + zdot wdot^2 = u^2 wdot^3", "zdot = 1"), id="wdot = 1/r(u)"),
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


def test_more_constraints_than_are_tried_one_by_one_are_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
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
def test_a_reference_outside_the_domain_is_reported(constraint: str) -> None:
    at = {"x": 0, "y": -1, "z": 0}
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": [constraint], "configuration": at})
    assert report.dof is None or any("not for the reference configuration itself" in told for told in report.warnings)
