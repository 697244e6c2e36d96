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

from dofkit.base.version import __version__
from dofkit.errors import DofkitError, SceneError, TextError

if TYPE_CHECKING:
    from dofkit.asking import ask
    from dofkit.catalog import catalog_names, catalog_text
    from dofkit.classify import classify, derived_flag
    from dofkit.homework.assignment import load_assignment
    from dofkit.homework.grading import grade
    from dofkit.lagrange import lagrange
    from dofkit.linkage import Linkage, linkage, redundant_links
    from dofkit.reading import load, loads
    from dofkit.report import Report
    from dofkit.sampling import configurations
    from dofkit.scene import Scene

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
    "Linkage": "dofkit.linkage",
    "Report": "dofkit.report",
    "Scene": "dofkit.scene",
    "ask": "dofkit.asking",
    "catalog_names": "dofkit.catalog",
    "catalog_text": "dofkit.catalog",
    "classify": "dofkit.classify",
    "configurations": "dofkit.sampling",
    "derived_flag": "dofkit.classify",
    "grade": "dofkit.homework.grading",
    "lagrange": "dofkit.lagrange",
    "linkage": "dofkit.linkage",
    "load": "dofkit.reading",
    "load_assignment": "dofkit.homework.assignment",
    "loads": "dofkit.reading",
    "redundant_links": "dofkit.linkage",
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
