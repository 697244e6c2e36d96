"""Gradescope's ``results.json``: a test for every question.

All texts have the format ``text``, which Gradescope shows literally, so that nothing a student wrote is markup.

Points are shown as the assignment's ``visibility`` says, by default after the due date: otherwise students would try
until an answer is right. One hidden test hides the total, so either all tests are visible or none is. Gradescope shows
``after_due_date`` after the late due date if there is one, and never if an assignment has no due date: the autograder
then uses ``after_published``. How an answer was read, or why it could not be read, is always shown at once.

An answer that needs a review is a test without ``score`` and ``status``: Gradescope shows its output and neither
points nor a colour. The ``score`` of the submission, which Gradescope requires, is the sum of the decided answers;
``output`` says first that it is not final and how many points are undecided; ``extra_data`` contains these numbers.
"""

from __future__ import annotations

from typing import Any

from dofkit.homework.assignment import Prepared, Visibility
from dofkit.homework.formats.base import Format, per_student
from dofkit.homework.formats.wording import line, open_points, plain, points, remark, standing, title
from dofkit.homework.result import Item, Result
from dofkit.homework.sentences import Language, in_language


def document(result: Result, prepared: Prepared, visible: Visibility | None = None) -> dict[str, Any]:
    """Return the ``results.json`` of a submission.

    ``visible``: when points are shown (None: as the assignment says).
    """
    language = prepared.assignment.language
    visibility = visible or prepared.assignment.visibility
    later = visibility != "visible" and result.error is None
    fields: dict[str, Any] = {
        "score": result.score or 0.0,
        "output": _first_output(result, language) if later else standing(result, language),
        "output_format": "text",
        "visibility": visibility if later else "visible",
        "extra_data": {
            "student": line(result.student),
            "needs_review": result.needs_review,
            "open_points": open_points(result),
            "error": None if result.error is None else plain(result.error),
            "doubt": None if result.doubt is None else plain(result.doubt),
        },
    }
    tests = [_test(item, visibility, language) for item in result.items]
    if later:
        tests = [*(_reading(item, language) for item in result.items), *tests]
    if result.error is not None:
        tests = [{"name": in_language(language, "Submission"), "status": "failed", "output": standing(result, language),
                  "output_format": "text", "visibility": "visible"}]  # fmt: skip
    return {**fields, "tests": tests}


def _first_output(result: Result, language: Language) -> str:
    """Return the text about the submission before points are shown."""
    doubt = result.doubt
    lines = [] if doubt is None else [in_language(language, "This result is not final: {fault}.", fault=plain(doubt))]
    lines.append(in_language(language, "The list shows how each answer was read; points are shown later."))
    return "\n".join(lines)


def _reading(item: Item, language: Language) -> dict[str, Any]:
    """Return a test that shows how an answer was read, without its points."""
    if item.status == "unreadable":
        output = remark(item, language)
    elif item.status == "missing":
        output = in_language(language, "No answer was given.")
    elif item.read_as:
        output = in_language(language, "Read as: {text}", text=plain(item.read_as))
    else:
        output = in_language(language, "A person will review this answer.")
    name = in_language(language, "{answer}: how it was read", answer=title(item))
    return {"name": name, "output": output, "output_format": "text", "visibility": "visible"}


def _test(item: Item, visibility: Visibility, language: Language) -> dict[str, Any]:
    fields: dict[str, Any] = {"name": title(item)}
    if item.score is not None:
        fields["score"] = item.score
        fields["max_score"] = item.max_score
        fields["status"] = "passed" if item.status == "right" else "failed"
    output = remark(item, language)
    if item.score is None:
        output = f"{output}\n{points(item, language)}."
    return {
        **fields,
        "output": output,
        "output_format": "text",
        "tags": [line(code) for code in item.codes],
        "visibility": visibility,
        "extra_data": {"status": item.status, "max_score": item.max_score},
    }


GRADESCOPE = Format("gradescope", per_student(document))
