"""Every kind of case by name, and those that are known to be answered wrongly today."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from functools import cache

from dofkit.benchmark.trials import HEADINGS, KNOWN_SCENES
from dofkit.benchmark.trials.construction import KnownScene

from . import (
    agreements,
    branches,
    components,
    eliminations,
    flatness,
    frameworks,
    hinges,
    inequalities,
    linear,
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

_FAMILIES = (
    agreements,
    branches,
    components,
    eliminations,
    flatness,
    frameworks,
    hinges,
    inequalities,
    linear,
    primes,
    reality,
    references,
    regions,
    rounding,
    times,
    vanishing,
)


def _drawn_from(family: str) -> Generator:
    """Return one of the scenes of a family of the charts; small ones for the smallest sizes."""

    @cache
    def members(quick: bool) -> list[KnownScene]:
        return list(KNOWN_SCENES[family](quick))

    def drawn(rng: random.Random, size: int) -> KnownScene:
        few = members(True)
        large = [one for one in members(False) if one.size <= SMALL * size] if size > 1 else []
        return rng.choice(large or few)

    return drawn


#: Of a family of the charts, scenes up to so many times the size that is asked for.
SMALL = 4
#: Families of the charts that tell of answers beside a constraint, or are lectures.
_LECTURES = "Lectures and homework"

#: ``family/function``, the function's name with hyphens; ``charts/family``.
KINDS: Mapping[str, Generator] = {
    **{f"{one.__name__.rpartition('.')[2]}/{name}": made for one in _FAMILIES for name, made in one.FAMILY.items()},
    **{f"charts/{name}": _drawn_from(name) for name, heading in HEADINGS.items() if heading != _LECTURES},
}

#: Kinds, and files of `found/`, whose answers are known to be wrong, with why: the short run leaves them out.
OPEN: Mapping[str, str] = {}


def drawn(kind: str, seed: int, size: int) -> KnownScene:
    """The case of a kind: the same for the same seed and size."""
    return KINDS[kind](random.Random(f"{kind} {seed}"), size)
