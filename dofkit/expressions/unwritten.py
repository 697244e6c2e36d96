"""A sequence of what holds expressions, written out when one of them is asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import TypeVar, overload

T = TypeVar("T")


class Unwritten(Sequence[T]):
    """``number`` of things that hold expressions, of which no two parts mention coordinates that are all different.

    ``mentioned``: the coordinates that they mention; ``longest``: no number in them has more bits; ``write`` makes
    them. It is equal to the sequence that it stands for, and a tuple in another process.
    """

    def __init__(self, number: int, mentioned: frozenset[str], longest: int, write: Callable[[], Iterable[T]]) -> None:
        self.number, self.mentioned, self.longest, self._write = number, mentioned, longest, write

    @cached_property
    def written(self) -> tuple[T, ...]:
        """All of them."""
        return tuple(self._write())

    def __len__(self) -> int:
        return self.number

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[T]: ...
    def __getitem__(self, index: int | slice) -> T | Sequence[T]:
        return self.written[index]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and self.written == tuple(other)

    def __hash__(self) -> int:
        return hash(self.written)

    def __reduce__(self) -> tuple[type[tuple[T, ...]], tuple[tuple[T, ...]]]:
        return tuple, (self.written,)
