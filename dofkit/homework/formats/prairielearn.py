"""PrairieLearn's ``results.json`` of an external grader: points as a share, and a test for every answer.

``gradable: false`` costs a student no attempt and gives no points: that is said where an answer cannot be read, as
PrairieLearn's own elements do, and where an answer needs a review, since a share can neither leave it open nor may it
count it as nothing or as everything. ``format_errors`` then says which answers these are, and nothing is told of the
others: what costs no attempt would else tell, again and again, which of them are right. The points that a person gave
are taken back by a table of scores, in `dofkit.homework.formats.prairielearn_scores`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, Target
from dofkit.homework.formats.documents import text, write_documents
from dofkit.homework.formats.prairielearn_scores import write_scores
from dofkit.homework.formats.wording import line, plain, remark, shortened, standing, title
from dofkit.homework.result import Item, Result

#: PrairieLearn takes no more than a megabyte; and the characters of one text where that is too much.
MOST_BYTES, MOST_CHARACTERS = 1_000_000, 1000
UNGRADED = (
    "This was not graded and cost no attempt. What could not be read can be written in another way; what a person has "
    "to look at is graded when they have."
)


def document(result: Result) -> dict[str, Any]:
    """What ``results.json`` says of a submission, in less than a megabyte."""
    found = _document(result)
    most = MOST_CHARACTERS
    while len(text(found)) > MOST_BYTES and most >= 8:
        found = _cut(found, most)
        most //= 2
    if len(text(found)) > MOST_BYTES:
        found = {**found, "tests": [], "format_errors": found.get("format_errors", [])[:50]}
        found["message"] = f"{found['message']}\nThe answers one by one are too many to be shown."
    return found


def _document(result: Result) -> dict[str, Any]:
    if result.error is not None:
        return {"gradable": False, "format_errors": [plain(result.error)], "message": standing(result), "tests": []}
    errors = [_error(item) for item in result.items if item.status == "unreadable" or item.score is None]
    if errors:
        return {"gradable": False, "format_errors": errors, "message": UNGRADED, "tests": []}
    tests = [_test(item) for item in result.items]
    return {"gradable": True, "score": share(result), "message": standing(result), "tests": tests}


def share(result: Result) -> float:
    """The score from 0 to 1; 0 where nothing can be had."""
    return min(max((result.score or 0.0) / result.max_score, 0.0), 1.0) if result.max_score else 0.0


def _test(item: Item) -> dict[str, Any]:
    return {
        "name": title(item),
        "description": f"Read as: {line(item.read_as)}" if item.read_as else "",
        "points": item.score,
        "max_points": item.max_score,
        "message": remark(item),
        "output": "",
    }


def _error(item: Item) -> str:
    where = "" if item.column is None else f" (column {item.column})"
    return f"{title(item)}{where}: {line(item.feedback) or 'it could not be read.'}"


def _cut(found: dict[str, Any], most: int) -> dict[str, Any]:
    tests = [{k: shortened(v, most) if isinstance(v, str) else v for k, v in test.items()} for test in found["tests"]]
    cut = {**found, "tests": tests, "message": shortened(found["message"], most)}
    if "format_errors" in found:
        cut["format_errors"] = [shortened(error, most) for error in found["format_errors"]]
    return cut


def write(results: Iterator[Result], prepared: Prepared, target: Target) -> None:
    """One ``results.json`` a student."""
    del prepared
    write_documents(results, target, document)


PRAIRIELEARN = Format("prairielearn", write, endings=("json", "csv"), write_back=write_scores)
