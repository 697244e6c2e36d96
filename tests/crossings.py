"""Modules of the package that are entered while a scene is loaded and classified, by room.

python tests/crossings.py [SCENE...]

Every module of the package is imported first; then a profiler sees every call of a function of the package. A room is
what stands first under the package. That rooms only call downward is checked by the import contracts.
"""

from __future__ import annotations

import os
import pkgutil
import sys
from collections import defaultdict
from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path
from types import FrameType
from typing import Any

import dofkit

HOME = str(Path(dofkit.__file__).parent) + os.sep
SCENES = ("disc-rolling-on-plane", "four-bar-linkage")


def modules_entered(work: Callable[[], object]) -> set[str]:
    """Return the modules of which some work calls a function, without the package's name."""
    files = set[str]()

    def profile(frame: FrameType, event: str, argument: Any) -> None:
        if event == "call" and frame.f_code.co_name != "<module>":
            files.add(frame.f_code.co_filename)

    sys.setprofile(profile)
    try:
        work()
    finally:
        sys.setprofile(None)
    inside = (file.removeprefix(HOME).removesuffix(".py") for file in files if file.startswith(HOME))
    return {name.removesuffix(f"{os.sep}__init__").replace(os.sep, ".") for name in inside}


def import_all() -> None:
    """Import the whole package, as far as what it needs is there."""
    for module in pkgutil.walk_packages(dofkit.__path__, "dofkit."):
        if not module.name.endswith("__main__"):
            try:
                import_module(module.name)
            except ImportError:
                continue


def main(scenes: Iterable[str]) -> None:
    import_all()
    for name in scenes:
        entered = modules_entered(lambda name=name: dofkit.classify(dofkit.load(name)))
        by_room = defaultdict[str, list[str]](list)
        for module in sorted(entered):
            room, _, inner = module.partition(".")
            by_room[room].append(inner)
        print(f"{name}: {len(entered)} modules entered")
        for room, inner_names in by_room.items():
            print(f"  {room} {len(inner_names)}: {' '.join(inner_names)}")


if __name__ == "__main__":
    main(sys.argv[1:] or SCENES)
