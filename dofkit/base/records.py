"""Dataclasses that cost little to import: what they have in common is shared, not written and compiled for each class.

Python makes six methods of its own for every frozen dataclass, each time a program starts: for some two hundred classes
that was a tenth of a cold start. Here only ``__init__`` is made so; comparison, hash and text are the same for all of
them. That nothing is assigned to a field of a frozen class is for the type checker to see, which sees it everywhere.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from operator import attrgetter
from typing import TYPE_CHECKING, Any

__all__ = ["dataclass"]


def _record(cls: Any, frozen: bool = False, eq: bool = True) -> Any:
    """What `dataclasses.dataclass` makes of a class."""
    written = "__repr__" in vars(cls)
    made: Any = dataclasses.dataclass(repr=False, eq=False)(cls)
    if not written:
        made.__repr__ = _text
    if eq:
        _add_comparison(made, frozen)
    return made


def _add_comparison(made: Any, hashed: bool) -> None:
    """Equal are records of one class with equal fields; ``hashed``: their hash is that of their fields."""
    names = [f.name for f in dataclasses.fields(made) if f.compare]
    told: Callable[[Any], Any] = attrgetter(*names, *names[: len(names) == 1]) if names else _nothing

    def equal(self: Any, other: object) -> bool:
        return told(self) == told(other) if other.__class__ is self.__class__ else NotImplemented

    def digest(self: Any) -> int:
        return hash(told(self))

    own = vars(made)
    explicit = own.get("__hash__") is not None
    if "__eq__" not in own:
        made.__eq__ = equal
    if not explicit:
        made.__hash__ = digest if hashed else None


def _nothing(record: object) -> tuple[()]:
    """The compared fields of a class without any."""
    del record
    return ()


def _text(self: Any) -> str:
    """A record as it is written."""
    shown = ", ".join(f"{f.name}={getattr(self, f.name)!r}" for f in dataclasses.fields(self) if f.repr)
    return f"{type(self).__qualname__}({shown})"


if TYPE_CHECKING:
    from dataclasses import dataclass
else:

    def dataclass(cls: Any = None, /, *, slots: bool = False, **how: bool) -> Any:
        """A class of fields, with what comes of them: as `dataclasses.dataclass`, whose arguments it takes."""
        if slots:
            return dataclasses.dataclass(slots=True, **how)
        return (lambda cls: _record(cls, **how)) if cls is None else _record(cls)
