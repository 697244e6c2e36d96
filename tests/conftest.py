"""Property tests draw the same examples on every run, so that a failure is a change of the code and not luck.

All tests of one scene run in one process, which works its report out once. Garbage is looked for seldom, and never
among what was there before the first test: that took a sixth of the time.

`--share 1/3` runs a third of the tests that are selected, the same on every run.

The time allowed for a scene is processor time of this process here: what else the machine does is of no account.

The tests start hundreds of Python processes, each of which would compile the package again where bytecode may not be
written: theirs is, whatever the environment says.
"""

import gc
import os
import time
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from zlib import crc32

import pytest
from hypothesis import settings

from dofkit.base import deadline

settings.register_profile("steady", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("steady")


pytest.MonkeyPatch().setattr(
    deadline, "time", SimpleNamespace(monotonic=time.process_time, thread_time=time.thread_time)
)


os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--share", type=Fraction, default=Fraction(1), help="this part of the tests, by their names")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    share = config.getoption("share")
    items[:] = [item for item in items if crc32(item.nodeid.encode()) < share * 2**32]
    for item in items:
        path = getattr(getattr(item, "callspec", None), "params", {}).get("path")
        if isinstance(path, Path):
            item.add_marker(pytest.mark.xdist_group(path.stem))


def pytest_collection_finish() -> None:
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)
