"""Gradescope's ``results.json``: a test for every question.

All texts are in the format ``text``, which Gradescope shows as it is, so that nothing a student wrote is markup there.
Every test is visible, since one hidden test would hide the total.

An answer that needs a review is a test without ``score`` and ``status``: Gradescope shows its output and neither
points nor a colour. The ``score`` of the whole, which Gradescope asks for, is the sum of what is decided; ``output``
says first that it is not final and how many points are open, and ``extra_data`` has the same as numbers.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, Target
from dofkit.homework.formats.documents import write_documents
from dofkit.homework.formats.wording import line, open_points, plain, remark, standing, title
from dofkit.homework.result import Item, Result


def numbers(items: Sequence[Item]) -> list[str | None]:
    """The number of every answer: its problem's, and its own within it; None for those to nothing that was asked.

    They are the last ones, not readable and worth nothing.
    """
    most = len(items)
    while most and items[most - 1].status == "unreadable" and not items[most - 1].max_score:
        most -= 1
    problems: dict[str, int] = {}
    asked: Counter[str] = Counter()
    found: list[str | None] = [None] * len(items)
    for i, item in enumerate(items[:most]):
        problems.setdefault(item.problem, len(problems) + 1)
        asked[item.problem] += 1
        found[i] = f"{problems[item.problem]}.{asked[item.problem]}"
    return found


def document(result: Result) -> dict[str, Any]:
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
    tests = [_test(item, place) for item, place in zip(result.items, numbers(result.items), strict=True)]
    if result.error is not None:
        tests = [{"name": "AnswerReading the submission", "status": "failed", "output": plain(result.error),
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
    output = remark(item)
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
    del prepared
    write_documents(results, target, document)


GRADESCOPE = Format("gradescope", write)
