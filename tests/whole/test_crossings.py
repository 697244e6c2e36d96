"""How many modules a small scene passes through: a ceiling that only falls."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import crossings
from shared.known_scenes import ROOT

from dofkit.base import deadline

CEILING = 60


def test_a_small_scene_passes_through_few_modules() -> None:
    command = [sys.executable, str(ROOT / "tests/crossings.py")]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    printed = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout
    entered = [int(number) for number in re.findall(r": (\d+) modules entered", printed)]
    assert len(entered) == len(crossings.SCENES)
    assert max(entered) <= CEILING, printed


def test_modules_are_those_of_the_functions_that_are_called() -> None:
    """`unless_late` calls `check`, which is of the same module; the lambda here is of none of the package."""
    assert crossings.modules_entered(lambda: deadline.unless_late(deadline.check, None)) == {"base.deadline"}
