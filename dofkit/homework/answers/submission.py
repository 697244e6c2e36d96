"""Submissions: what students submit, as mappings or as JSON or YAML texts.

Nothing here raises for what a student wrote: an unreadable text becomes a submission with an error.
"""

from __future__ import annotations

import json
import os
import re
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from decimal import Decimal
from fractions import Fraction
from numbers import Integral
from pathlib import Path
from typing import Any

from dofkit.base.documents import Document, read_document
from dofkit.base.errors import Fault
from dofkit.base.yaml_events import LARGEST_EXPONENT
from dofkit.homework.answers.notation import backslashes_kept
from dofkit.homework.answers.words import NO_ANSWER
from dofkit.homework.judgement import Given

#: The most bytes of a submission.
MOST_BYTES = 8_000_000
#: The most levels of lists within lists in an answer.
DEEPEST = 10
#: The most faults in the message of an error.
MOST_FAULTS = 5
_SHAPE = "write 'student: NAME' and 'answers: {PROBLEM: {QUESTION: answer}}'"
_SCALAR = re.compile(r"[^,\]}\n\r]*")
_SURROGATES = re.compile("[\ud800-\udfff]")


@dataclass(frozen=True)
class FilePlace:
    """A file and a line in it, counted from 1; 0 for the whole file."""

    file: str = ""
    line: int = 0

    def __str__(self) -> str:
        return f"{self.file}, line {self.line}" if self.line else self.file

    def message(self, fault: Fault) -> str:
        """Return a fault in the text at this place as a message with its line in the file."""
        line = (fault.line or 1) + max(self.line, 1) - 1
        where = f", line {line}" if self.line or fault.line else ""
        column = f", column {fault.column}" if fault.column else ""
        hint = f" ({fault.hint})" if fault.hint else ""
        place = f"{self.file}{where}{column}".removeprefix(", ")
        return f"{place}: {fault.message}{hint}" if place else f"{fault.message}{hint}"


@dataclass(frozen=True)
class Submission:
    """``answers``: {problem: {question: answer}}. ``error``: why it could not be read, with its place, or None."""

    student: str
    answers: Mapping[str, Mapping[str, Given]] = field(default_factory=dict)
    error: str | None = None


_NOWHERE = FilePlace()


def of_text(data: bytes | str, name: str, place: FilePlace, columns: Mapping[str, tuple[str, str]]) -> Submission:
    """Return the submission in a JSON or YAML text; ``name``: the student if the text gives none.

    ``columns``: {PROBLEM.QUESTION: (problem, question)}, for answers without ``answers:`` or with such keys.
    """
    if len(data) > MOST_BYTES:
        return refused(name, place, f"it is longer than {MOST_BYTES // 10**6} MB")
    document = _with_backslashes(data, name)
    if document.faults:
        reasons = "; ".join(place.message(_ours(fault)) for fault in document.faults[:MOST_FAULTS])
        return Submission(name, error=reasons)
    return of_value(shaped(document.value, columns), name, place, document)


def shaped(value: Any, columns: Mapping[str, tuple[str, str]]) -> Any:
    """Return other forms of a submission as ``{student, answers: {PROBLEM: {QUESTION: answer}}}``, else ``value``.

    >>> shaped({"p": {"f": 1}, "q.g": 2}, {"p.f": ("p", "f"), "q.g": ("q", "g")})
    {'answers': {'p': {'f': 1}, 'q': {'g': 2}}}
    """
    if not isinstance(value, Mapping):
        return value
    if isinstance(typed := value.get("submitted_answers"), Mapping):  # PrairieLearn's data.json
        value = {"answers": {column: _typed(typed, *place) for column, place in columns.items()}}
    answers = value.get("answers", {key: each for key, each in value.items() if key != "student"})
    declared = {*columns, *(problem for problem, _ in columns.values())}
    if not isinstance(answers, Mapping) or declared.isdisjoint(map(str, answers)):
        return value
    by_problem: defaultdict[str, dict[Any, Any]] = defaultdict(dict)
    for key, each in answers.items():
        problem, question = columns.get(str(key), (str(key), ""))
        if isinstance(each, Mapping):
            by_problem[str(key)].update(each)
        elif question and each is not None:
            by_problem[problem][question] = each
        elif each is not None:
            return value
    kept = {key: each for key, each in value.items() if key == "student" or "answers" in value}
    return {**kept, "answers": dict(by_problem)}


def _typed(typed: Mapping[str, Any], problem: str, question: str) -> Any:
    """Return the answer typed into an input ``PROBLEM.QUESTION``, or with ``_`` or ``-``; None if there is none."""
    answer = next((typed[name] for sign in "._-" if (name := f"{problem}{sign}{question}") in typed), None)
    return answer.get("_value") if isinstance(answer, Mapping) else answer


def _with_backslashes(data: bytes | str, name: str) -> Document:
    """Return the parsed document; backslashes of LaTeX in quotes, which would be faults, are read literally."""
    document = read_document(data, name)
    if not any("means nothing in a double-quoted text" in fault.message for fault in document.faults):
        return document
    repaired = read_document(backslashes_kept(document.text), name)
    return document if repaired.faults else repaired


def of_value(value: object, name: str, place: FilePlace = _NOWHERE, document: Document | None = None) -> Submission:
    """Return the submission of a mapping; ``document``: where the mapping was read, for lines of faults."""
    if not isinstance(value, Mapping):
        return refused(name, place, "a submission is a mapping with 'student' and 'answers'", _SHAPE)

    def bad(message: str, *where: str | int, key: bool = False) -> Submission:
        fault = Fault(message)
        if document is not None:
            line, column = document.place(where, key=key)
            fault = Fault(message, line=line, column=column)
        return Submission(student, error=place.message(fault))

    student = _student(value.get("student"), name, document)
    if not student or isinstance(value.get("student"), (Mapping, list, tuple, bool)):
        student = name
        return bad("'student' is a name or a number", "student")
    for key in value:
        if key not in ("student", "answers"):
            return bad(f"unknown key '{clean(str(key))[:60]}': there are 'student' and 'answers'", key, key=True)
    answers = {} if "answers" in value and value["answers"] is None else value.get("answers")
    if not isinstance(answers, Mapping):
        return bad("'answers' is a mapping of problems to mappings of questions to answers", "answers")
    by_problem: dict[str, dict[str, Given]] = {}
    for problem, problem_answers in answers.items():
        if isinstance(problem_answers, Mapping):
            by_problem[clean(str(problem))] = {
                clean(str(q)): _plain_answer(a) for q, a in problem_answers.items() if a is not None
            }
        elif problem_answers is not None:
            label = clean(str(problem))[:60]
            return bad(f"the answers to problem '{label}' are a mapping of questions to answers", "answers", problem)
    return Submission(student, by_problem)


def refused(name: str, place: FilePlace, message: str, hint: str | None = None) -> Submission:
    """Return a submission that could not be read, with its error."""
    return Submission(name, error=place.message(Fault(message, hint=hint)))


def reason(error: OSError | ValueError) -> str:
    """Return why a file cannot be read."""
    said = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return said[:1].lower() + said[1:]


def clean(text: str) -> str:
    """Return a text that can be encoded in UTF-8: lone surrogates become U+FFFD."""
    return text if text.isascii() else _SURROGATES.sub("\ufffd", text)


def _plain_answer(answer: Any, depth: int = 0) -> Given:
    """Return an answer, also a value of NumPy or SymPy, as plain texts, exact numbers and lists of them."""
    libraries = {(cls.__module__ or "").partition(".")[0] for cls in type(answer).__mro__}
    if not libraries.isdisjoint({"numpy", "sympy"}):
        return _plain_answer(answer.tolist(), depth) if hasattr(answer, "tolist") else str(answer)
    if isinstance(answer, str):
        return clean(answer)
    if isinstance(answer, bool | float):
        return answer
    if isinstance(answer, Integral | Decimal | Fraction):
        return _exact(answer)
    if isinstance(answer, set | frozenset):
        answer = sorted(answer, key=str)
    if isinstance(answer, list | tuple) and depth < DEEPEST:
        return tuple(_plain_answer(part, depth + 1) for part in answer)
    return NO_ANSWER


def _exact(number: Any) -> Given:
    """Return an exact number; as text if it is infinite, not a number or far too long."""
    if isinstance(number, Decimal) and (not number.is_finite() or abs(number.adjusted()) > LARGEST_EXPONENT):
        return str(number)
    fraction = Fraction(number)
    size = max(fraction.numerator.bit_length(), fraction.denominator.bit_length())
    if size > 4 * LARGEST_EXPONENT:
        return f"1e{size // 4}"
    return int(fraction) if isinstance(number, Integral) else fraction


def _student(value: object, name: str, document: Document | None) -> str:
    """Return the student's name or number, with every digit as written (007); ``name`` if there is none."""
    if value is None:
        return name
    if isinstance(value, str) or document is None:
        return clean(str(value)).strip()
    start, _ = document.places.get(("student",), (len(document.text), -1))
    scalar = _SCALAR.match(document.text, start)
    return (scalar[0].partition(" #")[0].strip() if scalar else "") or str(value)


def _ours(fault: Fault) -> Fault:
    """Return a fault of a document, with a hint for submissions in place of one for scenes."""
    scenes = fault.hint is not None and ("scene" in fault.hint or "coordinates:" in fault.hint)
    return replace(fault, hint=_SHAPE) if scenes else fault


def hand_in(
    answers: Mapping[str, Mapping[str, Any]], path: str | os.PathLike[str] = "answers.json", student: str | None = None
) -> Path:
    """Write the answers of a notebook to a file, which `dofkit grade` judges later, and return its path.

    Nothing is judged here: a student's own process could not be trusted with the key.

    Parameters
    ----------
    answers
        ``{PROBLEM: {QUESTION: answer}}``; an answer is a text, a number, a list, or a value of NumPy or SymPy. What is
        left as ``...`` or None is no answer.
    path
        The file to write.
    student
        The student's name, where the platform does not know it.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    by_problem = {
        str(problem): {str(q): _json_value(a) for q, a in asked.items() if a is not None and a is not ...}
        for problem, asked in answers.items()
    }
    target = Path(path)
    document = {**({} if student is None else {"student": student}), "answers": by_problem}
    target.write_text(json.dumps(document, indent=1, ensure_ascii=True) + "\n", encoding="ascii")
    print(f"{sum(map(len, by_problem.values()))} answers were written to {target}: submit this file.")
    return target


def _json_value(answer: Any) -> Any:
    """Return an answer as a JSON value; an exact number that is no integer becomes text."""
    plain = _plain_answer(answer)
    if isinstance(plain, tuple):
        return [_json_value(part) for part in plain]
    return str(plain) if isinstance(plain, Fraction) else plain
