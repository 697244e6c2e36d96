"""Property tests draw the same examples on every run, so that a failure is a change of the code and not luck.

All tests of one scene run in one process, which works its report out once, and so do all others of a file: what they
have in common is made once, and groups without end cost pytest-xdist a twentieth of the time. Garbage is looked for
seldom, never among what was there before the first test, and not at the end: that took a fifth of the time.

Of the tests in `spread.yaml` one case in so many is run, or none; the others are swept. `--share 1/3` runs a third of
the selected tests, the same on every run; which third is said by `--turn TEXT`, such as a commit's hash.

The time allowed for a scene is processor time of this process here: what else the machine does is of no account.

The tests start hundreds of Python processes, each of which would compile the package again where bytecode may not be
written: theirs is, whatever the environment says. Workers are copies of this process, as they are of a command's own,
also beside the threads that read what idle workers say: a fresh Python imports for a second.
"""

import atexit
import gc
import os
import sys
import threading
import time
from collections import Counter
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from zlib import crc32

import pytest
import yaml
from hypothesis import settings

from dofkit.base import deadline, runs, workers

settings.register_profile("steady", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("steady")


#: Of how many cases of a test one is run, by module; how many cases of each have been collected.
SPREAD = yaml.safe_load((Path(__file__).parent / "spread.yaml").read_text(encoding="utf-8"))
COUNTED: Counter[tuple[str, str]] = Counter()


def can_fork() -> bool:
    """Return whether this process may be forked: all that other threads do is to wait for workers."""
    return sys.platform == "linux" and sum(not thread.daemon for thread in threading.enumerate()) == 1


_PATCH = pytest.MonkeyPatch()
_PATCH.setattr(deadline, "time", SimpleNamespace(monotonic=time.process_time, thread_time=time.thread_time))
_PATCH.setattr(workers, "can_fork", can_fork)
_PATCH.setattr(runs, "can_fork", can_fork)


os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
gc.disable()  # what is collected stays


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--share", type=Fraction, default=Fraction(1), help="this part of the tests, by their names")
    parser.addoption("--turn", default="", help="a text that says which part it is")


@pytest.hookimpl(tryfirst=True)
def pytest_itemcollected(item: pytest.Item) -> None:
    module, test = item.nodeid.split("[")[0].removeprefix("tests/").split(".py::")
    of = SPREAD.get(module, {}).get(test)
    if of is not None and item.get_closest_marker("sweep") is None:
        if of == 0 or COUNTED[module, test] % of:
            item.add_marker(pytest.mark.sweep)
        COUNTED[module, test] += 1
    if item.get_closest_marker("xdist_group") is None:
        path = getattr(getattr(item, "callspec", None), "params", {}).get("path")
        item.add_marker(pytest.mark.xdist_group(path.stem if isinstance(path, Path) else item.path.stem))


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    share, first = config.getoption("share"), crc32(config.getoption("turn").encode())
    items[:] = [item for item in items if (crc32(item.nodeid.encode()) - first) % 2**32 < share * 2**32]


def pytest_collection_finish() -> None:
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)
    gc.enable()
    atexit.register(gc.freeze)
