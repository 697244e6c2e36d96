"""Rooms call downward: no two of them call each other both ways, callbacks apart."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from types import FunctionType

import crossings
import pytest
from shared.known_scenes import ROOT

from dofkit.base import deadline
from dofkit.exact.ring.ring import Ring


def test_no_two_rooms_call_each_other_both_ways() -> None:
    command = [sys.executable, str(ROOT / "tests/crossings.py")]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    told = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout
    pairs = [int(number) for number in re.findall(r"(\d+) pairs both ways, callbacks apart", told)]
    assert len(pairs) == 2 * len(crossings.SCENES)
    assert pairs[1::2] == [0] * len(crossings.SCENES), told


@pytest.mark.parametrize(
    ("function", "home", "names", "named"),
    [
        (deadline.check, "base.deadline", {"check": deadline.check}, True),
        (deadline.check, "base.deadline", {"time": deadline}, True),
        (deadline.check, "base.deadline", {"left": deadline.left}, False),
        (Ring.node, "exact.ring.ring", {"Ring": Ring}, True),
        (Ring.node, "exact.ring.ring", {"Below": type("Below", (Ring,), {})}, True),
        (Ring.node, "exact.ring.ring", {"ring": "Ring"}, False),
    ],
)
def test_what_has_a_name_is_no_callback(
    function: FunctionType, home: str, names: dict[str, object], named: bool
) -> None:
    assert crossings.is_named(function.__code__, home, names) is named


def test_calls_are_counted_over_what_stands_between() -> None:
    """`unless_late` calls back what it is given, here from a module that is none of the package."""
    calls = crossings.traced(lambda: deadline.unless_late(deadline.check, None))
    assert calls.entered == {"base.deadline"}
    assert not calls.all
