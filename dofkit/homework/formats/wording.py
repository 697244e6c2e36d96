"""Texts that all formats share: points, statuses, feedback, and safe forms of what students wrote."""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from typing import NamedTuple

from dofkit.homework.result import Item, Result, Status
from dofkit.homework.sentences import Language, in_language

#: {status: its name in English}.
STATUSES: dict[Status, str] = {
    "right": "correct",
    "partly": "partly correct",
    "wrong": "incorrect",
    "unreadable": "not readable",
    "missing": "no answer",
    "needs_review": "awaiting review",
}
#: The most characters of an answer that are shown on each side of the place where reading stopped.
MOST_AROUND = 60
_MARKED_NAME = re.compile("`([^`\n]*)`")
#: Characters that files, terminals or parsers do not accept: controls, lone surrogates, noncharacters.
_UNPRINTABLE = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
#: Characters that change the direction of the text after them.
_TURNING = re.compile("[\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")
_OTHER_SPACE = re.compile(r"[^\S ]|(?<= ) |[\u00ad\u200b-\u200d\u2060\ufeff]")
_AROUND = re.compile("^ +| +$")
_LINES = re.compile("\r\n?|[\u2028\u2029\u0085]")
_PLAIN = re.compile(r"[a-z0-9][a-z0-9._@-]{0,59}")
_MARKED = re.compile(r"(-[0-9a-f]+|\.)$")
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d|index)(\..*)?$")


def plain(text: str) -> str:
    """Return a text with U+FFFD for unprintable characters, without marks that change the direction of text.

    >>> plain("a\\x00b\\r\\n\\u202ec")
    'a\ufffdb\\nc'
    """
    return _UNPRINTABLE.sub("\ufffd", _TURNING.sub("", _LINES.sub("\n", text)))


def line(text: str) -> str:
    """Return a text as `plain` does, on one line with single spaces.

    >>> line("one\\n  two\\tthree ")
    'one two three'
    """
    return " ".join(plain(text).split())


def identity(student: str) -> str:
    """Return a student's name with U+FFFD for every invisible character.

    Without these characters the name might be that of another student.

    >>> identity("Ada B"), identity("ada\u200e"), identity(" ada\\n")
    ('Ada B', 'ada�', '�ada�')
    """
    visible = _OTHER_SPACE.sub("�", _UNPRINTABLE.sub("�", _TURNING.sub("�", student)))
    return _AROUND.sub(lambda blanks: "�" * len(blanks[0]), visible)


def number(value: float) -> str:
    """Return a number of points as text, with at most four decimals and no trailing zeros.

    >>> number(2.0), number(1 / 3), number(0.5), number(0.0)
    ('2', '0.3333', '0.5', '0')
    """
    return f"{value:.4f}".rstrip("0").rstrip(".")


def points(item: Item, language: Language = "en") -> str:
    """Return the points of one answer, as in ``1 of 2``, with a dash for undecided points."""
    score = "–" if item.score is None else number(item.score)
    return in_language(language, "{score} of {most}", score=score, most=number(item.max_score))


def open_points(result: Result) -> float:
    """Return the sum of the points of undecided answers."""
    return sum(item.max_score for item in result.items if item.score is None)


def decided(result: Result) -> bool:
    """Return whether every answer has its points, so that the score is final."""
    gradable = result.error is None and result.doubt is None and result.score is not None
    return gradable and not result.needs_review


def standing(result: Result, language: Language = "en") -> str:
    """Return the state of a result in a sentence or two: an error, a doubt, or the points."""
    if result.error is not None:
        return in_language(language, "This submission could not be graded: {fault}", fault=plain(result.error))
    if result.doubt is not None:
        doubt = in_language(language, "This result is not final: {fault}.", fault=plain(result.doubt))
        return f"{doubt}\n{standing(result.model_copy(update={'doubt': None}), language)}"
    points_text = {"score": number(result.score or 0.0), "most": number(result.max_score)}
    if not result.needs_review:
        return in_language(language, "Points: {score} of {most}.", **points_text)
    return in_language(
        language,
        "Points so far: {score} of {most}. This is not final: a person will review the answers that could not be "
        "graded automatically (points: {open}).",
        **points_text,
        open=number(open_points(result)),
    )


def remark(item: Item, language: Language = "en") -> str:
    """Return the text about one answer: its status, how it was read or where reading stopped, and the feedback."""
    status = in_language(language, STATUSES[item.status])
    where = "" if item.column is None else in_language(language, " (column {column})", column=item.column)
    lines = [f"{status[0].upper()}{status[1:]}{where}."]
    stop = stop_of(item)
    if stop is not None:
        lines += stop.lines()
    if item.read_as:
        lines.append(in_language(language, "Read as: {text}", text=plain(item.read_as)))
    if item.feedback:
        lines.append(unmarked(plain(item.feedback)))
    if item.decided_by is not None:
        lines.append(in_language(language, "A person gave these points."))
    return "\n".join(lines)


class ReadingStop(NamedTuple):
    """The line of an answer in which reading stopped, split at that place."""

    before: str
    after: str

    def lines(self) -> list[str]:
        """Return the line, and below it a caret at the place.

        >>> ReadingStop("x + ", "zz = 1").lines()
        ['x + zz = 1', '    ^']
        """
        return [self.before + self.after, " " * len(self.before) + "^"]


def stop_of(item: Item) -> ReadingStop | None:
    """Return where reading of an answer stopped, with the characters around it, or None if it was read."""
    if item.answer is None or item.column is None:
        return None
    place = min(item.column - 1, len(item.answer))
    before, after = (plain(part).replace("\t", " ") for part in (item.answer[:place], item.answer[place:]))
    before, after = before.rpartition("\n")[2], after.partition("\n")[0]
    if len(before) > MOST_AROUND:
        before = f"...{before[3 - MOST_AROUND :]}"
    return ReadingStop(before, shortened(after, MOST_AROUND))


def unmarked(text: str) -> str:
    """Return feedback as plain text: names are in quotes instead of backquotes.

    >>> unmarked("`zz` is not declared")
    "'zz' is not declared"
    """
    return _MARKED_NAME.sub(r"'\1'", text)


def feedback(result: Result, language: Language = "en") -> str:
    """Return all texts about a submission as plain text."""
    answers = (f"{title(item)}: {points(item, language)}. {remark(item, language)}" for item in result.items)
    return "\n\n".join([standing(result, language), *answers])


def title(item: Item) -> str:
    """Return the name of an answer, ``PROBLEM.QUESTION``, on one line."""
    return f"{line(item.problem)}.{line(item.question)}"


def shortened(text: str, most: int) -> str:
    """Return at most ``most`` characters of a text, with dots at the end if it is cut.

    >>> shortened("abcdefgh", 5), shortened("abc", 5)
    ('ab...', 'abc')
    """
    return text if len(text) <= most else text[: most - 3] + "..."


class FileNames:
    """Distinct file names for submissions, valid on any file system for any names of students."""

    def __init__(self) -> None:
        self._taken = Counter[str]()

    def of(self, student: str) -> str:
        """Return a new name without a file extension.

        >>> names = FileNames()
        >>> names.of("ada"), names.of("ada"), names.of("../../etc").startswith("etc-")
        ('ada', 'ada-2', True)
        """
        name = stem(student)
        self._taken[name] += 1
        return name if self._taken[name] == 1 else f"{name}-{self._taken[name]}"


def stem(student: str) -> str:
    """Return a file name for a student: the student's name if it is a safe file name, else a part of it with a hash."""
    if _PLAIN.fullmatch(student) and not _MARKED.search(student) and not _RESERVED.match(student):
        return student
    mark = hashlib.sha256(student.encode("utf-8", "surrogatepass")).hexdigest()[:10]
    kept = re.sub(r"[^a-z0-9]+", "-", student.lower())[:40].strip("-")
    return f"{kept or 'student'}-{mark}"
