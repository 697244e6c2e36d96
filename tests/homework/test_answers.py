"""Answers to homework, right, wrong and odd: status, points and codes decided by hand before they were graded."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import pytest
from shared.homework_cases import FILES, document

from dofkit.homework.answers.submission import of_value
from dofkit.homework.assignment import load_assignment
from dofkit.homework.grading import Grader
from dofkit.homework.key.misconceptions import ERRORS
from dofkit.homework.questions import KINDS


@cache
def grader(name: str) -> Grader:
    return Grader(load_assignment(document(name)["assignment"]))


def rows() -> Iterator[Any]:
    for name in FILES:
        for row in document(name)["answers"]:
            yield pytest.param(name, *row, id=f"{name}:{row[0]}:{str(row[1])[:50]}")


@pytest.mark.parametrize(("name", "place", "answer", "status", "score", "codes"), list(rows()))
def test_answer(name: str, place: str, answer: Any, status: str, score: float, codes: list[str]) -> None:
    problem, question = place.split(".")
    result = grader(name).grade(of_value({"student": "s", "answers": {problem: {question: answer}}}, "s"))
    (item,) = [i for i in result.items if (i.problem, i.question) == (problem, question)]
    assert (item.status, item.score) == (status, None if status in ("unreadable", "needs_review") else score), (
        item.feedback
    )
    assert item.codes[: len(codes)] == codes
    assert bool(item.codes) <= (status in ("wrong", "partly"))
    assert (item.column is not None) == (status == "unreadable")
    assert (result.score, result.needs_review) == (score, int(item.score is None))
    assert result.max_score == sum(i.max_score for i in result.items)


def test_there_are_two_hundred_answers_over_a_dozen_scenes() -> None:
    assert sum(len(document(name)["answers"]) for name in FILES) >= 200
    assert sum(len(document(name)["assignment"]["problems"]) for name in FILES) >= 12


def test_every_kind_and_every_code_has_an_answer() -> None:
    asked = {q.kind() for name in FILES for _, q in grader(name).prepared.questions()}
    elsewhere = {"lagrangian", "momentum", "force", "motion"}
    assert asked == set(KINDS) - elsewhere
    told = {code for name in FILES for row in document(name)["answers"] for code in row[4]}
    untold = {m.code for m in ERRORS} - told
    assert untold == set()
