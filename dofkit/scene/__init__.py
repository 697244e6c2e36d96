"""What a person writes, read with every fault in its place, and made into a `System`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.scene.catalog import catalog_names, catalog_text
    from dofkit.scene.lowering import lower
    from dofkit.scene.reading import load, loads
    from dofkit.scene.scene import Scene

__all__ = ["Scene", "catalog_names", "catalog_text", "load", "loads", "lower"]

#: What is handed on, imported when it is first asked for.
_HOMES = {
    "Scene": "dofkit.scene.scene",
    "catalog_names": "dofkit.scene.catalog",
    "catalog_text": "dofkit.scene.catalog",
    "load": "dofkit.scene.reading",
    "loads": "dofkit.scene.reading",
    "lower": "dofkit.scene.lowering",
}


def __getattr__(name: str) -> Any:
    found = globals()[name] = handed_on(__name__, _HOMES, name)
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
