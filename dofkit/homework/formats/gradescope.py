"""Gradescope's ``results.json``: a test for every question.

All texts are in the format ``text``, which Gradescope shows as it is, so that nothing a student wrote is markup there.
Every test is visible, since one hidden test would hide the total.

An answer that needs a review is a test without ``score`` and ``status``: Gradescope shows its output and neither
points nor a colour. The ``score`` of the whole, which Gradescope asks for, is the sum of what is decided; ``output``
says first that it is not final and how many points are open, and ``extra_data`` has the same as numbers.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, Target
from dofkit.homework.formats.documents import write_documents
from dofkit.homework.formats.wording import line, open_points, plain, standing, title, told
from dofkit.homework.result import Item, Result

#: Where a problem and a question of the assignment stand, such as 2.1.
Numbers = Mapping[tuple[str, str], str]


def numbers(prepared: Prepared) -> Numbers:
    """The number of every question: its problem's, and its own within it."""
    return {
        (problem.id, question.id): f"{i}.{j}"
        for i, problem in enumerate(prepared.assignment.problems, 1)
        for j, question in enumerate(problem.questions, 1)
    }


def document(result: Result, places: Numbers) -> dict[str, Any]:
    """What ``results.json`` says of a submission."""
    found: dict[str, Any] = {
        "score": result.score or 0.0,
        "output": standing(result),
        "output_format": "text",
        "visibility": "visible",
        "extra_data": {
            "student": line(result.student),
            "needs_review": result.needs_review,
            "open_points": open_points(result),
            "error": None if result.error is None else plain(result.error),
        },
    }
    tests = [_test(item, places.get((item.problem, item.question))) for item in result.items]
    if result.error is not None:
        tests = [{"name": "Reading the submission", "status": "failed", "output": plain(result.error),
                  "output_format": "text", "visibility": "visible"}]  # fmt: skip
    return {**found, "tests": tests}


def _test(item: Item, place: str | None) -> dict[str, Any]:
    found: dict[str, Any] = {"name": title(item)}
    if place is not None:
        found["number"] = place
    if item.score is not None:
        found["score"] = item.score
        found["max_score"] = item.max_score
        found["status"] = "passed" if item.status == "right" else "failed"
    output = told(item)
    if item.score is None:
        output = f"{output}\nOpen: {item.max_score:g} points."
    return {
        **found,
        "output": output,
        "output_format": "text",
        "tags": [line(code) for code in item.codes],
        "visibility": "visible",
        "extra_data": {"status": item.status, "max_score": item.max_score},
    }


def write(results: Iterator[Result], prepared: Prepared, target: Target) -> None:
    """One ``results.json`` a student."""
    places = numbers(prepared)
    write_documents(results, target, lambda result: document(result, places))


GRADESCOPE = Format("gradescope", write)
