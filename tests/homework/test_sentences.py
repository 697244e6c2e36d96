"""Feedback in other languages: every sentence that can be told is in the catalogue, with the same places."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import dofkit.homework
from dofkit.homework.assignment import load_assignment
from dofkit.homework.grading import grade
from dofkit.homework.key.misconceptions import ERRORS
from dofkit.homework.sentences.said import catalogue

ROOM = Path(dofkit.homework.__file__).parent
TOLD = [
    *(ROOM / "questions").glob("*.py"),
    *(path for path in (ROOM / "key").glob("*.py") if path.name != "codes.py"),
    *(ROOM / "answers").glob("*.py"),
    ROOM / "grading.py",
    ROOM / "handout" / "composition.py",
    ROOM / "judgement.py",
]
#: Calls whose texts are for lecturers, or are no sentences.
OTHERS = {"Field", "Fault", "TextError", "compile", "UnknownNameError", "words", "suggestion"}
SENTENCE = re.compile(r".*\s.*[.:?}]", re.DOTALL)


def sentences(node: ast.AST) -> Iterator[str]:
    """The texts below a node that are sentences: with a blank, and a stop at the end."""
    if isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):
        return
    if isinstance(node, ast.Call):
        name = getattr(node.func, "id", getattr(node.func, "attr", ""))
        if name in OTHERS:
            return
    if isinstance(node, ast.Constant) and isinstance(node.value, str) and len(node.value) > 12:
        if SENTENCE.fullmatch(node.value):
            yield node.value
        return
    for child in ast.iter_child_nodes(node):
        yield from sentences(child)


@pytest.mark.parametrize("language", ["de", "fr", "es"])
def test_every_sentence_is_in_the_catalogue(language: str) -> None:
    told = {text for path in TOLD for text in sentences(ast.parse(path.read_text(encoding="utf-8")))}
    assert len(told) > 90
    assert {m.hint for m in ERRORS} <= told
    known = catalogue()[language]
    assert told - set(known) == set()
    assert {text for text in known if " " in text} - told == set()


@pytest.mark.parametrize("language", ["de", "fr", "es"])
def test_translations_keep_the_places(language: str) -> None:
    for sentence, other in catalogue()[language].items():
        assert sorted(re.findall(r"\{\w+\}", sentence)) == sorted(re.findall(r"\{\w+\}", other))
        assert other.strip()


@pytest.mark.parametrize(
    ("language", "feedback"),
    [
        ("en", "You did not say whether it is scleronomic or rheonomic."),
        ("de", "Es fehlt, ob sie skleronom oder rheonom ist."),
        ("fr", "Il manque : est-elle scléronome ou rhéonome ?"),
        ("es", "Falta decir si es esclerónoma o reónoma."),
    ],
)
def test_feedback_comes_in_the_language_of_the_assignment(language: str, feedback: str) -> None:
    scene = {"coordinates": ["x", "y"], "constraints": [{"name": "c", "type": "equation", "text": "x^2 + y^2 = 1"}]}
    asked = {"id": "p", "scene": scene, "questions": [{"id": "q", "ask": "label", "constraint": "c"}]}
    sheet = load_assignment({"title": "One", "language": language, "problems": [asked]})
    assert grade(sheet, {"student": "Ana", "answers": {"p": {"q": "holonomic"}}}).items[0].feedback == feedback
