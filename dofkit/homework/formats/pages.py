"""The page of a student, and rendering of templates: all that a student wrote is escaped."""

from __future__ import annotations

import re
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dofkit.expressions.text.typesetting import mathml, typeset
from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.wording import STATUSES, line, number, open_points, plain, stop_of
from dofkit.homework.questions import QuestionBase
from dofkit.homework.result import Item, Result, Status
from dofkit.homework.sentences import Language, in_language

if TYPE_CHECKING:
    from jinja2 import Environment

TEMPLATES = Path(__file__).parent / "templates"
_NAME = re.compile("`([^`\n]+)`")


#: {status: sign}, so that a status is not shown by colour alone.
MARKS: dict[Status, str] = {
    "right": "✓", "partly": "◐", "wrong": "✗", "unreadable": "?", "missing": "–", "needs_review": "…",
}  # fmt: skip


def percent(score: float | None, most: float) -> float:
    """Return a score in percent of ``most``, from 0 to 100."""
    return min(max(100 * (score or 0.0) / most, 0.0), 100.0) if most else 0.0


def student_page(result: Result, prepared: Prepared) -> dict[str, Any]:
    """Return the values for the template of a student's page: answers by problem, and answers to other questions."""
    by_question = {(item.problem, item.question): item for item in result.items}
    language, sections = prepared.assignment.language, list[dict[str, Any]]()
    for problem in prepared.assignment.problems:
        rows = [
            _answer_row(by_question.pop((problem.id, q.id)), asked_text(q, language))
            for q in problem.questions
            if (problem.id, q.id) in by_question
        ]
        if rows:
            sections.append({"title": ": ".join(filter(None, (problem.id, problem.title))), "rows": rows})
    if by_question:
        rows = [_answer_row(item, "") for item in by_question.values()]
        sections.append({"title": in_language(language, "Answers to questions that were not asked"), "rows": rows})
    return {
        "title": prepared.assignment.title,
        "language": language,
        "told": partial(in_language, language),
        "result": result,
        "sections": sections,
        "open_points": open_points(result),
        "percent": percent(result.score, result.max_score),
        "open_percent": percent(open_points(result), result.max_score),
    }


def _answer_row(item: Item, asked: str) -> dict[str, Any]:
    score = "–" if item.score is None else number(item.score)
    return {"item": item, "asked": asked, "points": f"{score} / {number(item.max_score)}"}


def asked_text(question: QuestionBase, language: Language = "en") -> str:
    """Return the text of a question."""
    return plain(question.asked(", ".join(question.about)).translated(language))


def rendered(template: str, **values: Any) -> str:
    """Return the page of a template with these values."""
    return _environment().get_template(template).render(**values)


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(plain=plain, line=line, number=number, stop=stop_of, pieces=_pieces, formulas=_formulas)
    environment.globals.update(marks=MARKS, statuses=STATUSES)
    return environment


def _pieces(text: str) -> list[str]:
    """Return a text split at names in backquotes: texts alternate with names."""
    return _NAME.split(plain(text))


def _formulas(text: str) -> list[tuple[str, str]]:
    """Return (MathML or "", text) for the parts of a read answer; formulas in the grammar of scenes have MathML."""
    segments = re.split("(; | or )", plain(text))
    formulas = [typeset(part) if re.search("[=<>*^]", part) else None for part in segments]
    return [("" if latex is None else mathml(latex), part) for latex, part in zip(formulas, segments, strict=True)]
