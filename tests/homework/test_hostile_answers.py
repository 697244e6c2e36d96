"""Hostile and odd answers: each is refused with its column or read rightly, quickly, and touches nothing else."""

from __future__ import annotations

from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import spread
from shared.work import counted

from dofkit.homework.answers.submission import of_value
from dofkit.homework.assignment import load_assignment
from dofkit.homework.grading import Grader

#: Calls of functions for one answer that is refused, and for one that is an equation after all: 10 and 60 ms.
QUICK, GRADED = 60_000, 400_000
ASSIGNMENT: dict[str, Any] = {
    "title": "Hostile",
    "problems": [
        {
            "id": "p",
            "scene": {
                "coordinates": ["x", "y"],
                "parameters": {"R": "positive"},
                "constraints": [
                    {"name": "c", "type": "equation", "text": "x^2 + y^2 = R^2"},
                    {"name": "d", "type": "equation", "text": "dx = R dy"},
                ],
            },
            "questions": [
                {"id": "dof", "ask": "dof"},
                {"id": "label", "ask": "label", "constraint": "c"},
                {"id": "equation", "ask": "equation", "constraint": "c"},
                {"id": "integral", "ask": "integral", "constraint": "d"},
                {"id": "coordinates", "ask": "coordinates"},
                {"id": "redundant", "ask": "redundant"},
                {"id": "motion", "ask": "motion"},
            ],
        },
    ],
}
QUESTIONS = [q["id"] for q in ASSIGNMENT["problems"][0]["questions"]]

CODE = [
    "__import__('os').system('touch c')",
    "open('c','w').write('x')",
    "exec('1')",
    "eval('1')",
    "x.__class__.__mod__.__globals__['__builtins__']['open']('c','w')",
    'f"{open(1)}"',
    "(lambda: open('c','w'))()",
    "().__class__.__base__.__subclasses__()",
    "'{0.__class__}'.format(x)",
    "getattr(x,'name')",
    "lambdify(x,x)",
    "x.subs(x, 'open(1)')",
    "S('open(1)')",
]
EXHAUSTION = [
    "9**9**9",
    "2**2**40",
    "10**10**8",
    "1e999999999",
    "1e-999999999",
    "factorial(10**6)",
    "((((9!)!)!)!)",
    "binomial(10**9,5*10**8)",
    "(x+y+R)**400",
    "(" * 10**5,
    "sin(" * 500,
    "-" * 10**5,
    "+".join(["x"] * 10**4),
    "9" * 10**6,
    "0." + "9" * 10**5,
    "x" * 10**6,
    "9^{9^{9}}",
    "{" * 500,
    "\0",
    "x\0y",
    "\ud800",
]
NONSENSE = [
    "1/0", "x/0", "0^0", "nan", "oo-oo", "True", "None", "'abc'", "...", "x and y", "x if y else z", "0x10", "1_000",
    "010",
    "x # y", "x\ny", "х", "sin^-1(x)", "1/2x", "≠", "x ≠ y", "|x", "#", "\u202e", "\ufeff", "\t", "=", "==",
    "x =",
    "= x", "x == y", "x(t)", "sin2x", "½", "x_{1}", "<b>x</b>",
    "=cmd|' /C calc'!A0", "S N Q O E I beta gamma zeta lambda",
]  # fmt: skip


@cache
def grader() -> Grader:
    found = Grader(load_assignment(ASSIGNMENT))
    for question in QUESTIONS:
        graded(found, question, "x y", "warm")
    return found


def graded(grader: Grader, question: str, answer: Any, student: str = "s") -> Any:
    result = grader.grade(of_value({"student": student, "answers": {"p": {question: answer}}}, student))
    return next(item for item in result.items if item.question == question)


def named(text: str) -> str:
    return ascii(text[:30])


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("answer", CODE + EXHAUSTION, ids=named)
def test_is_refused_with_its_column(question: str, answer: str, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    here = grader()
    item, calls = counted(lambda: graded(here, question, answer))
    assert calls < QUICK
    assert (item.status in ("unreadable", "needs_review"), item.score) == (True, None)
    assert item.status == "needs_review" or (item.column is not None and item.column >= 1)
    assert list(tmp_path.iterdir()) == []
    assert len(item.feedback) < 600


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("answer", NONSENSE, ids=named)
def test_nonsense_is_read_or_refused(question: str, answer: str) -> None:
    here = Grader(grader().prepared)
    item, calls = counted(lambda: graded(here, question, answer))
    refused = item.status in ("unreadable", "missing")
    assert calls < (QUICK if refused else GRADED)
    assert item.status in ("unreadable", "wrong", "partly", "missing", "needs_review", "right")
    assert (item.status == "unreadable") == (item.column is not None)


#: What others misread in silence: how it is read here, or None where it is refused.
READ = {
    "R cos x dy": "R*cos(x)*dy = 0",
    "xdot = ẏ": "xdot = ydot",
    "x×y = 1": "x*y = 1",
    "dx/dt = 0": "xdot = 0",
    "diff(x,t) = 0": "xdot = 0",
    "x==y": "x = y",
    "x² = y": "x^2 = y",
    "x = 2e3": "x = 2000",
    "x = 1.5": "x = 3/2",
    "x(t) = y": "x = y",
    "x'(t) = 0": "xdot = 0",
    "|x| = y": "abs(x) = y",
    "x = ½": "x = 1/2",
    "1/2x = 0": "x/2 = 0 or 1/(2*x) = 0",
    "sin^-1(x) = 0": None,
    "x1 = 0": None,
    "x ≠ y": None,
    "х = 0": None,
}


@pytest.mark.parametrize(("answer", "read"), READ.items(), ids=[named(a) for a in READ])
def test_is_read_as_it_was_meant(answer: str, read: str | None) -> None:
    item = graded(grader(), "equation", answer)
    if read is None:
        assert item.status == "unreadable"
        assert item.column is not None
    else:
        assert item.read_as == read


@pytest.mark.parametrize(
    "answer", [True, None, {}, {"x": 1}, [], [[1]], [None], float("nan"), float("inf"), b"x", 3 + 4j]
)
@pytest.mark.parametrize("question", QUESTIONS)
def test_what_is_no_text(question: str, answer: Any) -> None:
    item = graded(grader(), question, answer)
    assert item.status in ("unreadable", "missing", "wrong", "needs_review", "right")
    assert item.status != "right" or not answer  # nothing moves in this scene, and nothing is redundant


#: Signs and words that say nothing, over and over.
FILLED = [",", ";", "$", "`", "«", "\\;", "&", '"', "because ", "or ", "(", "²", "1 (a) ", "not ", "non-", "a’b", "x, "]


@pytest.mark.parametrize(("question", "unit"), spread(product(QUESTIONS, FILLED), several=True), ids=named)
def test_what_is_only_repeated_is_refused_in_few_words(question: str, unit: str) -> None:
    item, calls = counted(lambda: graded(grader(), question, (unit * 2000)[:2000]))
    assert calls < GRADED
    assert item.status in ("unreadable", "missing", "needs_review", "wrong")
    assert len(item.feedback) < 600


@pytest.mark.sweep
def test_one_answer_does_not_change_another() -> None:
    here = Grader(load_assignment(ASSIGNMENT))
    before = {q: graded(here, q, "x") for q in QUESTIONS}
    for answer in CODE + EXHAUSTION + NONSENSE:
        for question in QUESTIONS:
            graded(here, question, answer)
    assert {q: graded(here, q, "x") for q in QUESTIONS} == before
    assert {q: graded(Grader(load_assignment(ASSIGNMENT)), q, "x") for q in QUESTIONS} == before
