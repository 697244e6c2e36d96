"""Numbers with their nouns, as English wants them."""

from __future__ import annotations


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
