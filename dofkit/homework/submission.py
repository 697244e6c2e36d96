"""Submissions: what students hand in, as mappings, JSON, YAML, CSV, JSON lines or a folder of files.

Nothing here raises for what a student wrote: what cannot be read is a submission that carries its error.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

from dofkit.documents import read_document
from dofkit.homework.judgement import Given


@dataclass(frozen=True)
class Submission:
    """``answers``: by problem, then by question. ``error``: why it could not be read; ``place``: where it stands."""

    student: str
    answers: Mapping[str, Mapping[str, Given]] = field(default_factory=dict)
    error: str | None = None
    place: str = ""


def read_submission(source: str | os.PathLike[str] | Mapping[str, Any]) -> Submission:
    """The one submission of a JSON or YAML file, or of a mapping ``{student, answers}``."""
    if isinstance(source, Mapping):
        return of_value(source, "", "")
    path = Path(source)
    try:
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        return Submission(path.stem, error=f"{path.name} cannot be read: {error}", place=str(path))
    return of_text(data, path.stem, str(path))


def of_text(data: bytes | str, name: str, place: str) -> Submission:
    """The submission of a JSON or YAML text; ``name`` is the student's where it gives none."""
    document = read_document(data, name)
    if document.faults:
        return Submission(name, error="; ".join(map(str, document.faults[:5])), place=place)
    return of_value(document.value, name, place)


def of_value(value: object, name: str, place: str) -> Submission:
    """The submission of a mapping."""
    if not isinstance(value, Mapping):
        return Submission(name, error="a submission is a mapping with 'student' and 'answers'", place=place)
    student = value.get("student")
    student = name if student is None else str(student)
    answers = value.get("answers")
    if not isinstance(answers, Mapping):
        return Submission(student, error="'answers' is a mapping of problems to answers", place=place)
    unknown = [k for k in value if k not in ("student", "answers")]
    if unknown:
        return Submission(student, error=f"unknown key '{unknown[0]}': there are 'student' and 'answers'", place=place)
    found: dict[str, dict[str, Given]] = {}
    for problem, given in answers.items():
        if given is None:
            continue
        if not isinstance(given, Mapping):
            why = f"the answers to problem '{problem}' are a mapping of questions to answers"
            return Submission(student, error=why, place=place)
        found[str(problem)] = {str(q): a for q, a in given.items() if a is not None}
    return Submission(student, found, place=place)


def as_given(text: str) -> Given:
    """A cell of a table as an answer."""
    return text


Number = int | float | Fraction
