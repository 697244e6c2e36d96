"""The answers of a practice sheet: how an answer is read, and the judgement of all answers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dofkit.homework.handout.page_sheets import judge_answers
from dofkit.homework.handout.reading import read_answer
from dofkit.homework.sentences import Language
from dofkit.interface.show.sheet import Formula
from dofkit.site.browser.shown import json_of_content


def read(declared: str, question: str, text: str, language: Language) -> dict[str, Any]:
    """Return how an answer is read (``shown``, a formula with MathML), or why it cannot be read."""
    reading = read_answer(declared, question, text, language)
    if "read_as" in reading:
        words = reading["read_as"]
        reading["shown"] = json_of_content(Formula(words)) if reading["formula"] else words
    return reading


def judge(assignment: str, answers: Mapping[str, Mapping[str, str]]) -> dict[str, Any]:
    """Return {"items": judgements} of the answers of a practice sheet."""
    return {"items": judge_answers(assignment, answers)}
