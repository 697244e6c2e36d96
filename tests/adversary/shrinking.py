"""The smallest case that is answered wrongly in the same way: fewer disguises, a smaller size, other seeds."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from .trial import Trial, made

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
