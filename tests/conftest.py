"""Property tests draw the same examples on every run, so that a failure is a change of the code and not luck.

All tests of one scene run in one process, which works its report out once. Garbage is looked for seldom, and never
among what was there before the first test: that took a sixth of the time.

The time allowed for a scene is processor time of this process here: what else the machine does is of no account.
"""

import gc
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import settings

from dofkit.base import deadline

settings.register_profile("steady", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("steady")


pytest.MonkeyPatch().setattr(
    deadline, "time", SimpleNamespace(monotonic=time.process_time, thread_time=time.thread_time)
)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        path = getattr(getattr(item, "callspec", None), "params", {}).get("path")
        if isinstance(path, Path):
            item.add_marker(pytest.mark.xdist_group(path.stem))


def pytest_collection_finish() -> None:
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)
