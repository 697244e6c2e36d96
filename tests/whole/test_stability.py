"""Scenes whose truth is known by how they are made: no answer is wrong, and few are left open, by name and with why."""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction
from functools import cache
from zlib import crc32

import pytest
from shared.families import FAMILIES
from shared.known_scenes import swept
from shared.trials import differences

import dofkit
from dofkit.benchmark.trials.construction import KnownTruth
from dofkit.benchmark.trials.traps import TRAPS, Trap
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import num

#: How many trials of a group are left open, and why.
OPEN: dict[tuple[str, str], tuple[int, str]] = {
    ("identities", "arc sines by abs"): (8, "asin|w| and acos(1 - 2 w^2) are not written by one another"),
    ("identities", "odd area sine"): (8, "log(w + r) + log(r - w) = 0 with r^2 = w^2 + 1 is not known"),
    ("near misses of identities", "arc sines by abs"): (6, "as above; no ball tells all of a line from 0"),
    ("near misses of identities", "odd area sine"): (7, "as above"),
    ("near misses of identities", "a golden arc sine"): (3, "the nested root has no value modulo the primes tried"),
    ("near misses of identities", "root of a product"): (1, "a sum of roots of parameters is not seen to be positive"),
    ("near misses of identities", "exp of -200 w"): (1, "floating point finds no way to where exp(-200 w) matters"),
    ("near misses of identities", "exp of -1000"): (1, "exp(-1000) is 0 in floating point"),
    ("tiny steps from integrable", "a circle of tiny radius"): (1, "a radius of 10^-30 looks like a point"),
}
#: Trials of a group that are all tried.
SMALL = 8


@cache
def groups(family: str) -> dict[str, list[KnownTruth]]:
    found: dict[str, list[KnownTruth]] = defaultdict(list)
    for trial in FAMILIES[family].trials():
        found[trial.group].append(trial)
    return found


def tried(family: str, group: str) -> list[KnownTruth]:
    """All of a small group, every other one of a large one: the odd ones of some groups, the even ones of others."""
    trials = groups(family)[group]
    return trials if len(trials) <= SMALL else trials[crc32(group.encode()) % 2 :: 2]


GROUPS = [(family, group) for family in FAMILIES for group in groups(family)]


@pytest.mark.parametrize(
    ("family", "group", "most"), [case for group in GROUPS for case in [pytest.param(*group, 1), swept(*group, None)]]
)
def test_nothing_is_wrong_and_little_is_left_open(family: str, group: str, most: int | None) -> None:
    """Of each group one trial, and all that are `tried` in the sweep."""
    wrong, opened = [], []
    for trial in tried(family, group)[:most]:
        not_true, left_open = differences(trial, dofkit.classify(dofkit.load(dict(trial.scene))))
        wrong += [f"{trial.name}: {line}" for line in not_true]
        opened += [f"{trial.name}: {left_open}"] * bool(left_open)
    assert wrong == []
    allowed, _ = OPEN.get((family, group), (0, ""))
    assert len(opened) <= allowed, opened


@pytest.mark.parametrize("family", FAMILIES)
def test_the_share_that_is_right_has_a_floor(family: str) -> None:
    trials = sum(map(len, groups(family).values()))
    left = sum(number for (name, _), (number, _) in OPEN.items() if name == family)
    assert 1 - left / trials >= FAMILIES[family].floor


def test_what_is_left_open_is_there() -> None:
    assert set(OPEN) <= set(GROUPS)


def test_there_are_many() -> None:
    assert len(TRAPS) >= 25
    assert sum(len(tried(family, group)) for family, group in GROUPS) >= 1600
    assert sum(len(trials) for family in FAMILIES for trials in groups(family).values()) >= 3000


# The traps themselves, by nothing but interval arithmetic on the text

POINTS = (
    {"w": Fraction(3, 8), "v": Fraction(1, 4), "a": Fraction(7, 4), "b": Fraction(5, 8)},
    {"w": Fraction(13, 16), "v": Fraction(1, 2), "a": Fraction(3, 8), "b": Fraction(7, 2)},
)


@pytest.mark.parametrize("trap", TRAPS, ids=lambda trap: trap.name)
@pytest.mark.parametrize("at", POINTS, ids=("first", "second"))
def test_a_trap_is_zero_and_its_near_misses_are_not(trap: Trap, at: dict[str, Fraction]) -> None:
    names = Names(parameters={name: num(value) for name, value in at.items()})
    zero = interval_of(parse_expression(trap.zero, names))
    assert zero is not None
    assert zero.contains(0)
    assert zero.abs_upper() < 1e-60
    for text in trap.misses:
        near = interval_of(parse_expression(text, names))
        assert near is not None
        assert not near.contains(0)
