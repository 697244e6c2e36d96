"""The families of trials with known answers: one function each, in one module for each kind of mathematics.

A family yields scenes whose answers are known by construction (`construction.KnownScene`); every question whose answer
is known becomes a trial. Irregular scenes are listed in tables (the YAML files of this folder), with answers derived by
hand. The first line of a family's docstring describes its scenes and is printed in the chart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import ModuleType

from dofkit.benchmark.trials import bodies, equations, forms, graphs, identities, lectures, poses
from dofkit.benchmark.trials.construction import KnownScene, Trial

Family = Callable[[], Iterator[Trial]]

#: {heading of the chart: the modules of its families}.
_HEADINGS: Mapping[str, tuple[ModuleType, ...]] = {
    "Lectures and homework": (lectures,),
    "Linkages and mechanisms": (graphs, bodies),
    "Drawings: nearly singular, rounded, far away": (poses,),
    "Differential constraints and time": (forms,),
    "Equations between coordinates": (equations, identities),
}
#: {family: its heading}.
HEADINGS: Mapping[str, str] = {
    name: heading for heading, modules in _HEADINGS.items() for module in modules for name in module.FAMILIES
}
#: {family: the function that yields its scenes}.
KNOWN_SCENES: Mapping[str, Callable[[], Iterator[KnownScene]]] = {
    name: scenes for modules in _HEADINGS.values() for module in modules for name, scenes in module.FAMILIES.items()
}
#: {family: its description in one line}.
GLOSSES: Mapping[str, str] = {
    name: (scenes.__doc__ or "").partition("\n")[0].rstrip(".") for name, scenes in KNOWN_SCENES.items()
}


def _family(name: str) -> Family:
    return lambda: (trial for scene in KNOWN_SCENES[name]() for trial in scene.trials(name))


#: {family: the function that yields its trials}.
FAMILIES: Mapping[str, Family] = {name: _family(name) for name in KNOWN_SCENES}
