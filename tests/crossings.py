"""Who calls whom while a scene is loaded and classified: modules entered, calls between them, and pairs both ways.

python tests/crossings.py [SCENE...]

Every module of the package is imported first; then a profiler sees every call of a function of the package, and the
function of the package that made it: what stands between them (a context manager, `functools.partial`, Pydantic) is
passed over. A room is what stands first under the package.

A call is a *callback* where the module that makes it has no name for what it calls: neither for the function, nor for
the class whose method it is or one above that, nor for the module. It was handed the function, a lambda, a generator to
go on with, or an object that is known by a protocol. Two rooms, or two modules, call each other both ways, callbacks
apart, where each has a name for something of the other that it calls.
"""

from __future__ import annotations

import os
import pkgutil
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from inspect import CO_GENERATOR
from pathlib import Path
from types import CodeType, FrameType, ModuleType
from typing import Any

import dofkit

HOME = str(Path(dofkit.__file__).parent) + os.sep
SCENES = ("disc-rolling-on-plane", "four-bar-linkage")
Pair = tuple[str, str]


@dataclass
class Calls:
    """Calls from one module to another, and those of them that are no callbacks."""

    entered: set[str] = field(default_factory=set)
    all: Counter[Pair] = field(default_factory=Counter)
    named: Counter[Pair] = field(default_factory=Counter)

    def add(self, frame: FrameType) -> None:
        """Count the call that made this frame, if it is one of the package."""
        here = module(frame.f_code)
        if here:
            self.entered.add(here)
            caller = frame.f_back
            while caller is not None and not module(caller.f_code):
                caller = caller.f_back
            if caller is not None and (there := module(caller.f_code)) != here:
                self.all[there, here] += 1
                self.named[there, here] += is_named(frame.f_code, here, caller.f_globals)

    def by_room(self) -> Calls:
        """The same between rooms."""
        found = Calls({room(name) for name in self.entered})
        for (one, other), number in self.all.items():
            if room(one) != room(other):
                found.all[room(one), room(other)] += number
                found.named[room(one), room(other)] += self.named[one, other]
        return found

    def both_ways(self) -> list[Pair]:
        """Pairs that call each other, callbacks too."""
        return _mutual(self.all)

    def both_ways_by_name(self) -> list[Pair]:
        """Pairs that call each other, callbacks apart."""
        return _mutual(+self.named)


def _mutual(calls: Iterable[Pair]) -> list[Pair]:
    pairs = set(calls)
    return sorted((one, other) for one, other in pairs if one < other and (other, one) in pairs)


@cache
def module(code: CodeType) -> str:
    """The module of the package, without the package's name; nothing for a function from elsewhere."""
    if not code.co_filename.startswith(HOME):
        return ""
    parts = code.co_filename.removeprefix(HOME).removesuffix(".py").split(os.sep)
    return ".".join(parts[:-1] if len(parts) > 1 and parts[-1] == "__init__" else parts)


def room(name: str) -> str:
    """What stands first under the package."""
    return name.partition(".")[0]


def is_named(code: CodeType, home: str, names: Mapping[str, Any]) -> bool:
    """Has a module with these names one for the function, its class, a class above it, or its module ``home``?"""
    if code.co_flags & CO_GENERATOR and "<genexpr>" in code.co_name:
        return False
    full = "dofkit" if home == "__init__" else f"dofkit.{home}"
    return code.co_qualname.partition(".")[0] in _known(full, tuple(_homes(names)))


def _homes(names: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """(module, name) of every function, class and module among the names; a module is all that it holds."""
    for value in list(names.values()):
        for one in value.__mro__ if isinstance(value, type) else [value]:
            name = getattr(one, "__qualname__", None) or getattr(one, "__name__", None)
            if isinstance(one, ModuleType):
                yield one.__name__, ""
            elif isinstance(name, str) and isinstance(getattr(one, "__module__", None), str):
                yield one.__module__, name


def _known(home: str, names: tuple[tuple[str, str], ...]) -> set[str]:
    """The names of what is known of the module ``home``."""
    found = {name for place, name in names if place == home}
    return set(vars(sys.modules[home])) if "" in found else found


def traced(work: Callable[[], object]) -> Calls:
    """The calls that some work makes."""
    found = Calls()

    def profile(frame: FrameType, event: str, argument: Any) -> None:
        if event == "call":
            found.add(frame)

    sys.setprofile(profile)
    try:
        work()
    finally:
        sys.setprofile(None)
    return found


def import_all() -> None:
    """Import the whole package, as far as what it needs is there."""
    for found in pkgutil.walk_packages(dofkit.__path__, "dofkit."):
        if not found.name.endswith("__main__"):
            try:
                import_module(found.name)
            except ImportError:
                continue


def main(scenes: Iterable[str]) -> None:
    import_all()
    for name in scenes:
        calls = traced(lambda name=name: dofkit.classify(dofkit.load(name)))
        print(f"{name}")
        for what, found in (("modules", calls), ("rooms", calls.by_room())):
            both, named = found.both_ways(), found.both_ways_by_name()
            print(f"  {what}: {len(found.entered)} entered, {found.all.total()} calls between them")
            print(f"    {len(both)} pairs both ways{_list(both)}")
            print(f"    {len(named)} pairs both ways, callbacks apart{_list(named)}")


def _list(pairs: Iterable[Pair]) -> str:
    return "".join(f"\n      {one} - {other}" for one, other in pairs)


if __name__ == "__main__":
    main(sys.argv[1:] or SCENES)
