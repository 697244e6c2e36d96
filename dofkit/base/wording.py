"""Words for messages, and checks of what is given from outside.

Numbers with their nouns, the nearest known word to one that is misspelt, a name of a list, seconds, an ending.
"""

from __future__ import annotations

import difflib
import math
import re
import reprlib
from collections.abc import Collection, Iterable, Sequence
from numbers import Real
from pathlib import Path

from dofkit.base.errors import ArgumentError

#: A ratio beyond which the rank of a numeric matrix is taken as certain in words.
UNAMBIGUOUS = 1e12
#: Words are compared with at most so many known ones.
_MOST_COMPARED = 2000
#: A shorter beginning of a known word does not stand for it.
SHORTEST_BEGINNING = 3
#: So many of them are listed.
_MOST_LISTED = 12
#: The least share of words that a name of several words has in common with the one that was meant.
_LEAST_SHARED = 0.4


def many(number: int, what: str) -> str:
    """Return a number of things in words.

    >>> many(1, "equation"), many(2, "body"), many(0, "link")
    ('1 equation', '2 bodies', '0 links')
    """
    if number == 1:
        return f"1 {what}"
    ends_in_y = what.endswith("y") and what[-2:-1] not in "aeiou"
    return f"{number} {what[:-1]}ies" if ends_in_y else f"{number} {what}s"


def verb(number: int, singular: str = "is", plural: str = "are") -> str:
    """Return the verb for a number of things.

    >>> verb(1), verb(3, "has", "have")
    ('is', 'have')
    """
    return singular if number == 1 else plural


def series(words: Sequence[str]) -> str:
    """Return words as a series.

    >>> series(["1", "2", "3"]), series(["2", "3"]), series(["3"])
    ('1, 2 and 3', '2 and 3', '3')
    """
    return " and ".join([part for part in (", ".join(words[:-1]), *words[-1:]) if part])


def sentence(text: str) -> str:
    """Return a text with a capital letter, and with a full stop unless it has an end.

    >>> sentence("it moves"), sentence("Does it move?")
    ('It moves.', 'Does it move?')
    """
    return f"{text[:1].upper()}{text[1:]}{'' if text.endswith(('.', ':', '?')) else '.'}"


def first_of(names: Iterable[str], most: int) -> str:
    """Return the first of some names, and how many more there are.

    >>> first_of(["a", "b", "c"], 2)
    'a, b and 1 more'
    """
    listed = list(names)
    return ", ".join(listed[:most]) + (f" and {len(listed) - most} more" if len(listed) > most else "")


def gap_in_words(gap: float, what: str) -> str:
    """Return a sentence about the ratio that separates the numbers that are kept from those that are taken as zero.

    >>> gap_in_words(2.34e4, "pivot")
    'the smallest pivot that is kept is about 23000 times the largest that is taken as zero'
    >>> gap_in_words(1.1e108, "pivot")
    'the rank is unambiguous: no pivot that is kept is below 10^12 times one that is taken as zero'
    """
    if gap > UNAMBIGUOUS:
        return f"the rank is unambiguous: no {what} that is kept is below 10^12 times one that is taken as zero"
    digits = float(f"{gap:.1e}")
    return f"the smallest {what} that is kept is about {digits:.0f} times the largest that is taken as zero"


def closest(word: str, vocabulary: Sequence[str], least: float = 0.6) -> str | None:
    """Return the known word most like ``word`` (Ratcliff and Obershelp), at least ``least`` alike, or None.

    >>> closest("thta", ["theta", "phi"])
    'theta'
    """
    return next(iter(difflib.get_close_matches(word, vocabulary, 1, least)), None)


def nearest(word: object, vocabulary: Iterable[str]) -> str | None:
    """Return the known name most like ``word``, of about its length, in any case, or that it abbreviates; or None.

    >>> nearest("lenght", ["between", "length"])
    'length'
    """
    word, names = str(word), list(vocabulary)
    near = [name for name in names if abs(len(name) - len(word)) <= 1 + len(word) // 2]
    same = (name for name in near if name.lower() == word.lower())
    longer = [name for name in names if len(word) >= SHORTEST_BEGINNING and name.startswith(word.lower())]
    return closest(word, near[:_MOST_COMPARED]) or next(same, longer[0] if len(longer) == 1 else None)


def guess(word: str, vocabulary: Iterable[str]) -> str:
    """Return `` (did you mean ...?)`` with the nearest known word, or an empty text where none is near."""
    near = nearest(word, vocabulary)
    return "" if near is None else f" (did you mean '{near}'?)"


def no_such(word: str, vocabulary: Iterable[str], what: str) -> str:
    """Return a sentence about a ``word`` that is unknown, with the nearest known word and the first dozen.

    >>> no_such("exakt", ["count", "exact"], "method")
    "there is no method 'exakt' (did you mean 'exact'?): the methods are count, exact"
    """
    names = list(vocabulary)
    listed = ", ".join(names[:_MOST_LISTED]) + (", ..." if len(names) > _MOST_LISTED else "")
    return f"there is no {what} '{word}'{guess(word, names)}: the {what}s are {listed or 'none'}"


def nearest_title(name: str, titles: Sequence[str]) -> str | None:
    """Return the title, of one or more words, that is spelled most like ``name`` or shares most words with it, or None.

    >>> nearest_title("rolling-disc", ["disc-rolling", "pendulum"])
    'disc-rolling'
    """
    alike = closest(name, titles)
    if alike is not None:
        return alike
    words = _words(name)
    shared = [(len(words & _words(other)) / len(words | _words(other)), other) for other in titles]
    share, best = max(shared, key=lambda pair: pair[0], default=(0.0, ""))
    return best if share >= _LEAST_SHARED else None


def _words(name: str) -> set[str]:
    return set(re.split(r"[\W_]+", name.lower()))


def description_of(value: object) -> str:
    """Return a value on one short line, with its type.

    >>> description_of(["x"]), description_of(None)
    ("['x'] (a list)", 'None')
    """
    if value is None:
        return "None"
    name = type(value).__name__
    return f"{' '.join(reprlib.repr(value).split())} ({'an' if name[0] in 'aeiouAEIOU' else 'a'} {name})"


def require_one_of(value: object, vocabulary: Iterable[str], what: str) -> None:
    """Raise ArgumentError for a value that is none of the known names; it suggests the nearest and lists all.

    >>> require_one_of("exact", ["count", "exact"], "method")
    """
    names = list(vocabulary)
    if not isinstance(value, str):
        raise ArgumentError(f"a {what} is one of {', '.join(names)}, not {description_of(value)}")
    if value not in names:
        raise ArgumentError(no_such(value, names, what))


def seconds_of(budget: object) -> float:
    """Return a budget in seconds, not below 0. Raises ArgumentError where it is no number.

    >>> seconds_of(-2), seconds_of(1.5)
    (0.0, 1.5)
    """
    if not isinstance(budget, Real) or isinstance(budget, bool) or math.isnan(budget):
        raise ArgumentError(f"the budget is a number of seconds, not {description_of(budget)}")
    return max(0.0, float(budget))


def is_folder_path(path: Path) -> bool:
    """Return whether a path names a folder: one that exists, or a name without an ending.

    >>> is_folder_path(Path("results")), is_folder_path(Path("results.csv"))
    (True, False)
    """
    return path.is_dir() or not path.suffix or path.suffix[1:].isdigit()


def format_of_path(path: Path, formats: Collection[str], asked: str | None = None) -> str:
    """Return the format of the file that is written to a path: its ending decides.

    ``formats``: the formats, which are the endings without the dot; none where only a folder can be written. ``asked``:
    the format that was asked for besides. Raises ArgumentError where the ending is unknown or contradicts that format.

    >>> format_of_path(Path("sheet.pdf"), ["html", "pdf"])
    'pdf'
    """
    ending = path.suffix.lower()
    if not formats:
        raise ArgumentError(
            f"'{path}' has the ending of a file, but a folder is written: give a name without an ending"
        )
    if not ending and asked is not None:
        return asked
    if not ending:
        raise ArgumentError(f"'{path}' has no ending: name a file that ends in .{', .'.join(formats)}")
    if ending[1:] not in formats:
        raise ArgumentError(f"'{path}': {no_such(ending, [f'.{name}' for name in formats], 'ending')}")
    if asked not in (None, ending[1:]):
        other = path.with_suffix(f".{asked}")
        raise ArgumentError(
            f"'{path}' ends in {ending}, but --format asks for {asked}: leave out --format, or write to '{other}'"
        )
    return ending[1:]
