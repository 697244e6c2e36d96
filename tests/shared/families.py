"""Families of scenes whose truth is known by how they are made; adding one is one function and one line here."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from dofkit.benchmark.trials.construction import KnownTruth
from dofkit.benchmark.trials.contexts import identities, near_misses
from dofkit.benchmark.trials.rewritten import other_coordinates
from dofkit.benchmark.trials.steps import tiny_steps


@dataclass(frozen=True)
class Family:
    """``floor``: the least share of right answers; none may be wrong."""

    trials: Callable[[], Iterator[KnownTruth]]
    floor: float


FAMILIES: Mapping[str, Family] = {
    "identities": Family(identities, 0.95),
    "near misses of identities": Family(near_misses, 0.97),
    "tiny steps from integrable": Family(tiny_steps, 0.97),
    "other coordinates": Family(other_coordinates, 0.95),
}
