"""Every kind of case by name, and those that are known to be answered wrongly today."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping

from dofkit.benchmark.trials.construction import KnownScene

from . import (
    agreements,
    branches,
    circuits,
    components,
    edges,
    eliminations,
    flatness,
    hinges,
    identities,
    inequalities,
    linear,
    measured,
    primes,
    reality,
    references,
    regions,
    rounding,
    times,
    vanishing,
)

#: A family: a scene of a size (0 is the smallest) from random choices.
Generator = Callable[[random.Random, int], KnownScene]

_FAMILIES = {
    "agreements": agreements.FAMILY,
    "branches": branches.FAMILY,
    "circuits": circuits.FAMILY,
    "components": components.FAMILY,
    "edges": edges.FAMILY,
    "eliminations": eliminations.FAMILY,
    "flatness": flatness.FAMILY,
    "hinges": hinges.FAMILY,
    "identities": identities.FAMILY,
    "inequalities": inequalities.FAMILY,
    "linear": linear.FAMILY,
    "measured": measured.FAMILY,
    "primes": primes.FAMILY,
    "reality": reality.FAMILY,
    "references": references.FAMILY,
    "regions": regions.FAMILY,
    "rounding": rounding.FAMILY,
    "times": times.FAMILY,
    "vanishing": vanishing.FAMILY,
}

#: ``family/function``, the function's name with hyphens.
KINDS: Mapping[str, Generator] = {
    f"{family}/{name}": made for family, members in _FAMILIES.items() for name, made in members.items()
}

#: Kinds, and files of `found/`, whose answers are known to be wrong, with why: the short run leaves them out.
OPEN: Mapping[str, str] = {}


def drawn(kind: str, seed: int, size: int) -> KnownScene:
    """The case of a kind: the same for the same seed and size."""
    return KINDS[kind](random.Random(f"{kind} {seed}"), size)
