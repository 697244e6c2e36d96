"""Every kind of case by name, trials drawn from them, and those that are known to be answered wrongly today."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

from dofkit.benchmark.trials import HEADINGS, KNOWN_SCENES
from dofkit.benchmark.trials.construction import KnownScene

from .disguises import DISGUISES

#: A family: a scene of a size (0 is the smallest) from random choices.
Generator = Callable[[random.Random, int], KnownScene]

#: Of a family of the charts, scenes up to so many times the size that is asked for.
SMALL = 4
#: Families of the charts that tell of answers beside a constraint, or are lectures.
_LECTURES = "Lectures and homework"


def _drawn_from(family: str) -> Generator:
    """Return what draws one of the scenes of a family of the charts, up to a size."""

    @cache
    def members() -> list[KnownScene]:
        return sorted(KNOWN_SCENES[family](), key=lambda scene: scene.size)

    def drawn(rng: random.Random, size: int) -> KnownScene:
        small = [scene for scene in members() if scene.size <= SMALL * max(1, size)]
        return rng.choice(small or members()[:1])

    return drawn


#: What the functions of a family take and return.
_SIGNATURE = {"rng": "random.Random", "size": "int", "return": "KnownScene"}


def _kinds() -> Iterator[tuple[str, Generator]]:
    """Yield the public functions of this folder's files that draw a scene, and the families of the charts."""
    for path in sorted(Path(__file__).parent.glob("[a-z]*.py")):
        module = import_module(f"{__package__}.{path.stem}") if path != Path(__file__) else None
        for name, function in vars(module).items() if module is not None else ():
            own = getattr(function, "__module__", "") == f"{__package__}.{path.stem}" and not name.startswith("_")
            if own and getattr(function, "__annotations__", None) == _SIGNATURE:
                yield f"{path.stem}/{name.replace('_', '-')}", function
    for name, heading in HEADINGS.items():
        if heading != _LECTURES:
            yield f"charts/{name}", _drawn_from(name)


#: ``family/function``, the function's name with hyphens; ``charts/family``.
KINDS: Mapping[str, Generator] = dict(_kinds())

#: Kinds, and files of `found/`, whose answers are known to be wrong, with why: the short run leaves them out.
OPEN: Mapping[str, str] = {}
#: Cases that were answered wrongly once, each a file with its scene and its truth.
FOUND = Path(__file__).parent / "found"


class Trial(NamedTuple):
    """A case by the choices that make it: a kind, a seed, a size, and disguises with their seeds."""

    kind: str
    seed: int
    size: int
    disguises: tuple[tuple[str, int], ...] = ()

    def __str__(self) -> str:
        worn = "".join(f" {name}:{seed}" for name, seed in self.disguises)
        return f"{self.kind} seed {self.seed} size {self.size}{worn}"


def drawn(kind: str, seed: int, size: int) -> KnownScene:
    """Return the case of a kind: the same for the same seed and size."""
    return KINDS[kind](random.Random(f"{kind} {seed}"), size)


def made(trial: Trial) -> KnownScene:
    """Return the case of a trial; a disguise that does not fit it is left out."""
    case = drawn(trial.kind, trial.seed, trial.size)
    for name, seed in trial.disguises:
        case = DISGUISES[name](random.Random(f"{name} {seed}"), case) or case
    return case


def any_trial(rng: random.Random, kind: str) -> Trial:
    """Return a trial of a kind, mostly small, and mostly in disguise."""
    worn = rng.choices(list(DISGUISES), k=rng.choice((0, 0, 1, 1, 2, 3)))
    size = rng.choice((0, 0, 1, 1, 2, 3, 4))
    return Trial(kind, rng.randrange(10**6), size, tuple((name, rng.randrange(1000)) for name in worn))


def read(path: Path) -> tuple[str, KnownScene]:
    """Return the kind and the case of a file of `FOUND`."""
    fields = json.loads(path.read_text(encoding="utf-8"))
    return fields["kind"], KnownScene(fields["scene"], fields["truth"], fields["elsewhere"])
