"""Answers as students write them, in six languages: what each is worth was decided by hand before it was graded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from dofkit.base.documents import read_document
from dofkit.homework.answers.submission import of_value
from dofkit.homework.assignment import load_assignment
from dofkit.homework.grading import Grader
from dofkit.homework.questions import KINDS
from dofkit.homework.result import Item

FOLDER = Path(__file__).parent / "natural"
FILES = sorted(path.stem for path in FOLDER.glob("*.yaml"))
#: Few equations are compared there.
LIGHT = frozenset({"attacks_words", "contradictions", "words"})
OPEN = frozenset({"unreadable", "needs_review", "missing"})


@cache
def document(name: str) -> Any:
    return read_document((FOLDER / f"{name}.yaml").read_bytes(), name).value


@cache
def grader(name: str) -> Grader:
    return Grader(load_assignment(document(name)["assignment"]))


def rows(name: str) -> Iterator[tuple[str, str, Any]]:
    for part in ("answers", "later", "nearly", "last"):
        for place, by_verdict in document(name).get(part, {}).items():
            for verdict, answers in by_verdict.items():
                yield from ((place, verdict, answer) for answer in answers)


def graded(name: str, place: str, answer: Any) -> Item:
    """The item of one answer."""
    problem, question = place.split(".")
    result = grader(name).grade(of_value({"answers": {problem: {question: answer}}}, "s"))
    return next(i for i in result.items if (i.problem, i.question) == (problem, question))


@cache
def outcomes(name: str) -> tuple[tuple[str, str, Any, str, str], ...]:
    """Of every row the place, the verdict, the answer, what was found, and the feedback."""
    found = []
    for place, verdict, answer in rows(name):
        item = graded(name, place, answer)
        found.append((place, verdict, answer, "open" if item.status in OPEN else item.status, item.feedback))
    return tuple(found)


def every() -> list[tuple[str, str, Any, str, str]]:
    return [row for name in FILES for row in outcomes(name)]


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in LIGHT else pytest.mark.sweep) for name in FILES]
)
def test_no_right_answer_is_called_wrong_and_no_wrong_one_right(name: str) -> None:
    false = {("right", "wrong"), ("right", "partly"), ("wrong", "right"), ("wrong", "partly"), ("partly", "right"),
             ("partly", "wrong"), ("open", "right")}  # fmt: skip
    assert [row for row in outcomes(name) if (row[1], row[3]) in false] == []


def test_what_contradicts_itself_waits_for_a_person() -> None:
    for place, verdict, answer in rows("contradictions"):
        item = graded("contradictions", place, answer)
        waits = item.score is None and "A person will review" in item.feedback
        assert verdict != "open" or waits or item.status == "unreadable", (place, answer)


def test_every_way_to_read_a_contradiction_is_reported_with_what_it_earns() -> None:
    item = graded("contradictions", "shaken.label", "holonomic and non-holonomic, rheonomic")
    assert item.feedback.endswith("it can be read in more than one way.")
    assert [(way.read_as, way.score) for way in item.readings] == [
        ("holonomic, rheonomic", 1.0),
        ("non-holonomic, rheonomic", 0.5),
    ]


@pytest.mark.sweep
def test_ninety_seven_in_a_hundred_right_answers_get_full_marks() -> None:
    told = Counter(found for _, verdict, _, found, _ in every() if verdict == "right")
    assert told["right"] >= 0.97 * told.total()
    assert set(told) <= {"right", "open"}


@pytest.mark.sweep
def test_what_is_not_right_is_reported_why() -> None:
    assert [row for row in every() if row[3] != "right" and not row[4].strip()] == []


def test_six_hundred_answers_in_every_kind_of_question() -> None:
    assert sum(1 for name in FILES for _ in rows(name)) >= 600
    assert {q.kind() for name in FILES for _, q in grader(name).prepared.questions()} == set(KINDS)
