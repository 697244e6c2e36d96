"""Records do what Python's own dataclasses do: every class here is made both ways, and told apart by nothing."""

from __future__ import annotations

import dataclasses
import pickle
from collections.abc import Callable
from typing import Any

import pytest

from dofkit.base.records import dataclass

Decorator = Callable[..., Any]


def point(made: Decorator) -> Any:
    @made(frozen=True)
    class Point:
        x: int
        name: str = "P"
        near: list[int] = dataclasses.field(default_factory=list, compare=False)
        kept: int = dataclasses.field(default=0, repr=False, init=False)

    return Point


def alone(made: Decorator) -> Any:
    @made(frozen=True)
    class Alone:
        x: Any

    return Alone


def empty(made: Decorator) -> Any:
    @made(frozen=True)
    class Empty:
        """Nothing in it."""

    return Empty


def changing(made: Decorator) -> Any:
    @made
    class Changing:
        x: int
        y: int = 2

    return Changing


def by_identity(made: Decorator) -> Any:
    @made(frozen=True, eq=False)
    class Same:
        x: int

    return Same


def own_ways(made: Decorator) -> Any:
    @made(frozen=True)
    class Own:
        x: int

        def __eq__(self, other: object) -> bool:
            return isinstance(other, int)

        def __hash__(self) -> int:
            return 7

        def __repr__(self) -> str:
            return "own"

    return Own


CLASSES = (point, alone, empty, changing, by_identity, own_ways)


def told(cls: Any) -> list[Any]:
    """What can be seen of a class and of some of its objects."""
    count = len([f for f in dataclasses.fields(cls) if f.init and f.default_factory is dataclasses.MISSING])
    some = [cls(*values[:count]) for values in ((1, "P"), (1, "Q"), (2, "P"))]
    equal = [[a == b for b in (*some, 1, None)] for a in some]
    hashes = [None if cls.__hash__ is None else [hash(a) == hash(b) for b in some] for a in some]
    again = [dataclasses.replace(a) == a for a in some]
    names = [(f.name, f.compare, f.repr) for f in dataclasses.fields(cls)]
    return [equal, hashes, again, names, cls.__match_args__, [repr(a).rpartition("<locals>.")[2][:20] for a in some]]


@pytest.mark.parametrize("make", CLASSES, ids=lambda make: make.__name__)
def test_a_record_is_what_python_makes(make: Callable[[Decorator], Any]) -> None:
    ours, theirs = told(make(dataclass)), told(make(dataclasses.dataclass))
    if make is by_identity:  # its text ends with an address
        ours, theirs = ours[:-1], theirs[:-1]
    assert ours == theirs


def test_one_that_is_not_equal_to_itself_is_compared_as_in_a_tuple() -> None:
    nan, kind = float("nan"), alone(dataclass)
    assert kind(nan) == kind(nan)
    assert kind(nan) != kind(float("nan"))


def test_another_class_with_the_same_fields_is_another() -> None:
    assert alone(dataclass)(1) != alone(dataclass)(1)


@dataclass(frozen=True)
class Wide:
    x: int


@dataclass(frozen=True)
class Wider(Wide):
    y: int


def test_fields_of_a_base_count() -> None:
    assert Wider(1, 2) == Wider(1, 2) != Wider(3, 2)
    assert Wider(1, 2) != Wide(1)
    assert {Wider(1, 2): "known"}[pickle.loads(pickle.dumps(Wider(1, 2)))] == "known"
    assert repr(Wider(1, 2)) == "Wider(x=1, y=2)"
