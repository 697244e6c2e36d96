"""Coursera's ``feedback.json``: a share of the points, and a text.

Coursera accepts only a number and has no review by a person. An undecided answer is therefore worth half of its points,
and the text begins by saying so. An answer that could not be read or is ambiguous (``7?``) is worth nothing, and the
text says that it can be submitted again.
"""

from __future__ import annotations

from typing import Any

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, per_student
from dofkit.homework.formats.wording import feedback, number
from dofkit.homework.result import Result
from dofkit.homework.sentences import in_language

#: The share of its points that an undecided answer gets.
OPEN_SHARE = 0.5


def document(result: Result, prepared: Prepared) -> dict[str, Any]:
    """Return the fields of ``feedback.json`` for a submission."""
    language = prepared.assignment.language
    unclear = [item for item in result.items if not item.score and (item.status == "unreadable" or not item.certain)]
    undecided = sum(item.max_score for item in result.items if item.score is None and item not in unclear)
    unreadable = sum(item.max_score for item in unclear)
    paragraphs = [feedback(result, language)]
    if undecided:
        sentence = (
            "This score is provisional: it includes half of the points ({points} of {most}) for answers that a person "
            "will review."
        )
        points = {"points": number(OPEN_SHARE * undecided), "most": number(undecided)}
        paragraphs.insert(0, in_language(language, sentence, **points))
    if unreadable:
        sentence = "Some answers could not be read (points: {points}). Write them differently and submit again."
        paragraphs.insert(0, in_language(language, sentence, points=number(unreadable)))
    score = min(max((result.score or 0.0) + OPEN_SHARE * undecided, 0.0), result.max_score)
    return {
        "fractionalScore": score / result.max_score if result.max_score else 0.0,
        "feedback": "\n\n".join(paragraphs),
    }


COURSERA = Format("coursera", per_student(document))
