"""What an open answer may mean: the nearest text that can be read, by a repair its error hints at, or what is in it.

This earns nothing by itself: it is shown to the student, and to the person who decides.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from dofkit.base.errors import TextError
from dofkit.homework.judgement import DoubtError, JudgedReading, Judgement

#: Repairs that are made one after the other, and characters of a text that are worth one.
MOST_REPAIRS, MOST_CHARACTERS = 3, 300
_MEANT = re.compile(r"did you mean [`'](?P<word>[^`']+)[`']\?|type `(?P<char>.)` instead")
_WORD = re.compile(r"\\?\w+(?:_\{\w+\})?|\S")
#: A rest of words, which is read over; one with numbers or signs says something of its own.
_PROSE = re.compile(r"[\s,;:.!?()'’-]*(?:[^\W\d_]{2,}[\s,;:.!?()'’-]*){1,40}")
#: Numbers in an answer; of more than so many none is more likely than the others.
_NUMBER, MOST_PARTS = re.compile(r"(?<![\w.,])-?\d{1,4}(?![\w.,]*\d)"), 4
_CLOSING = {"(": ")", "[": "]", "{": "}"}


def nearest_reading(answer: object, error: TextError, judge: Callable[[str], Judgement]) -> JudgedReading | None:
    """What a text that cannot be read would be read as, and what that is worth; None where no repair is known.

    ``error``: why it cannot be read; ``judge`` raises TextError of a text that cannot be read either.
    """
    if not isinstance(answer, str) or len(answer) > MOST_CHARACTERS:
        return None
    tried = {answer}
    text, fault = answer, error
    for _ in range(MOST_REPAIRS):
        for repaired in [one for one in _repaired(text, fault) if one not in tried]:
            tried.add(repaired)
            try:
                found = judge(repaired)
            except DoubtError:
                continue
            except TextError as further:
                if (further.column or 0) > (fault.column or 0):
                    text, fault = repaired, further
                    break
                continue
            return JudgedReading(found.read_as, found.share)
        else:
            return None
    return None


def parts_read(answer: object, numbers: bool, judge: Callable[[str], Judgement]) -> tuple[JudgedReading, ...]:
    """What an answer in doubt may mean, each with its worth: its ``numbers``, or all of it without question marks."""
    if not isinstance(answer, str) or len(answer) > MOST_CHARACTERS:
        return ()
    if numbers:
        texts = list(dict.fromkeys(_NUMBER.findall(answer)))
    else:
        texts = [answer.replace("?", " ")] if "?" in answer else []
    found: dict[JudgedReading, None] = {}
    for text in texts if len(texts) <= MOST_PARTS else ():
        try:
            judged = judge(text)
        except TextError:
            continue
        if judged.read_as:
            found[JudgedReading(judged.read_as, judged.share)] = None
    return tuple(found)


def _repaired(text: str, error: TextError) -> Iterator[str]:
    """Texts that may have been meant, the likeliest first."""
    start = (error.column or 1) - 1
    before, after = text[:start], text[start:]
    word = _WORD.match(after)
    meant = _MEANT.search(error.hint or "")
    if meant is not None and word is not None:
        yield before + (meant["word"] or meant["char"]) + after[word.end() :]
    if error.hint == "delete it":
        yield before + after[1:]
    if (closing := _missing(text)) is not None:
        yield text + closing
    if before.strip() and _PROSE.fullmatch(after):
        yield before.rstrip(" ,;:.-(")


def _missing(text: str) -> str | None:
    """The brackets that were never closed; None where that is none or brackets do not fit."""
    waiting: list[str] = []
    for char in text:
        if char in _CLOSING:
            waiting.append(_CLOSING[char])
        elif char in _CLOSING.values() and (not waiting or waiting.pop() != char):
            return None
    return "".join(reversed(waiting)) if 0 < len(waiting) <= MOST_REPAIRS else None
