"""Choices that are the same on every machine: numbers made from a seed by a hash."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from typing import TypeVar

_T = TypeVar("_T")


class Stream:
    """Choices that depend on ``marks`` alone, such as a seed, a student and a problem, and on how many were made.

    >>> Stream("7", "ada").shuffled(range(9)) == Stream("7", "ada").shuffled(range(9))
    True
    >>> Stream("7", "ada").shuffled(range(9)) == Stream("7", "bob").shuffled(range(9))
    False
    """

    def __init__(self, *marks: object) -> None:
        self._mark = "\0".join(map(str, marks)).encode("utf-8", "surrogatepass")
        self._count = 0

    def below(self, bound: int) -> int:
        """A number from 0 up to ``bound``, that not included."""
        self._count += 1
        digest = hashlib.blake2b(self._mark, digest_size=8, salt=self._count.to_bytes(8, "big")).digest()
        return int.from_bytes(digest, "big") % bound

    def choice(self, options: Sequence[_T]) -> _T:
        """One of several."""
        return options[self.below(len(options))]

    def shuffled(self, options: Sequence[_T]) -> list[_T]:
        """All of them, in some order."""
        rest, found = list(options), []
        while rest:
            found.append(rest.pop(self.below(len(rest))))
        return found
