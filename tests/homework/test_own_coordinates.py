"""Coordinates that an assignment offers or an answer defines, and constants under another name."""

from __future__ import annotations

import re
from typing import Any

import pytest

from dofkit.homework.assignment import AssignmentError, load_assignment
from dofkit.homework.grading import grade

SCENE: dict[str, Any] = {
    "parameters": {"m": "positive", "l": "positive", "g": "positive"},
    "coordinates": ["x", "y"],
    "constraints": [{"name": "rod", "type": "equation", "text": "x^2 + y^2 = l^2"}],
    "energies": {"kinetic": "m (xdot^2 + ydot^2)/2", "potential": "m g y"},
}
ANGLE = {"theta": "atan2(x, -y)"}


def sheet(also: dict[str, str], **question: Any) -> Any:
    problem = {"id": "p", "scene": SCENE, "also": also, "questions": [{"id": "q", **question}]}
    return load_assignment({"title": "One", "problems": [problem]})


def item(prepared: Any, answer: Any) -> Any:
    return grade(prepared, {"student": "Ana", "answers": {"p": {"q": answer}}}).items[0]


@pytest.mark.parametrize(
    ("also", "ask", "answer", "status"),
    [
        (ANGLE, "lagrangian", "m l^2 thetadot^2/2 + m g l cos(theta)", "right"),
        (ANGLE, "lagrangian", "m l^2 thetadot^2/2 - m g l cos(theta)", "wrong"),
        ({}, "lagrangian", "m l^2 thetadot^2/2 + m g l cos(theta)", "unreadable"),
        (ANGLE, "motion", "thetaddot = -g/l sin(theta)", "right"),
        (ANGLE, "motion", "thetaddot = g/l sin(theta)", "wrong"),
        (ANGLE, "coordinates", "theta", "right"),
        ({}, "coordinates", "theta", "unreadable"),
        ({}, "coordinates", "a with x = l sin(a), y = -l cos(a)", "right"),
        # only half of the circle has such an a, and only one point such a phi
        ({}, "coordinates", "a with x = a^2", "needs_review"),
        ({}, "coordinates", "phi, where x = phi, y = 0", "needs_review"),
        ({}, "lagrangian", "m l^2 adot^2/2 + m g l cos(a), x = 0, y = -l + a", "unreadable"),
    ],
)
def test_own_coordinates(also: dict[str, str], ask: str, answer: str, status: str) -> None:
    assert item(sheet(also, ask=ask), answer).status == status


def test_a_constant_under_another_name_is_reported() -> None:
    found = item(sheet({}, ask="equation", constraint="rod"), "x^2 + y^2 = R^2")
    assert (found.status, found.read_as) == ("right", "x^2 + y^2 = R^2")
    assert found.feedback == "The names were matched to those of the problem: R = l."


def test_both_readings_of_a_fraction_are_tried() -> None:
    asked = sheet({}, ask="equation", constraint="rod")
    assert item(asked, "1/2x = 0").status == "wrong"
    found = item(asked, "1/2x^2 + 1/2y^2 = 1/2l^2")
    assert (found.status, found.score) == ("needs_review", None)


def test_the_column_of_what_could_not_be_read_is_that_of_the_text() -> None:
    found = item(sheet({}, ask="equation", constraint="rod"), "$x^2 + y^2 = \\zork$")
    assert (found.status, found.column) == ("unreadable", 14)


@pytest.mark.parametrize(
    ("also", "told"),
    [
        ({"x": "y"}, "`x` is a name of the scene already"),
        ({"a": "atan2(x, q)"}, "`q` is not declared"),
        ({"2a": "x"}, "begins with `2`"),
    ],
)
def test_what_cannot_be_offered(also: dict[str, str], told: str) -> None:
    with pytest.raises(AssignmentError, match=re.escape(told)):
        sheet(also, ask="dof")


PENDULUM: dict[str, Any] = {
    "dimension": 2,
    "parameters": {"m": "positive", "l": "positive", "g": "positive"},
    "particles": ["A"],
    "constraints": [{"name": "rod", "type": "link", "between": [[0, 0], "A"], "length": "l"}],
    "energies": {"kinetic": "m (xdot_A^2 + ydot_A^2)/2", "potential": "m g y_A"},
}


def pendulum(also: dict[str, str], **question: Any) -> Any:
    problem = {"id": "p", "scene": PENDULUM, "also": also, "questions": [{"id": "q", **question}]}
    return load_assignment({"title": "One", "problems": [problem]})


@pytest.mark.parametrize(
    "speed",
    ["thetadot", "theta_dot", "theta'", "θ̇", "θ'", "θdot", "\\dot\\theta", "\\dot{\\theta}", "(dtheta/dt)", "(dθ/dt)",
     "\\frac{d\\theta}{dt}", "\\left(\\frac{d \\theta}{d t}\\right)"],
)  # fmt: skip
def test_an_offered_coordinate_is_read_in_every_notation(speed: str) -> None:
    asked = pendulum({"theta": "atan2(x_A, -y_A)"}, ask="lagrangian")
    found = item(asked, f"1/2 m l^2 {speed}^2 + m g l cos(theta)")
    assert (found.status, found.read_as) == ("right", "m*l^2*thetadot^2/2 + m*g*l*cos(theta)"), found.feedback


@pytest.mark.parametrize("answer", ["θ̈ = -(g/l) sin θ", "θ'' = -(g/l) sin θ", "\\ddot\\theta = -(g/l) \\sin\\theta"])
def test_an_offered_acceleration_is_read_in_every_notation(answer: str) -> None:
    assert item(pendulum({"theta": "atan2(x_A, -y_A)"}, ask="motion"), answer).status == "right"


def test_a_coordinate_that_an_answer_defines_may_have_dots() -> None:
    answer = "L = m l² θ̇²/2 + m g l cos θ, x_A = l sin θ, y_A = -l cos θ"
    assert item(pendulum({}, ask="lagrangian"), answer).status == "right"


def test_the_definition_of_an_answer_goes_before_the_offered_one() -> None:
    asked = pendulum({"theta": "atan2(x_A, -y_A)"}, ask="lagrangian")
    upwards = "L = m l² θ̇²/2 - m g l cos θ, x_A = l sin θ, y_A = l cos θ"
    assert item(asked, upwards).status == "right"


def test_offered_coordinates_are_listed_in_their_order() -> None:
    also = {f"q{n}": f"x + {n}" for n in range(8)}
    feedback = item(sheet(also, ask="coordinates"), "zz").feedback
    assert ", ".join(also) in feedback


def test_offered_names_are_listed_with_the_declared_ones() -> None:
    for answer, ask in (
        ("m wwq^2 + 3", {"ask": "lagrangian"}),
        ("x_A = wwq^2", {"ask": "equation", "constraint": "rod"}),
    ):
        found = item(pendulum({"theta": "atan2(x_A, -y_A)"}, **ask), answer)
        assert "theta, x_A, y_A" in found.feedback, found.feedback


def test_an_equation_in_an_offered_coordinate_is_never_wrong_unseen() -> None:
    asked = pendulum({"theta": "atan2(x_A, -y_A)"}, ask="equation", constraint="rod")
    assert item(asked, "x_A = l sin θ, y_A = -l cos θ").status == "right"
    assert item(asked, "x_A = l sin θ").status == "needs_review"
    assert item(asked, "θ = 3").status == "needs_review"


def test_a_correct_answer_is_reported_in_the_offered_coordinates() -> None:
    problem = {"id": "p", "scene": SCENE, "also": ANGLE, "questions": [{"id": "q", "ask": "motion"}]}
    prepared = load_assignment({"title": "One", "feedback": "full", "problems": [problem]})
    told = item(prepared, "thetaddot = g/l sin(theta)").feedback
    assert told.startswith("This equation is not satisfied by the motion. A correct answer is")
    assert "thetaddot" in told
    assert "x" not in re.findall(r"\w+", told.partition("A correct answer is")[2])


def test_what_can_be_read_in_two_ways_keeps_its_latex_commands_whole() -> None:
    scene = {"coordinates": ["x", "theta", "phi"], "parameters": {"R": "positive"}}
    wheel = {**scene, "constraints": [{"name": "c", "type": "equation", "text": "x = R phi cos(theta)"}]}
    problem = {"id": "p", "scene": wheel, "questions": [{"id": "q", "ask": "equation", "constraint": "c"}]}
    found = item(load_assignment({"title": "One", "problems": [problem]}), r"x = R\cos\theta\,\varphi")
    assert found.read_as == "x = R*cos(theta*phi) or x = R*cos(theta)*phi"
    assert [way.score for way in found.readings] == [0.0, 1.0]
