"""A case by the choices that make it: a kind, a seed, a size, and disguises with seeds of their own."""

from __future__ import annotations

import random
from typing import NamedTuple

from dofkit.benchmark.trials.construction import KnownScene

from .disguises import DISGUISES
from .registry import KINDS, drawn


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
