"""The nearest known word: what a person probably meant."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Sequence

#: Words are compared with at most so many known ones.
_MOST_COMPARED = 2000
#: So many of them are listed.
_MOST_LISTED = 12
#: The least share of words that a name of several words has in common with the one that was meant.
_LEAST_SHARED = 0.4


def closest(word: str, known: Sequence[str], least: float = 0.6) -> str | None:
    """The known word most like ``word`` (Ratcliff and Obershelp), of a likeness of ``least`` or more, or None.

    >>> closest("thta", ["theta", "phi"])
    'theta'
    """
    found = difflib.get_close_matches(word, known, 1, least)
    return found[0] if found else None


def nearest(word: object, known: Iterable[str]) -> str | None:
    """The known name that looks most like ``word``, of about its length and in any case, or None.

    >>> nearest("lenght", ["between", "length"])
    'length'
    """
    word = str(word)
    near = [name for name in known if abs(len(name) - len(word)) <= 1 + len(word) // 2]
    same = (name for name in near if name.lower() == word.lower())
    return closest(word, near[:_MOST_COMPARED]) or next(same, None)


def guess(word: str, known: Iterable[str]) -> str:
    """`` (did you mean ...?)`` with the nearest of the ``known``, nothing where none is near."""
    near = nearest(word, known)
    return "" if near is None else f" (did you mean '{near}'?)"


def no_such(word: str, known: Iterable[str], what: str, plural: str = "") -> str:
    """A sentence for a ``word`` that is none of the ``known``: the nearest of them, and the first dozen.

    >>> no_such("exakt", ["count", "exact"], "method")
    "there is no method 'exakt' (did you mean 'exact'?): the methods are count, exact"
    """
    names = list(known)
    listed = ", ".join(names[:_MOST_LISTED]) + (", ..." if len(names) > _MOST_LISTED else "")
    return f"there is no {what} '{word}'{guess(word, names)}: the {plural or what + 's'} are {listed or 'none'}"


def nearest_title(name: str, known: Sequence[str]) -> str | None:
    """The known name of several words that looks most like ``name``, or shares most words with it, or None.

    >>> nearest_title("rolling-disc", ["disc-rolling", "pendulum"])
    'disc-rolling'
    """
    alike = closest(name, known)
    if alike is not None:
        return alike
    words = _words(name)
    shared = [(len(words & _words(other)) / len(words | _words(other)), other) for other in known]
    share, best = max(shared, key=lambda pair: pair[0], default=(0.0, ""))
    return best if share >= _LEAST_SHARED else None


def _words(name: str) -> set[str]:
    return set(re.split(r"[\W_]+", name.lower()))
