"""PrairieLearn's ``results.json`` of an external grader: points as a share, and a test for every answer.

``gradable: false`` uses no attempt and gives no points. It is returned if an answer cannot be read, can be read in
several ways, or contains undeclared names. This depends on its text and the declared names alone, never on the key,
because students can repeat what uses no attempt. ``format_errors`` lists these answers, and nothing is said about the
others. An answer with one reading that could not be decided has no points yet: a person gives them on PrairieLearn's
own page.
"""

from __future__ import annotations

from typing import Any

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, per_student, text
from dofkit.homework.formats.wording import line, plain, remark, shortened, standing, title
from dofkit.homework.result import Item, Result
from dofkit.homework.sentences import Language, in_language

#: The most bytes that PrairieLearn accepts; the most characters of one text if a result is longer.
MOST_BYTES, MOST_CHARACTERS = 1_000_000, 1000
UNGRADED = (
    "This submission was not graded and did not use an attempt. Write the answers that could not be read differently; "
    "a person will review the others."
)


def document(result: Result, prepared: Prepared) -> dict[str, Any]:
    """Return the ``results.json`` of a submission, in less than a megabyte."""
    language = prepared.assignment.language
    fields = _document(result, language)
    if len(text(fields)) > MOST_BYTES:
        too_many = in_language(language, "There are too many answers to be listed one by one.")
        errors = [shortened(error, MOST_CHARACTERS) for error in fields.get("format_errors", [])[:50]]
        fields |= {"tests": [], "message": f"{fields['message']}\n{too_many}"}
        fields |= {"format_errors": errors} if errors else {}
    return fields


def _document(result: Result, language: Language) -> dict[str, Any]:
    message = standing(result, language)
    if result.error is not None:
        error = in_language(language, "{fault}", fault=plain(result.error))
        return {"gradable": False, "format_errors": [error], "message": message, "tests": []}
    errors = [_error(item, language) for item in result.items if item.status == "unreadable" or not item.certain]
    if errors:
        return {"gradable": False, "format_errors": errors, "message": in_language(language, UNGRADED), "tests": []}
    tests = [_test(item, language) for item in result.items]
    share = min(max((result.score or 0.0) / result.max_score, 0.0), 1.0) if result.max_score else 0.0
    return {"gradable": True, "score": share, "message": message, "tests": tests}


def _test(item: Item, language: Language) -> dict[str, Any]:
    return {
        "name": title(item),
        "description": in_language(language, "Read as: {text}", text=line(item.read_as)) if item.read_as else "",
        "points": item.score,
        "max_points": item.max_score,
        "message": remark(item, language),
        "output": "",
    }


def _error(item: Item, language: Language) -> str:
    where = "" if item.column is None else in_language(language, " (column {column})", column=item.column)
    several = "It reads in several ways, or in names that are not declared: {text}"
    if item.read_as and item.status != "unreadable":
        return f"{title(item)}: {in_language(language, several, text=line(item.read_as))}"
    return f"{title(item)}{where}: {line(item.feedback) or in_language(language, 'not readable')}"


PRAIRIELEARN = Format("prairielearn", per_student(document))
