"""What is told of a graded submission."""

from __future__ import annotations

from dofkit.homework.formats.wording import STATUSES, line, number, points, standing, title
from dofkit.homework.result import Item, Result, Status
from dofkit.interface.show.sheet import Column, Fact, Grid, Remark, Sheet, SheetSection, Tone

_TONES: dict[Status, Tone] = {"right": "good", "partly": "care", "wrong": "bad"}
_COLUMNS = (Column("question"), Column("points"), Column("status"), Column("read as", 1))


def sheet_of_result(result: Result) -> Sheet:
    """The points, a line an answer, and the feedback."""
    tone = _TONES.get("right" if result.score == result.max_score else "partly", "plain")
    score = "open" if result.score is None else f"{number(result.score)} of {number(result.max_score)}"
    sections = (
        [SheetSection("Answers", [Grid(_COLUMNS, [_row(item) for item in result.items])])] if result.items else []
    )
    said = [Remark(title(item), line(item.feedback)) for item in result.items if item.feedback]
    if said:
        sections.append(SheetSection("Feedback", said))
    facts = (
        [Fact("points", score, standing(result), tone)]
        if result.error or result.needs_review
        else [Fact("points", score, tone=tone)]
    )
    return Sheet(line(result.student), facts=facts, sections=sections)


def _row(item: Item) -> tuple[str, str, str, str]:
    return title(item), points(item), STATUSES[item.status], line(item.read_as)
