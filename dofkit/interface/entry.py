"""Where the command line begins, before anything of weight is imported."""

from __future__ import annotations

import atexit
import gc
import os
import sys
import threading

#: So many objects are made before those no longer used are looked for: imports make many, which all stay.
OBJECTS = 100_000


def main() -> None:
    """Run the command line."""
    gc.set_threshold(OBJECTS)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    try:
        from dofkit.interface.cli import main as run  # after the settings above

        run()
    except SystemExit as ended:
        if _alone() and isinstance(ended.code, int):
            _leave(ended.code)
        raise


def _alone() -> bool:
    """Does nobody wait for the end of this process: no other thread, no debugger, no profiler?"""
    return threading.active_count() == 1 and sys.gettrace() is None and sys.getprofile() is None


def _leave(status: int) -> None:
    """End this process, after what is to be done at its end: to take it apart object by object takes Python long."""
    atexit._run_exitfuncs()
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except (OSError, ValueError, AttributeError):
        return
    os._exit(status)
