"""What tells one answer from another in a review: a name of letters, which no spreadsheet takes for anything else.

It stands for the question and for what was answered, not for who did. Vowels and digits do not occur in it, so that it
is no number, no date, no formula and no word; its last letter tells one that was mistyped.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata

_LETTERS = "bcdfghjkmnpqrstvwxz"
_OF_QUESTION, _OF_ANSWER = 5, 10
_SHAPE = re.compile(f"([{_LETTERS}]{{{_OF_QUESTION}}})-([{_LETTERS}]{{{_OF_ANSWER}}})-([{_LETTERS}])")


def question_mark(problem: str, question: str) -> str:
    """The part of an identity that stands for the question.

    >>> question_mark("p", "f") != question_mark("p", "g")
    True
    """
    return _letters(_OF_QUESTION, problem, question)


def answer_id(problem: str, question: str, text: str, variant: str = "") -> str:
    """The identity of an answer; blanks tell nothing. ``variant``: of the problem, where students have different ones.

    >>> answer_id("p", "f", "x  = 1") == answer_id("p", "f", " x = 1\\n") != answer_id("p", "f", "x = 2")
    True
    """
    said = " ".join(unicodedata.normalize("NFC", text).split())
    body = f"{question_mark(problem, question)}-{_letters(_OF_ANSWER, problem, question, variant, said)}"
    return f"{body}-{_letters(1, body)}"


def mark_of(identity: str) -> str | None:
    """The question's part of an identity; None of what is none.

    >>> mark_of(answer_id("p", "f", "1")) == question_mark("p", "f"), mark_of("bcdfg-bcdfghjkmn-x")
    (True, None)
    """
    found = _SHAPE.fullmatch(identity)
    if found is None or _letters(1, f"{found[1]}-{found[2]}") != found[3]:
        return None
    return found[1]


def _letters(count: int, *parts: str) -> str:
    data = "\0".join(parts).encode("utf-8", "surrogatepass")
    number = int.from_bytes(hashlib.blake2b(data, digest_size=16).digest(), "big")
    return "".join(_LETTERS[number // len(_LETTERS) ** i % len(_LETTERS)] for i in range(count))
