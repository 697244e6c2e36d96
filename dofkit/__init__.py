"""How a mechanical system can move: degrees of freedom, constraint labels, integrability and redundancy.

>>> import dofkit
>>> dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]}).dof
1

In the order in which one meets them:

- `load`, `loads`: a scene from a file, a catalog name, a mapping or a text; `catalog_names`, `catalog_text`: the
  scenes that come with dofkit; `Scene`: what is read.
- `classify`: everything that is asked of a scene, as a `Report`; `ask`: one question; `derived_flag`: ranks of forms.
- `verify`: a second program rechecks the evidence of a report (`classify(scene, certificate=True)`).
- `lagrange`: equations of motion; `configurations`: points along a motion.
- `draw`, `animate`, `graph`, `phase`: pictures of a scene (`pip install 'dofkit[pictures]'`).
- `linkage`, `redundant_links`: graphs of links in general position, without a scene, as a `Linkage`.
- `load_assignment`, `grade`: homework.
- `DofkitError`: the base of what is raised; `SceneError` and `TextError` know their places. `__version__`.
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
    from dofkit.scene import Scene, catalog_names, catalog_text, load, loads

# In the order in which one meets them.
__all__ = ["load", "loads"]
__all__ += ["catalog_names", "catalog_text"]
__all__ += ["Scene", "classify"]
__all__ += ["Report", "ask", "derived_flag"]
__all__ += ["verify"]
__all__ += ["lagrange"]
__all__ += ["configurations"]
__all__ += ["draw"]
__all__ += ["animate", "graph", "phase"]
__all__ += ["linkage", "redundant_links"]
__all__ += ["Linkage"]
__all__ += ["load_assignment"]
__all__ += ["grade"]
__all__ += ["DofkitError", "SceneError", "TextError", "__version__"]

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
    return list(__all__)
