"""Feedback in other languages: every sentence that can be told is in the catalogue, with the same places."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from shared.sources import one_process, tree_at

import dofkit.homework
from dofkit.homework.assignment import load_assignment
from dofkit.homework.formats.wording import STATUSES
from dofkit.homework.grading import grade
from dofkit.homework.key.misconceptions import ERRORS
from dofkit.homework.questions import KINDS
from dofkit.homework.sentences import Language, catalogue, meanings, stopped

pytestmark = one_process
ROOM = Path(dofkit.homework.__file__).parent
TOLD = [
    *(ROOM / "questions").glob("*.py"),
    *(ROOM / "key").glob("*.py"),
    *(ROOM / "answers").glob("*.py"),
    ROOM / "grading.py",
    ROOM / "handout" / "composition.py",
    ROOM / "handout" / "page_sheets.py",
    ROOM / "judgement.py",
]
#: Whose sentences stand among other texts.
SHOWN = [
    *(ROOM / "formats").glob("*.py"),
    *(ROOM / name for name in ("autograder.py", "grading.py", "runs/batch.py")),
]
STUDENT_PAGE = ROOM / "formats" / "templates" / "student.html"
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


def told_by_calls(tree: ast.AST) -> Iterator[str]:
    """The literal sentences that a call of `in_language` takes."""
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and getattr(call.func, "id", "") == "in_language":
            yield from (a.value for a in call.args if isinstance(a, ast.Constant) and isinstance(a.value, str))


@pytest.mark.parametrize("language", ["de", "fr", "es"])
def test_every_sentence_is_in_the_catalogue(language: str) -> None:
    asked = {text for cls in KINDS.values() for text in cls.words()[:2]}
    told = asked | {text for path in TOLD for text in sentences(tree_at(path))}
    assert len(told) > 60
    assert {m.code for m in ERRORS} <= set(meanings())
    trees = [tree_at(path) for path in (*TOLD, *SHOWN)]
    calls = re.findall(r'page\.told\("([^"]+)"(?: if [^"]+ else "([^"]+)")?', STUDENT_PAGE.read_text(encoding="utf-8"))
    page = {text for call in calls for text in call} - {"", "{fault}", "{text}"}
    told |= page | set(STATUSES.values()) | {text for tree in trees for text in told_by_calls(tree)} - {"{fault}"}
    known = catalogue()[language]
    assert told - set(known) == set()
    literals = {n.value for tree in trees for n in ast.walk(tree) if isinstance(n, ast.Constant)}
    assert {text for text in known if " " in text} - told - literals - set(meanings().values()) == set()


@pytest.mark.parametrize("language", ["de", "fr", "es"])
def test_translations_keep_the_places(language: str) -> None:
    for sentence, other in catalogue()[language].items():
        places = set(re.findall(r"\{\w+\}", sentence)) - {"{reason}"}  # which is English
        assert places == set(re.findall(r"\{\w+\}", other))
        assert other.strip()


@pytest.mark.parametrize(
    ("language", "feedback"),
    [
        ("en", "State also whether it is scleronomic or rheonomic."),
        ("de", "Geben Sie auch an, ob sie skleronom oder rheonom ist."),
        ("fr", "Précisez aussi si elle est scléronome ou rhéonome."),
        ("es", "Indique también si es esclerónoma o reónoma."),
    ],
)
def test_feedback_comes_in_the_language_of_the_assignment(language: str, feedback: str) -> None:
    scene = {"coordinates": ["x", "y"], "constraints": [{"name": "c", "type": "equation", "text": "x^2 + y^2 = 1"}]}
    asked = {"id": "p", "scene": scene, "questions": [{"id": "q", "ask": "label", "constraint": "c"}]}
    sheet = load_assignment({"title": "One", "language": language, "problems": [asked]})
    assert grade(sheet, {"student": "Ana", "answers": {"p": {"q": "holonomic"}}}).items[0].feedback == feedback


def faults(node: ast.AST) -> Iterator[str]:
    """What is told where reading stops, and what to do: every literal text of an error, its places filled."""
    for call in ast.walk(node):
        if isinstance(call, ast.Call) and getattr(call.func, "id", "") in ("TextError", "UnknownNameError"):
            for told in (*call.args[:1], *call.args[2:3]):
                if isinstance(told, ast.Constant) and isinstance(told.value, str):
                    yield told.value
                elif isinstance(told, ast.JoinedStr):
                    parts = (_filled(part) for part in told.values)
                    yield "".join(parts)


def _filled(part: ast.expr) -> str:
    if isinstance(part, ast.Constant):
        return str(part.value)
    return "coordinate" if ast.unparse(part) == "{what}" or "what" in ast.unparse(part) else "q7"


@pytest.mark.parametrize("language", ["de", "fr", "es"])
def test_why_reading_stopped_is_reported_in_the_language(language: Language) -> None:
    rooms = [path for name in ("answers", "key", "questions") for path in (ROOM / name).glob("*.py")]
    told = {text for path in rooms for text in faults(tree_at(path))}
    assert len(told) > 15
    assert {text for text in told if stopped(text, language) == text} == set()


#: Words that no message in another language holds.
ENGLISH = re.compile(r"\b(the|is|are|write|there|here|did|you|not|cannot|stands|missing)\b")


@pytest.mark.parametrize("language", ["de", "fr", "es"])
@pytest.mark.parametrize(
    "answer",
    ["x^2 + zz = 1", "x + (y = 1", "x ~ 1", "sin = 3", "x = 1)", "x =", "= x", "x : y", "x + dy = 0", "3 cm + x = 1",
     "\\int x = 3", "x = 5 5", "sin(dx) = 0", "x = 3! + y", "(x, y) = 1", "x @ y = 0", "x = \u00bf"],
)  # fmt: skip
def test_an_answer_that_is_not_read_is_reported_so_in_the_language(language: str, answer: str) -> None:
    scene = {"coordinates": ["x", "y"], "constraints": [{"name": "c", "type": "equation", "text": "x^2 + y^2 = 1"}]}
    asked = {"id": "p", "scene": scene, "questions": [{"id": "q", "ask": "equation", "constraint": "c"}]}
    sheet = load_assignment({"title": "One", "language": language, "problems": [asked]})
    item = grade(sheet, {"student": "Ana", "answers": {"p": {"q": answer}}}).items[0]
    assert item.status == "unreadable", item
    assert ENGLISH.search(re.sub(r"\(U\+[^)]*\)", "", item.feedback)) is None, item.feedback
