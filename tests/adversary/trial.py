"""A case by the choices that make it: a kind, a seed, a size, and disguises; and the smallest that fails alike."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from dofkit.benchmark.trials.construction import KnownScene

from .disguises import DISGUISES
from .registry import KINDS, drawn

#: Cases that are tried at most.
TRIES = 60
#: Seeds that are tried for a size.
SEEDS = 12


def length(scene: Mapping[str, Any]) -> int:
    return len(json.dumps(scene, default=str))


def shrunk(trial: Trial, fails: Callable[[Trial], bool], tries: int = TRIES) -> Trial:
    """The smallest of the trials that fail, by the length of the scene. Each is made anew, so its truth is known."""
    best, left = trial, tries
    improved = True
    while improved and left > 0:
        improved = False
        for other in _smaller(best):
            if left <= 0:
                break
            if length(made(other).scene) < length(made(best).scene):
                left -= 1
                if fails(other):
                    best, improved = other, True
                    break
    return best


def _smaller(trial: Trial) -> Iterator[Trial]:
    """Without the disguises, without one, of a smaller size, from small seeds."""
    if trial.disguises:
        yield trial._replace(disguises=())
        for k in range(len(trial.disguises)):
            yield trial._replace(disguises=trial.disguises[:k] + trial.disguises[k + 1 :])
    for size in range(trial.size + 1):
        yield trial._replace(size=size)
        for seed in range(SEEDS):
            yield trial._replace(size=size, seed=seed)


class Trial(NamedTuple):
    kind: str
    seed: int
    size: int
    disguises: tuple[tuple[str, int], ...] = ()

    def __str__(self) -> str:
        worn = "".join(f" {name}:{seed}" for name, seed in self.disguises)
        return f"{self.kind} seed {self.seed} size {self.size}{worn}"


#: The largest size.
LARGEST = 4


def made(trial: Trial) -> KnownScene:
    """The case of a trial; a disguise that does not fit it is left out."""
    case = drawn(trial.kind, trial.seed, trial.size)
    for name, seed in trial.disguises:
        case = DISGUISES[name](random.Random(f"{name} {seed}"), case) or case
    return case


def any_trial(rng: random.Random, kinds: list[str] | None = None) -> Trial:
    """Of any kind, mostly small, and mostly in disguise."""
    worn = rng.choices(list(DISGUISES), k=rng.choice((0, 0, 1, 1, 2, 3)))
    return Trial(
        rng.choice(kinds or list(KINDS)),
        rng.randrange(10**6),
        rng.choice((0, 0, 1, 1, 2, 3, LARGEST)),
        tuple((name, rng.randrange(1000)) for name in worn),
    )
