"""The entry point of the command line, which configures the process before other modules are imported, and its end."""

from __future__ import annotations

import atexit
import gc
import os
import sys
import threading
from typing import Any

from dofkit.interface.output import INTERRUPTED

#: The garbage collector starts after this many allocations: imports allocate many objects, none of which is garbage.
OBJECTS = 100_000


def main() -> None:
    """Run the command line and end this process; an interrupt or a closed pipe ends it without a traceback."""
    gc.set_threshold(OBJECTS)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    if os.environ.get("FORCE_COLOR") == "0":
        # Rich reads any value of FORCE_COLOR as a request for colours.
        os.environ["NO_COLOR"] = os.environ.pop("FORCE_COLOR")
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    status: Any = 0
    try:
        from dofkit.interface.cli import app  # after the settings above

        app()
    except KeyboardInterrupt:
        status = INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = 1
    except SystemExit as ended:
        status = ended.code
    needs_teardown = threading.active_count() > 1 or sys.gettrace() is not None or sys.getprofile() is not None
    if isinstance(status, int) and not needs_teardown:
        # Python would destroy every object, which takes a tenth of the time of a small scene.
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    sys.exit(status)
