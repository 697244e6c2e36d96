"""Numbers with their nouns, as English wants them."""

from __future__ import annotations

from collections.abc import Sequence

#: A ratio beyond which the rank of a numeric matrix is taken as certain in words.
UNAMBIGUOUS = 1e12


def many(number: int, what: str) -> str:
    """A number of things.

    >>> many(1, "equation"), many(2, "body"), many(0, "link")
    ('1 equation', '2 bodies', '0 links')
    """
    if number == 1:
        return f"1 {what}"
    ends_in_y = what.endswith("y") and what[-2:-1] not in "aeiou"
    return f"{number} {what[:-1]}ies" if ends_in_y else f"{number} {what}s"


def verb(number: int, one: str = "is", several: str = "are") -> str:
    """The verb for a number of things.

    >>> verb(1), verb(3, "has", "have")
    ('is', 'have')
    """
    return one if number == 1 else several


def series(words: Sequence[str]) -> str:
    """Return words as a series.

    >>> series(["1", "2", "3"]), series(["2", "3"]), series(["3"])
    ('1, 2 and 3', '2 and 3', '3')
    """
    return " and ".join([part for part in (", ".join(words[:-1]), *words[-1:]) if part])


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
