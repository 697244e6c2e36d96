"""Where the command line begins, before anything of weight is imported."""

from __future__ import annotations

import gc
import os

from dofkit.base.surface import handed_on

#: So many objects are made before those no longer used are looked for: imports make many, which all stay.
OBJECTS = 100_000


def main() -> None:
    """Run the command line."""
    gc.set_threshold(OBJECTS)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    handed_on(__name__, {"main": "dofkit.interface.cli"}, "main")()
