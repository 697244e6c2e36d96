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


def test_a_constant_under_another_name_is_told() -> None:
    found = item(sheet({}, ask="equation", constraint="rod"), "x^2 + y^2 = R^2")
    assert (found.status, found.read_as) == ("right", "x^2 + y^2 = l^2")
    assert found.feedback == "Read R = l: so the problem calls it."


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
