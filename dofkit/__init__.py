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

from typing import TYPE_CHECKING, Any

from dofkit.base.errors import DofkitError, SceneError, TextError
from dofkit.base.surface import handed_on
from dofkit.base.version import __version__

if TYPE_CHECKING:
    from dofkit.homework.assignment import load_assignment
    from dofkit.homework.grading import grade
    from dofkit.methods.ask import ask
    from dofkit.methods.certificates.verifying import verify
    from dofkit.methods.classify import classify, derived_flag
    from dofkit.mobility.graph.answers import Linkage, linkage, redundant_links
    from dofkit.motion.lagrange.equations import lagrange
    from dofkit.motion.sampled.configurations import configurations
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

#: Where names live whose modules are imported when they are first asked for.
_HOMES = {
    "load": "dofkit.scene.reading",
    "loads": "dofkit.scene.reading",
    "catalog_names": "dofkit.scene.catalog",
    "catalog_text": "dofkit.scene.catalog",
    "Scene": "dofkit.scene.scene",
    "classify": "dofkit.methods.classify",
    "Report": "dofkit.report",
    "ask": "dofkit.methods.ask",
    "derived_flag": "dofkit.methods.classify",
    "verify": "dofkit.methods.certificates.verifying",
    "lagrange": "dofkit.motion.lagrange.equations",
    "configurations": "dofkit.motion.sampled.configurations",
    "draw": "dofkit.pictures.still",
    "animate": "dofkit.pictures.animation",
    "graph": "dofkit.pictures.still",
    "phase": "dofkit.pictures.still",
    "linkage": "dofkit.mobility.graph.answers",
    "redundant_links": "dofkit.mobility.graph.answers",
    "Linkage": "dofkit.mobility.graph.answers",
    "load_assignment": "dofkit.homework.assignment",
    "grade": "dofkit.homework.grading",
}

#: What draws reports and scenes for `print` and for notebooks.
DRAWN_BY = "dofkit.interface.show.drawn"


def __getattr__(name: str) -> Any:
    found = globals()[name] = handed_on(__name__, _HOMES, name)
    return found


def __dir__() -> list[str]:
    return [*_HOMES, "DofkitError", "SceneError", "TextError", "__version__"]
