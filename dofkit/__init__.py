"""How a mechanical system can move: degrees of freedom, constraint labels, integrability and redundancy.

>>> import dofkit
>>> dofkit.classify(dofkit.load({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]})).dof
1
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from dofkit.base.errors import DofkitError, SceneError, TextError
from dofkit.base.version import __version__

if TYPE_CHECKING:
    from dofkit.homework.assignment import load_assignment
    from dofkit.homework.grading import grade
    from dofkit.methods.ask import ask
    from dofkit.methods.classify import classify, derived_flag
    from dofkit.mobility.graph.answers import Linkage, linkage, redundant_links
    from dofkit.motion.lagrange.equations import lagrange
    from dofkit.motion.sampled.configurations import configurations
    from dofkit.report import Report
    from dofkit.scene.catalog import catalog_names, catalog_text
    from dofkit.scene.reading import load, loads
    from dofkit.scene.scene import Scene

__all__ = [
    "DofkitError",
    "Linkage",
    "Report",
    "Scene",
    "SceneError",
    "TextError",
    "__version__",
    "ask",
    "catalog_names",
    "catalog_text",
    "classify",
    "configurations",
    "derived_flag",
    "grade",
    "lagrange",
    "linkage",
    "load",
    "load_assignment",
    "loads",
    "redundant_links",
]

#: Where the other names live: what they need is imported when they are first asked for.
_HOMES = {
    "Linkage": "dofkit.mobility.graph.answers",
    "Report": "dofkit.report",
    "Scene": "dofkit.scene.scene",
    "ask": "dofkit.methods.ask",
    "catalog_names": "dofkit.scene.catalog",
    "catalog_text": "dofkit.scene.catalog",
    "classify": "dofkit.methods.classify",
    "configurations": "dofkit.motion.sampled.configurations",
    "derived_flag": "dofkit.methods.classify",
    "grade": "dofkit.homework.grading",
    "lagrange": "dofkit.motion.lagrange.equations",
    "linkage": "dofkit.mobility.graph.answers",
    "load": "dofkit.scene.reading",
    "load_assignment": "dofkit.homework.assignment",
    "loads": "dofkit.scene.reading",
    "redundant_links": "dofkit.mobility.graph.answers",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'dofkit' has no attribute '{name}'")
    found = getattr(import_module(_HOMES[name]), name)
    globals()[name] = found
    return found


class _Package(ModuleType):
    """Keeps a name such as ``classify`` from being shadowed by the module of that name when it is imported."""

    def __setattr__(self, name: str, value: object) -> None:
        if name not in _HOMES or not isinstance(value, ModuleType):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES})
