"""The families of trials with known answers: one function each, in one module for each kind of mathematics.

A family yields scenes with what is true of them by construction (`construction.KnownScene`); every question whose
answer is known becomes a trial. Scenes that follow no rule stand in tables (the YAML files of this folder), with their
truth derived by hand.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import ModuleType

from dofkit.benchmark.trials import bodies, equations, forms, graphs, identities, lectures, poses
from dofkit.benchmark.trials.construction import KnownScene, Trial

Family = Callable[[], Iterator[Trial]]

#: What the families are about: five headings, and the modules under each.
_HEADINGS: Mapping[str, tuple[ModuleType, ...]] = {
    "Lectures and homework": (lectures,),
    "Linkages and mechanisms": (graphs, bodies),
    "Drawings: nearly singular, rounded, far away": (poses,),
    "Differential constraints and time": (forms,),
    "Equations between coordinates": (equations, identities),
}
#: The heading that each family stands under.
HEADINGS: Mapping[str, str] = {
    name: heading for heading, modules in _HEADINGS.items() for module in modules for name in module.FAMILIES
}
#: The scenes of each family by name.
KNOWN_SCENES: Mapping[str, Callable[[], Iterator[KnownScene]]] = {
    name: scenes for modules in _HEADINGS.values() for module in modules for name, scenes in module.FAMILIES.items()
}
#: What each family is, in a line.
GLOSSES: Mapping[str, str] = {
    name: (scenes.__doc__ or "").partition("\n")[0].rstrip(".") for name, scenes in KNOWN_SCENES.items()
}


def _family(name: str) -> Family:
    return lambda: (trial for scene in KNOWN_SCENES[name]() for trial in scene.trials(name))


#: The trials of each family by name.
FAMILIES: Mapping[str, Family] = {name: _family(name) for name in KNOWN_SCENES}
