"""The families of stress trials: one function each, in one module a theme."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import ModuleType

from dofkit.benchmark.trials import (
    blocks,
    catalog,
    chains,
    equivalence,
    forms,
    graphs,
    identities,
    joints,
    mechanisms,
    near_singular,
    powers,
    relations,
    times,
)
from dofkit.benchmark.trials.construction import KnownScene, few
from dofkit.benchmark.trials.trial import Trial

Family = Callable[[bool], Iterator[Trial]]

#: What the families are about: five headings, and the modules under each.
_HEADINGS: Mapping[str, tuple[ModuleType, ...]] = {
    "Lectures and homework": (catalog, equivalence),
    "Linkages and mechanisms": (graphs, joints, mechanisms),
    "Drawings: nearly singular, rounded, far away": (near_singular,),
    "Differential constraints, time, long chains": (forms, times, chains, blocks),
    "Equations between coordinates": (relations, powers, identities),
}
#: The scenes of each family by name.
KNOWN_SCENES: Mapping[str, Callable[[bool], Iterator[KnownScene]]] = {
    **catalog.FAMILIES,
    **graphs.FAMILIES,
    **joints.FAMILIES,
    **mechanisms.FAMILIES,
    **near_singular.FAMILIES,
    **chains.FAMILIES,
    **blocks.FAMILIES,
    **forms.FAMILIES,
    **times.FAMILIES,
    **relations.FAMILIES,
    **powers.FAMILIES,
    **identities.FAMILIES,
    **equivalence.FAMILIES,
}
#: The heading that each family stands under.
HEADINGS: Mapping[str, str] = {
    name: heading for heading, modules in _HEADINGS.items() for module in modules for name in module.FAMILIES
}


def _trials(name: str, constructions: Iterator[KnownScene]) -> Iterator[Trial]:
    return (trial for construction in constructions for trial in construction.trials(name))


def _family(name: str) -> Family:
    """Of the small members, a few that stand for the others."""
    return lambda quick: (
        few(_trials(name, KNOWN_SCENES[name](True))) if quick else _trials(name, KNOWN_SCENES[name](False))
    )


#: What each family is, in a line.
GLOSSES: Mapping[str, str] = {
    name: (made.__doc__ or "").partition("\n")[0].rstrip(".") for name, made in KNOWN_SCENES.items()
}
#: Every family by name. ``quick``: a few small members that stand for the others.
FAMILIES: Mapping[str, Family] = {name: _family(name) for name in KNOWN_SCENES}
