"""Answers about equations of motion: what is the same is right however it is written, and what is not is not."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import spread

import dofkit
from dofkit.base.documents import read_document
from dofkit.homework.questions import KINDS

TABLE = read_document((Path(__file__).parent / "motion.yaml").read_bytes(), "motion").value
SCENES, ROWS = TABLE["scenes"], [tuple(row) for row in TABLE["answers"]]


@cache
def grader(scene: str, ask: str, coordinate: str) -> Any:
    question = {"id": "q", "ask": ask, **({"coordinate": coordinate} if coordinate else {})}
    problem = {"id": "p", "scene": SCENES.get(scene, scene), "questions": [question]}
    return dofkit.load_assignment({"title": "motion", "problems": [problem]})


def graded(scene: str, ask: str, coordinate: str, answer: str) -> tuple[str, float | None, list[str]]:
    submission = {"student": "s", "answers": {"p": {"q": answer}}}
    item = dofkit.grade(grader(scene, ask, coordinate), submission).items[0]
    return item.status, item.score, item.codes


ALLOWED = {
    "right or unreadable": {"right", "unreadable"},
}


@pytest.mark.parametrize(("scene", "ask", "coordinate", "answer", "expected"), spread(ROWS, several=True))
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


def test_what_cannot_be_asked_is_reported_of_the_assignment() -> None:
    problem = {"id": "p", "scene": "orbit-polar", "questions": [{"id": "q", "ask": "momentum", "coordinate": "phi"}]}
    with pytest.raises(dofkit.DofkitError, match="no coordinate 'phi'"):
        dofkit.load_assignment({"title": "t", "problems": [problem]})


def test_every_kind_about_motion_has_answers() -> None:
    assert {"lagrangian", "momentum", "force", "motion"} == {row[1] for row in ROWS} <= set(KINDS)
