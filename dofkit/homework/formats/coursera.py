"""Coursera's ``feedback.json``: a share of the points, and a text.

Coursera takes a number and nothing else, and has no review by a person. So that an answer that could not be decided is
neither zero nor full marks there, half of its points stand in for it, and the text begins with saying so. One that
could not be read has none, and the text says that it can be handed in again.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, Target
from dofkit.homework.formats.documents import write_documents
from dofkit.homework.formats.wording import OPEN_SHARE, feedback, number, stand_in
from dofkit.homework.result import Result
from dofkit.homework.sentences.translations import Language, in_language


def provisional(result: Result) -> float:
    """The points with those that stand in for what is open; no less than 0 and no more than there are."""
    score = (result.score or 0.0) + sum(stand_in(item) for item in result.items if item.score is None)
    return min(max(float(score), 0.0), result.max_score)


def document(result: Result, language: Language = "en") -> dict[str, Any]:
    """What ``feedback.json`` says of a submission."""
    paragraphs = [feedback(result, language)]
    waiting = sum(item.max_score for item in result.items if item.score is None and stand_in(item))
    if waiting:
        provisional_points = in_language(
            language,
            "This score is provisional: it includes half of the points ({points} of {most}) for answers that a person "
            "will review.",
            points=number(OPEN_SHARE * waiting),
            most=number(waiting),
        )
        paragraphs.insert(0, provisional_points)
    unread = sum(item.max_score for item in result.items if item.status == "unreadable" and not stand_in(item))
    if unread:
        unreadable = "Some answers could not be read (points: {points}). Write them differently and submit again."
        paragraphs.insert(0, in_language(language, unreadable, points=number(unread)))
    return {
        "fractionalScore": provisional(result) / result.max_score if result.max_score else 0.0,
        "feedback": "\n\n".join(paragraphs),
    }


def write(results: Iterator[Result], prepared: Prepared, target: Target) -> None:
    """One ``feedback.json`` a student."""
    write_documents(results, target, lambda result: document(result, prepared.assignment.language))


COURSERA = Format("coursera", write)
