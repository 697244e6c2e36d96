"""How a mechanical system can move: degrees of freedom, constraint labels, integrability and redundancy.

>>> import dofkit
>>> dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]}).dof
1

Each name has an example: ``help(dofkit.NAME)``.

- `load`, `loads` read a `Scene`; `catalog_names`, `catalog_text`: the scenes that come with dofkit.
- `classify` reports everything about a scene in a `Report`; `ask` answers one question; `derived_flag`: ranks of forms.
- `verify` checks the evidence of a report (``classify(scene, certificate=True)``) with an independent program.
- `lagrange` derives equations of motion; `configurations` samples a motion.
- `draw`, `animate`, `graph`, `phase` are pictures of a scene, its motion, its constraints and its growth vector.
- `linkage`, `redundant_links` analyse graphs of links in general position; the answer is a `Linkage`.
- `load_assignment`, `grade`: homework.
- `DofkitError` is the base of all errors; `SceneError` and `TextError` give the location of each fault.
- `__version__`: the version of dofkit.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import lazy_loader as lazy

from dofkit.base import __version__
from dofkit.base.errors import DofkitError, SceneError, TextError

if TYPE_CHECKING:
    from dofkit.homework.assignment import load_assignment
    from dofkit.homework.grading import grade
    from dofkit.methods.ask import ask
    from dofkit.methods.classify import classify, derived_flag
    from dofkit.methods.verify import verify
    from dofkit.mobility.graph.linkage import Linkage, linkage, redundant_links
    from dofkit.motion.configurations import configurations
    from dofkit.motion.lagrange.equations import lagrange
    from dofkit.pictures.animation import animate
    from dofkit.pictures.still import draw, graph, phase
    from dofkit.report import Report
    from dofkit.scene.catalog import catalog_names, catalog_text
    from dofkit.scene.reading import load, loads
    from dofkit.scene.scene import Scene

#: What ``from dofkit import *`` imports and ``help(dofkit)`` describes; ``dir(dofkit)`` lists every public name.
__all__ = ["animate", "ask", "classify", "draw", "grade", "lagrange", "load"]
if TYPE_CHECKING:
    __all__ += ["DofkitError", "Linkage", "Report", "Scene", "SceneError", "TextError", "__version__"]
    __all__ += ["catalog_names", "catalog_text", "configurations", "derived_flag", "graph", "load_assignment", "loads"]
    __all__ += ["linkage", "phase", "redundant_links", "verify"]

#: The modules of names, imported when one of these is first asked for (SPEC 1).
_MODULES = {
    "homework.assignment": ["load_assignment"],
    "homework.grading": ["grade"],
    "methods.ask": ["ask"],
    "methods.classify": ["classify", "derived_flag"],
    "methods.verify": ["verify"],
    "mobility.graph.linkage": ["Linkage", "linkage", "redundant_links"],
    "motion.lagrange.equations": ["lagrange"],
    "motion.configurations": ["configurations"],
    "pictures.animation": ["animate"],
    "pictures.still": ["draw", "graph", "phase"],
    "report": ["Report"],
    "scene.catalog": ["catalog_names", "catalog_text"],
    "scene.reading": ["load", "loads"],
    "scene.scene": ["Scene"],
}

#: What draws reports and scenes for `print` and for notebooks.
DRAWN_BY = "dofkit.interface.show.drawn"

__getattr__, _dir, _ = lazy.attach(__name__, submod_attrs=_MODULES)


def __dir__() -> list[str]:
    return [*_dir(), "DofkitError", "SceneError", "TextError", "__version__"]
