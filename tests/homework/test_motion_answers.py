"""Answers about equations of motion: what is the same is right however it is written, and what is not is not."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest
from shared.known_scenes import spread

import dofkit
from dofkit.homework.questions import KINDS

SPHERE = "spherical-pendulum-cartesian"
DISC: dict[str, Any] = {
    "parameters": {"m": "positive", "I1": "positive", "I3": "positive", "R": "positive", "tau": "positive"},
    "coordinates": ["x", "y", "theta", "phi"],
    "constraints": ["dx = R cos(theta) dphi", "dy = R sin(theta) dphi"],
    "energies": {
        "kinetic": "m (xdot^2 + ydot^2)/2 + I1 thetadot^2/2 + I3 phidot^2/2",
        "potential": "0",
        "forces": {"phi": "tau"},
    },
}
LINKS: dict[str, Any] = {
    "parameters": {"m": "positive", "l": "positive", "g": "positive"},
    "coordinates": ["x1", "y1", "x2", "y2"],
    "constraints": ["x1^2 + y1^2 = l^2", "(x2 - x1)^2 + (y2 - y1)^2 = l^2"],
    "energies": {"kinetic": "m (x1dot^2 + y1dot^2 + x2dot^2 + y2dot^2)/2", "potential": "m g (y1 + y2)"},
}
STRING: dict[str, Any] = {
    "parameters": {"m": "positive", "l": "positive", "g": "positive"},
    "coordinates": ["x", "y"],
    "constraints": ["x^2 + y^2 = l^2"],
    "energies": {"kinetic": "m (xdot^2 + ydot^2)/2", "potential": "m g y"},
}
SCENES: dict[str, Any] = {"disc": DISC, "links": LINKS, "string": STRING}
L2 = "m (x1dot^2 + y1dot^2 + x2dot^2 + y2dot^2)/2"
UPPER = "m x1ddot = lam x1 - mu (x2 - x1); m y1ddot = lam y1 - mu (y2 - y1) - m g"


@cache
def grader(scene: str, ask: str, coordinate: str) -> Any:
    question = {"id": "q", "ask": ask, **({"coordinate": coordinate} if coordinate else {})}
    problem = {"id": "p", "scene": SCENES.get(scene, scene), "questions": [question]}
    return dofkit.load_assignment({"title": "motion", "problems": [problem]})


def graded(scene: str, ask: str, coordinate: str, answer: str) -> tuple[str, float | None, list[str]]:
    submission = {"student": "s", "answers": {"p": {"q": answer}}}
    item = dofkit.grade(grader(scene, ask, coordinate), submission).items[0]
    return item.status, item.score, item.codes


RIGHT, NOT_ALL = "right", "wrong WRONG_MOTION"
ROWS = [
    ("simple-pendulum-lagrangian", "lagrangian", "", "m l^2 thetadot^2/2 + m g l cos(theta)", RIGHT),
    ("simple-pendulum-lagrangian", "lagrangian", "", "L = T - V = m l² θ̇²/2 - m g l (1 - cos θ)", RIGHT),
    ("simple-pendulum-lagrangian", "lagrangian", "", "m l^2 thetadot^2/2 + m g l cos(theta) + theta thetadot", RIGHT),
    ("simple-pendulum-lagrangian", "lagrangian", "", "m l^2 thetadot^2/2 + m g l cos(theta) + 2 t theta "
     "+ t^2 thetadot", RIGHT),
    ("simple-pendulum-lagrangian", "lagrangian", "", "m l^2 thetadot^2/2 - m g l cos(theta)", "wrong TOTAL_ENERGY"),
    ("simple-pendulum-lagrangian", "lagrangian", "", "-m g l cos(theta) - m l^2 thetadot^2/2", "wrong SIGN"),
    ("simple-pendulum-lagrangian", "lagrangian", "", "m l^2 thetadot^2 + 2 m g l cos(theta)", "wrong WRONG_LAGRANGIAN"),
    ("simple-pendulum-lagrangian", "lagrangian", "", "m l^2 thetadot^2/2 + m g l cos(phi)", "unreadable"),
    ("simple-pendulum-lagrangian", "momentum", "theta", "p_theta = m l^2 theta'", RIGHT),
    ("simple-pendulum-lagrangian", "momentum", "theta", "m l thetadot", "wrong WRONG_MOMENTUM"),
    ("simple-pendulum-lagrangian", "force", "theta", "Q = -m g l sin(theta)", RIGHT),
    ("simple-pendulum-lagrangian", "force", "theta", "m g l sin(theta)", "wrong SIGN"),
    ("simple-pendulum-lagrangian", "motion", "", "thetaddot + (g/l) sin(theta) = 0", RIGHT),
    ("simple-pendulum-lagrangian", "motion", "", "diff(m l^2 thetadot, t) = -m g l sin(theta)", RIGHT),
    ("simple-pendulum-lagrangian", "motion", "theta", "thetaddot = -(g/l) sin(theta)", RIGHT),
    ("simple-pendulum-lagrangian", "motion", "", "thetaddot = -(g/l) theta", "wrong SMALL_ANGLES"),
    ("simple-pendulum-lagrangian", "motion", "theta", "l thetaddot + g theta = 0", "wrong SMALL_ANGLES"),
    ("simple-pendulum-lagrangian", "motion", "", "thetaddot = (g/l) theta", "wrong WRONG_MOTION"),
    ("trolley-pendulum", "motion", "", "(M+m) xddot + m l thetaddot + k x = 0; l thetaddot + xddot + g theta = 0",
     "wrong SMALL_ANGLES"),
    ("trolley-pendulum", "motion", "", "l thetaddot + xddot + g theta = 0", "wrong WRONG_MOTION"),
    ("simple-pendulum-lagrangian", "motion", "", "thetaddot = (g/l) sin(theta)", "wrong WRONG_MOTION"),
    ("simple-pendulum-lagrangian", "motion", "", "thetaddot <= 0", "wrong INEQUALITY"),
    ("simple-pendulum-lagrangian", "motion", "", "0 = 0", "wrong WEAKER"),
    ("damped-oscillator", "force", "x", "F(t) - c xdot - k x", RIGHT),
    ("damped-oscillator", "force", "x", "F(t) - k x", "wrong WRONG_FORCE"),
    ("damped-oscillator", "motion", "", "xddot + (c/m) xdot + (k/m) x = F(t)/m", RIGHT),
    ("damped-motion-exponential", "motion", "", "m xddot + g xdot + k x = 0", RIGHT),
    ("trolley-pendulum", "motion", "", "(M+m) xddot + m l (thetaddot cos(theta) - thetadot^2 sin(theta)) + k x = 0; "
     "l thetaddot + xddot cos(theta) + g sin(theta) = 0", RIGHT),
    ("trolley-pendulum", "motion", "", "M xddot + m l (thetaddot cos(theta) - thetadot^2 sin(theta)) + m xddot + k x + "
     "l thetaddot + xddot cos(theta) + g sin(theta) = 0; l thetaddot + xddot cos(theta) + g sin(theta) = 0", RIGHT),
    ("trolley-pendulum", "motion", "", "l thetaddot + xddot cos(theta) + g sin(theta) = 0", "partly WEAKER"),
    ("trolley-pendulum", "motion", "", "l thetaddot + xddot cos(theta) + g sin(theta) = 0; "
     "M xddot + k x = 0", "partly WRONG_MOTION"),
    ("trolley-pendulum", "motion", "theta", "l thetaddot + xddot cos(theta) + g sin(theta) = 0", RIGHT),
    ("trolley-pendulum", "motion", "x", "l thetaddot + xddot cos(theta) + g sin(theta) = 0", "wrong OTHER_COORDINATE"),
    ("trolley-pendulum", "motion", "x", "(M+m) xddot + m l (thetaddot cos(theta) "
     "- thetadot^2 sin(theta)) = -k x", RIGHT),
    ("orbit-polar", "motion", "theta", "r thetaddot + 2 rdot thetadot = 0", RIGHT),
    ("orbit-polar", "motion", "theta", "d/dt(m r^2 thetadot) = 0", "right or unreadable"),
    ("orbit-polar", "momentum", "theta", "m r^2 thetadot", RIGHT),
    ("orbit-polar", "motion", "r", "rddot = r thetadot^2 - G M/r^2", RIGHT),
    ("orbit-polar", "motion", "r", "rddot = -G M/r^2", "wrong WRONG_MOTION"),
    # the scene in x, y, z: an answer may use z, or what it is
    (SPHERE, "lagrangian", "", "m (xdot^2 + ydot^2 + zdot^2)/2 - m g z", RIGHT),
    (SPHERE, "lagrangian", "", "m (xdot^2 + ydot^2 + zdot^2)/2 + m g z", "wrong TOTAL_ENERGY"),
    (SPHERE, "momentum", "x", "m xdot", "needs_review"),
    (SPHERE, "motion", "", "m xddot = 2 lambda x; m yddot = 2 lambda y; m zddot = 2 lambda z - m g", RIGHT),
    (SPHERE, "motion", "", "m xddot = 2 lambda x; m yddot = 2 lambda y; m zddot = 2 lambda z + m g", NOT_ALL),
    # what is finite and keeps a multiplier holds at the points where answers are looked at
    ("links", "lagrangian", "", f"{L2} - m g (y1 + y2)", RIGHT),
    ("links", "lagrangian", "", f"{L2} - m g (y1 + y2) + x1^2 + y1^2", RIGHT),
    ("links", "lagrangian", "", f"{L2} + m g (y1 + y2)", "wrong TOTAL_ENERGY"),
    ("links", "lagrangian", "", f"{L2} - m g (y1 + y2) + x1", "wrong WRONG_LAGRANGIAN"),
    ("links", "momentum", "x1", "m y1dot", "wrong WRONG_MOMENTUM"),
    ("links", "force", "y1", "m g", "wrong SIGN"),
    ("links", "motion", "", f"{UPPER}; m x2ddot = mu (x2 - x1); m y2ddot = mu (y2 - y1) - m g", RIGHT),
    ("links", "motion", "", f"{UPPER}; m x2ddot = mu (x2 - x1); m y2ddot = mu (y2 - y1) + m g", NOT_ALL),
    ("string", "motion", "", "x yddot - y xddot + g x = 0", RIGHT),
    ("string", "motion", "", "m xddot = lam x; m yddot = lam y - m g; x^2 + y^2 = l^2", RIGHT),
    ("string", "motion", "", "m xddot = lam x; m yddot = lam y + m g", "wrong WRONG_MOTION"),
    ("disc", "motion", "", "(I3 + m R^2) phiddot = tau; thetaddot = 0; dx = R cos(theta) dphi", RIGHT),
    ("disc", "lagrangian", "", "m (xdot^2 + ydot^2)/2 + I1 thetadot^2/2 + I3 phidot^2/2", RIGHT),
    ("disc", "momentum", "x", "m R cos(theta) phidot", RIGHT),
    ("disc", "momentum", "x", "m R phidot", "wrong WRONG_MOMENTUM"),
    ("disc", "force", "phi", "tau", RIGHT),
    ("disc", "motion", "", "m xddot = lam1; m yddot = lam2; I1 thetaddot = 0; "
     "I3 phiddot = tau - lam1 R cos(theta) - lam2 R sin(theta)", RIGHT),
    ("disc", "motion", "", "m xddot = lam1; m yddot = lam2; I1 thetaddot = 0; "
     "I3 phiddot = tau - lam1 R sin(theta) - lam2 R cos(theta)", "partly WRONG_MOTION"),
    ("disc", "motion", "", "(I3 + m R^2) phiddot = tau; thetaddot = 0", RIGHT),
    ("disc", "motion", "", "I3 phiddot = tau; thetaddot = 0", "partly WRONG_MOTION"),
]  # fmt: skip


ALLOWED = {
    "right or unreadable": {"right", "unreadable"},
}


@pytest.mark.parametrize(("scene", "ask", "coordinate", "answer", "expected"), spread(ROWS, 2, several=True))
def test_answers(scene: str, ask: str, coordinate: str, answer: str, expected: str) -> None:
    status, score, codes = graded(scene, ask, coordinate, answer)
    told = " ".join([status, *codes])
    assert told in ALLOWED.get(expected, {expected})
    assert (score is None) == (status in ("needs_review", "unreadable"))


def test_half_of_the_equations_is_half_of_the_points() -> None:
    assert graded("trolley-pendulum", "motion", "", "l thetaddot + xddot cos(theta) + g sin(theta) = 0")[1] == 0.5


def test_what_has_no_equations_of_motion_is_left_to_a_person() -> None:
    for ask, answer in (("motion", "phiddot = 0"), ("lagrangian", "phidot^2")):
        assert graded("disc-rolling-on-plane", ask, "", answer) == ("needs_review", None, [])


def test_what_cannot_be_asked_is_told_of_the_assignment() -> None:
    problem = {"id": "p", "scene": "orbit-polar", "questions": [{"id": "q", "ask": "momentum", "coordinate": "phi"}]}
    with pytest.raises(dofkit.DofkitError, match="no coordinate 'phi'"):
        dofkit.load_assignment({"title": "t", "problems": [problem]})


def test_every_kind_about_motion_has_answers() -> None:
    assert {"lagrangian", "momentum", "force", "motion"} == {row[1] for row in ROWS} <= set(KINDS)
