"""Texts that are the same up to the names of coordinates: one of them is read, the others are it in other names.

What the grammar makes of a word depends on what it means and on the space around it, and never on how a coordinate is
spelled: so much has to be the same. A word that could be read as a part of a number, of d^2x/dt^2 or of a derivative,
and all that is not plain (LaTeX, letters outside ASCII, unknown functions), is left to the grammar.
"""

from __future__ import annotations

import re
from collections.abc import Hashable
from typing import NamedTuple

from dofkit.expressions.renaming import MOVING
from dofkit.expressions.text.names import Lookup, Meaning

#: Longer texts are read by themselves: they may be too long.
LONGEST = 1000
_WORDS = re.compile(r"([A-Za-z][A-Za-z0-9_]*)", re.ASCII)
_UNUSUAL = re.compile(r"[\\{}$]|[^\x20-\x7e]")
#: Where a word goes on with a number: ``2e5``, ``0x1``.
_IN_A_NUMBER = re.compile(r"[0-9.]$", re.ASCII)


class Pattern(NamedTuple):
    """A text without the names of its coordinates, and these, in the order in which they first occur."""

    key: Hashable
    names: tuple[str, ...]


def pattern_of(text: str, lookup: Lookup) -> Pattern | None:
    """The pattern of a text; None where it has to be read by itself."""
    if len(text) > LONGEST or _UNUSUAL.search(text):
        return None
    parts: list[Hashable] = list(_WORDS.split(text))
    places: dict[str, int] = {}
    for i in range(1, len(parts), 2):
        word = str(parts[i])
        meaning = lookup.meaning(word)
        if meaning is None or meaning.kind not in ("value", "motion", "function") or word == "d":
            return None
        if word[0] in "eExXoObB" and _IN_A_NUMBER.search(str(parts[i - 1])):
            return None
        moving = _moving(meaning)
        if moving is not None:
            kind, name = moving
            parts[i] = (kind, places.setdefault(name, len(places)))
    return Pattern(tuple(parts), tuple(places))


def _moving(meaning: Meaning) -> tuple[str, str] | None:
    """The kind of a symbol that is called by a coordinate, and that name; None of another meaning."""
    e = meaning.expr
    if e is None or e.op != "sym" or e.args[0] not in MOVING:
        return None
    kind, name = e.args
    return kind, name
