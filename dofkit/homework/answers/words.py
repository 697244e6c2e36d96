"""Answers in words: numbers, names and labels, as people write them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from pydantic_core import PydanticCustomError

from dofkit.base.errors import TextError
from dofkit.base.spelling import nearest
from dofkit.expressions.text import Names, parse_relations, spelled
from dofkit.scene.fields import as_written, exact

#: No answer is read beyond this.
MOST_CHARACTERS = 2000
_SEPARATORS = re.compile(r"[,;\s]+(?:and|und|&)[,;\s]+|[,;\s]+|\s*&\s*")
_COUNTED = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")
_NUMBERS = {word: n for n, word in enumerate(_COUNTED)}
_LEADING = re.compile(r"\s*(?:(?:it|there|the\s+system|the\s+answer)\s+(?:has|is|are)\s+)?", re.IGNORECASE)
_TRAILING = re.compile(
    r"\s*(?:d\.?o\.?f\.?s?|degrees?(?:\s+of\s+freedom)?|equations?|constraints?)?\s*[.!]?\s*", re.IGNORECASE
)
_CHAIN = re.compile(r"==|=|≈|:")
NONE = frozenset({"none", "no", "nothing", "keine", "keiner", "-", "--", "—", "{}", "[]", "∅", "empty"})


def one_text(answer: object) -> str:
    """The text of an answer that should be one; raises TextError for lists and the like."""
    if isinstance(answer, bool) or not isinstance(answer, (str, int, float, Fraction)):
        raise TextError("one number or text is needed here", 1, "write a single answer")
    text = answer if isinstance(answer, str) else _number_text(answer)
    if len(text) > MOST_CHARACTERS:
        raise TextError(f"the answer has {len(text)} characters", MOST_CHARACTERS + 1, f"at most {MOST_CHARACTERS}")
    return text


def _number_text(answer: float | Fraction) -> str:
    try:
        return as_written(exact(answer))
    except (PydanticCustomError, ArithmeticError, ValueError):
        raise TextError(f"'{str(answer)[:40]}' is no number", 1, "write a number such as 3") from None


def number(answer: object) -> Fraction:
    """The number of an answer: ``4``, ``4.0``, ``f = 4``, ``f = 6 - 2 = 4``, ``four degrees of freedom``.

    Raises TextError, with its column.
    """
    text = one_text(answer)
    start = _LEADING.match(text)
    before = start.end() if start else 0
    body = text[before:]
    end = len(body)
    for match in _TRAILING.finditer(body):
        if match.end() == len(body):
            end = match.start()
            break
    cut = [m.end() for m in _CHAIN.finditer(body[:end])]
    first = cut[-1] if cut else 0
    piece = body[first:end]
    word = piece.strip().lower()
    if word in _NUMBERS:
        return Fraction(_NUMBERS[word])
    return _arithmetic(piece, before + first)


def _arithmetic(text: str, before: int) -> Fraction:
    try:
        found = parse_relations(text, Names(allow_time=False, allow_velocities=False))
    except TextError as error:
        column = None if error.column is None else error.column + before
        raise TextError(error.message, column, "write a number such as 3") from None
    value = found[0].left
    if len(found) > 1 or value.op != "num" or not isinstance(value.args[0], Fraction):
        raise TextError("this is no number", before + 1, "write a number such as 3")
    return value.args[0]


@dataclass(frozen=True)
class Word:
    """One of several words, and its column from 1."""

    text: str
    column: int


def split_words(answer: object) -> list[Word]:
    """The words of an answer: a list, or a text with commas, semicolons, spaces or "and" between them."""
    if isinstance(answer, Sequence) and not isinstance(answer, str):
        return [Word(one_text(part).strip(), 1) for part in answer]
    return list(_words(one_text(answer)))


def _words(text: str) -> Iterator[Word]:
    stripped = text.strip()
    for opening, closing in ("{}", "[]", "()"):
        if stripped.startswith(opening) and stripped.endswith(closing):
            stripped = stripped[1:-1].strip()
    start = text.index(stripped) if stripped else 0
    body = text[start : start + len(stripped)]
    place = 0
    for cut in _SEPARATORS.finditer(body):
        if cut.start() > place:
            yield Word(body[place : cut.start()], start + place + 1)
        place = cut.end()
    if place < len(body):
        yield Word(body[place:].rstrip("."), start + place + 1)


def is_none(words: Sequence[Word]) -> bool:
    """Is the answer that there are none?"""
    return not words or (len(words) == 1 and words[0].text.lower().rstrip(".") in NONE)


def chosen(words: Iterable[Word], known: Sequence[str], what: str) -> list[str]:
    """The known names that the words are, each once; Greek letters and their spelled names are the same.

    Letters' case matters only where it tells names apart.

    Raises TextError for a word that is none, with its column and the nearest name.
    """
    exact_names = {spelled(one): one for one in known}
    lower: dict[str, str | None] = {}
    for one, name in exact_names.items():
        lower[one.lower()] = None if one.lower() in lower else name
    found: dict[str, None] = {}
    for word in words:
        text = spelled(word.text)
        meant = exact_names.get(text, lower.get(text.lower()))
        if meant is None:
            near = nearest(word.text, known)
            hint = f"did you mean '{near}'?" if near else f"the {what}s are {', '.join(known[:12])}"
            raise TextError(f"there is no {what} '{word.text[:40]}'", word.column, hint)
        found[meant] = None
    return list(found)
