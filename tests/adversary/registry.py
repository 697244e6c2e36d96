"""Every kind of case by name, and those that are known to be answered wrongly today."""

from __future__ import annotations

import random
from collections.abc import Mapping

from . import (
    agreements,
    branches,
    circuits,
    components,
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
from .case import Case, Generator

_FAMILIES = {
    "agreements": agreements.FAMILY,
    "branches": branches.FAMILY,
    "circuits": circuits.FAMILY,
    "components": components.FAMILY,
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

_ONE_COMPONENT = "the freedom of the component found is told as that of the whole set"
_GENERIC = "forms are read at a point of any component, not at the reference"
_FIXED_PRIMES = "a multiple of the primes in use is taken for 0"
_REGION = "ranks of all of space are counted where a relation holds on a region"
_CIRCUIT = "dependent rows at one position are taken for relations that follow"
_MEASURED = "a path that is not followed is taken for rigidity, or a measured number for an exact one"
_DIVIDED = "an unknown is solved for though its coefficient is 0 on the whole set"

#: Kinds, and files of `found/`, whose answers are known to be wrong, with why: the short run leaves them out.
OPEN: Mapping[str, str] = {
    "agreements/logarithms": "exp and log of arguments that agree on the set only are drawn apart",
    "circuits/parallel-cranks": _CIRCUIT,
    "components/form-on-the-larger": _ONE_COMPONENT,
    "components/ladder": _ONE_COMPONENT,
    "components/powers": _ONE_COMPONENT,
    "eliminations/across": _DIVIDED,
    "eliminations/bipartite": _DIVIDED,
    "flatness/touching": "past some columns nothing is looked at beyond the series",
    "hinges/flat-vertex": "some equations of a joint that follow are told of the whole joint",
    "measured/alone": _MEASURED,
    "measured/attached": _MEASURED,
    "primes/growth": _FIXED_PRIMES,
    "primes/twisted": _FIXED_PRIMES,
    "reality/handles": _GENERIC,
    "reality/isolated-points": _ONE_COMPONENT,
    "references/crossed": _GENERIC,
    "references/on-the-larger": _GENERIC,
    "references/parallelogram": _GENERIC,
    "references/turned-cranks": _GENERIC,
    "regions/repeated": _REGION,
    "regions/sided": _REGION,
    "vanishing/followed": _CIRCUIT,
    "vanishing/on-a-curve": _CIRCUIT,
    "identities-vanishing-e91f448d.json": "two writings of a sum of powers are expanded differently and drawn apart",
    "primes-solved-17fd7e82.json": "a point far away is taken for a solution though its residue is large",
    "times-cancelled-311f4784.json": "a positive factor of several coordinates is not seen to be positive",
    "times-homogeneous-8be442f4.json": "the time allowed is not looked at while a large power is expanded",
}


def drawn(kind: str, seed: int, size: int) -> Case:
    """The case of a kind: the same for the same seed and size."""
    return KINDS[kind](random.Random(f"{kind} {seed}"), size)
