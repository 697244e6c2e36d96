"""Words for messages, and checks of arguments of public functions.

Numbers with their nouns, the known word nearest to a misspelt one, budgets in seconds, formats by file extension.
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

#: The ratio beyond which `gap_in_words` calls a numeric rank unambiguous.
UNAMBIGUOUS = 1e12
#: A word is compared with at most this many known words.
_MOST_COMPARED = 2000
#: The least number of letters with which a word can be abbreviated.
SHORTEST_BEGINNING = 3
#: The most words that a message lists.
_MOST_LISTED = 12
#: The least share of common words for which `nearest_title` suggests a title.
_LEAST_SHARED = 0.4


def many(number: int, what: str) -> str:
    """Return a number, in digits, with its noun ``what`` in the singular or plural.

    >>> many(1, "equation"), many(2, "body"), many(0, "link")
    ('1 equation', '2 bodies', '0 links')
    """
    if number == 1:
        return f"1 {what}"
    ends_in_y = what.endswith("y") and what[-2:-1] not in "aeiou"
    return f"{number} {what[:-1]}ies" if ends_in_y else f"{number} {what}s"


def verb(number: int, singular: str = "is", plural: str = "are") -> str:
    """Return the form of a verb that goes with ``number``.

    >>> verb(1), verb(3, "has", "have")
    ('is', 'have')
    """
    return singular if number == 1 else plural


def series(words: Sequence[str]) -> str:
    """Return words separated by commas, the last by "and".

    >>> series(["1", "2", "3"]), series(["2", "3"]), series(["3"])
    ('1, 2 and 3', '2 and 3', '3')
    """
    return " and ".join([part for part in (", ".join(words[:-1]), *words[-1:]) if part])


def sentence(text: str) -> str:
    """Return a text with a capital letter, and with a full stop unless it ends with punctuation.

    >>> sentence("it moves"), sentence("Does it move?")
    ('It moves.', 'Does it move?')
    """
    return f"{text[:1].upper()}{text[1:]}{'' if text.endswith(('.', ':', '?')) else '.'}"


def first_of(names: Iterable[str], most: int) -> str:
    """Return the first ``most`` of the names as text, and how many more there are.

    >>> first_of(["a", "b", "c"], 2)
    'a, b and 1 more'
    """
    listed = list(names)
    return ", ".join(listed[:most]) + (f" and {len(listed) - most} more" if len(listed) > most else "")


def gap_in_words(gap: float, what: str) -> str:
    """Return a sentence about ``gap``, the ratio of the smallest ``what`` kept to the largest taken as zero.

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
    """Return the known word most similar to ``word`` (Ratcliff and Obershelp), with similarity >= ``least``, or None.

    >>> closest("thta", ["theta", "phi"])
    'theta'
    """
    return next(iter(difflib.get_close_matches(word, vocabulary, 1, least)), None)


def nearest(word: object, vocabulary: Iterable[str]) -> str | None:
    """Return the known name of similar length most similar to ``word``, or the only one that it abbreviates, or None.

    >>> nearest("lenght", ["between", "length"])
    'length'
    """
    word, names = str(word), list(vocabulary)
    near = [name for name in names if abs(len(name) - len(word)) <= 1 + len(word) // 2]
    same = (name for name in near if name.lower() == word.lower())
    longer = [name for name in names if len(word) >= SHORTEST_BEGINNING and name.startswith(word.lower())]
    return closest(word, near[:_MOST_COMPARED]) or next(same, longer[0] if len(longer) == 1 else None)


def guess(word: str, vocabulary: Iterable[str]) -> str:
    """Return `` (did you mean ...?)`` with the nearest known word, or an empty text if none is near."""
    near = nearest(word, vocabulary)
    return "" if near is None else f" (did you mean '{near}'?)"


def no_such(word: str, vocabulary: Iterable[str], what: str) -> str:
    """Return a message that there is no ``what`` called ``word``, with the nearest known word and the first dozen.

    >>> no_such("exakt", ["count", "exact"], "method")
    "there is no method 'exakt' (did you mean 'exact'?): the methods are count, exact"
    """
    names = list(vocabulary)
    listed = ", ".join(names[:_MOST_LISTED]) + (", ..." if len(names) > _MOST_LISTED else "")
    return f"there is no {what} '{word}'{guess(word, names)}: the {what}s are {listed or 'none'}"


def nearest_title(name: str, titles: Sequence[str]) -> str | None:
    """Return the title that is spelled most like ``name``, else the one with most words in common, or None.

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
    """Return a short description of a value, with its type.

    >>> description_of(["x"]), description_of(None)
    ("['x'] (a list)", 'None')
    """
    if value is None:
        return "None"
    name = type(value).__name__
    return f"{' '.join(reprlib.repr(value).split())} ({'an' if name[0] in 'aeiouAEIOU' else 'a'} {name})"


def require_one_of(value: object, vocabulary: Iterable[str], what: str) -> None:
    """Raise ArgumentError if ``value`` is not one of ``vocabulary``, with the nearest name and a list.

    >>> require_one_of("exact", ["count", "exact"], "method")
    """
    names = list(vocabulary)
    if not isinstance(value, str):
        raise ArgumentError(f"a {what} is one of {', '.join(names)}, not {description_of(value)}")
    if value not in names:
        raise ArgumentError(no_such(value, names, what))


def seconds_of(budget: object) -> float:
    """Return a budget in seconds, at least 0. Raises ArgumentError if it is not a number.

    >>> seconds_of(-2), seconds_of(1.5)
    (0.0, 1.5)
    """
    if not isinstance(budget, Real) or isinstance(budget, bool) or math.isnan(budget):
        raise ArgumentError(f"the budget is a number of seconds, not {description_of(budget)}")
    return max(0.0, float(budget))


def is_folder_path(path: Path) -> bool:
    """Return whether a path means a folder: it is one, or it has no file extension (or a number as one).

    >>> is_folder_path(Path("results")), is_folder_path(Path("results.csv"))
    (True, False)
    """
    return path.is_dir() or not path.suffix or path.suffix[1:].isdigit()


def format_of_path(path: Path, formats: Collection[str], asked: str | None = None) -> str:
    """Return the format of the file to be written to ``path``, by its extension.

    ``formats``: the possible formats, which are extensions without the dot (empty: only a folder can be written);
    ``asked``: the format of the option --format. Raises ArgumentError if the extension is unknown or differs from it.

    >>> format_of_path(Path("sheet.pdf"), ["html", "pdf"])
    'pdf'
    """
    ending = path.suffix.lower()
    if not formats:
        raise ArgumentError(f"'{path}' has a file extension, but a folder is written: give a name without an ending")
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
