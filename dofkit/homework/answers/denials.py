"""Recognizes answers that nothing of the kind exists (no integral, no redundant constraint), in six languages."""

from __future__ import annotations

import re
from collections.abc import Collection

from dofkit.homework.answers.prose import FILLING, REASONS, YES, pattern, plain, rewriting, word_list

#: Whole answers which say that there is none, besides sentences of the words below; a dash alone is no answer.
NONE = word_list("denials: none")
#: Separators between the parts of an answer.
_PARTS = r"[,;:(\n]| - | – | — "
_ANDS = r"\s(?:and|und|et|y|e|but|aber|mais|pero|ma|mas)\s"
#: In a sentence of listed words only, one denial says that there is none; two cancel each other.
_DENIALS = word_list("denials: denials")
#: In Romance languages these accompany a denial, or deny alone.
_WITH_DENIALS = word_list("denials: with_denials")
_NONES = word_list("denials: nones")
#: What is denied, by the beginning of the word; a prefix is a denial as well.
_DENIED = pattern("denials: denied")
_AROUND = word_list("denials: around")
_EVERY = word_list("denials: every")
_NEEDED = pattern("denials: needed")
_CONTRACTED = rewriting("denials: contracted")


def says_none(text: str, vocabulary: Collection[str] = (), every: bool = False) -> bool:
    """Return whether a text says that nothing of the kind exists.

    ``vocabulary``: declared names, which are not words; ``every``: whether `all are needed` says it as well.
    """
    lowered = plain(REASONS.split(text, maxsplit=1)[0])
    first = plain(re.split(_PARTS, lowered, maxsplit=1)[0])
    names = {plain(name) for name in vocabulary}
    return any(_denies(part, names) or (every and _needs_all(part, names)) for part in (lowered, first))


def beside_none(text: str) -> list[str]:
    """Return the other parts of a text if one part says that there is none, without reasons; else an empty list.

    >>> beside_none("y = C x, not integrable"), beside_none("y = C x"), beside_none("none")
    (['y = C x'], [], [])
    """
    pieces = [part.strip(" ()") for part in re.split(rf"{_PARTS}|{_ANDS}", REASONS.split(text, maxsplit=1)[0])]
    denied = [part for part in pieces if _denies(plain(part)) and re.search(r"[^\W\d_]", part)]
    return [part for part in pieces if part and part not in denied] if denied else []


def affirms(part: str) -> bool:
    """Return whether a part of an answer says yes, or affirms the question: `it is integrable`."""
    tokens = _tokens(plain(part))
    return plain(part) in YES or (bool(tokens) and _closed(tokens) and _denial(tokens) == 0 and _names_it(tokens))


def _denies(lowered: str, names: Collection[str] = ()) -> bool:
    """Return whether a lower-case text says that there is none, by a listed phrase or by listed words only."""
    if lowered in NONE:
        return True
    tokens = _tokens(lowered)
    if not tokens or not _closed(tokens) or not _EVERY.isdisjoint(tokens) or any(w in names for w in tokens):
        return False
    return _denial(tokens) == 1 and (_names_it(tokens) or not _NONES.isdisjoint(tokens))


def _needs_all(lowered: str, names: Collection[str]) -> bool:
    """Return whether a text says that all are needed: `all are needed`, `alle sind unabhängig`."""
    tokens = _tokens(lowered)
    whole = bool(tokens) and _closed(tokens) and not _EVERY.isdisjoint(tokens) and not any(w in names for w in tokens)
    return whole and _denial(tokens) == 0 and any(_NEEDED.match(w) for w in tokens)


def _tokens(lowered: str) -> list[str]:
    """Return the words of a text; an empty list if it contains anything else, such as digits."""
    for contraction, by in _CONTRACTED:
        lowered = contraction.sub(by, lowered)
    return [] if re.search(r"[^\w\s'’.,-]|\d|_", lowered) else re.findall(r"[^\W\d_]+(?:-[^\W\d_]+)*", lowered)


def _names_it(tokens: list[str]) -> bool:
    return any(_DENIED.fullmatch(w) for w in tokens)


def _closed(tokens: list[str]) -> bool:
    """Return whether all words are in the word lists of this module."""
    vocabulary = _DENIALS | _WITH_DENIALS | _AROUND | _EVERY | FILLING
    return all(w in vocabulary or _DENIED.fullmatch(w) or _NEEDED.match(w) for w in tokens)


def _denial(tokens: list[str]) -> int:
    """Return the number of denials."""
    prefixed = sum(1 for w in tokens if (m := _DENIED.fullmatch(w)) and m["prefix"])
    denied = sum(w in _DENIALS for w in tokens)
    return prefixed + (denied or int(any(w in _WITH_DENIALS for w in tokens)))
