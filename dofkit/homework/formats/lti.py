"""Scores for LTI's Assignment and Grade Services, as a tool posts them to a line item.

Where an answer needs a review no score is given and ``gradingProgress`` is ``PendingManual``, which asks for a person;
where the submission could not be read it is ``Failed``. Otherwise it is ``FullyGraded``: a platform may ignore the
score of any other.
"""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from typing import Any

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, Target
from dofkit.homework.formats.documents import write_documents
from dofkit.homework.formats.wording import decided, feedback, identity
from dofkit.homework.result import Result
from dofkit.homework.sentences.translations import Language


def document(result: Result, timestamp: str, language: Language = "en") -> dict[str, Any]:
    """A score; ``timestamp`` is in ISO 8601 with parts of a second, and later than those of scores posted before."""
    found: dict[str, Any] = {"userId": identity(result.student)}
    if decided(result):
        found["scoreGiven"] = result.score
        found["scoreMaximum"] = result.max_score
    progress = "FullyGraded" if decided(result) else "PendingManual" if result.error is None else "Failed"
    return {
        **found,
        "comment": feedback(result, language),
        "timestamp": timestamp,
        "activityProgress": "Completed" if result.error is None else "Submitted",
        "gradingProgress": progress,
    }


def write(results: Iterator[Result], prepared: Prepared, target: Target) -> None:
    """One score a student."""
    language = prepared.assignment.language
    write_documents(
        results, target, lambda result: document(result, datetime.now(UTC).isoformat(timespec="microseconds"), language)
    )


LTI = Format("lti", write)
