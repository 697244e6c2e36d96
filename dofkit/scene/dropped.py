"""A scene without some of its constraints."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.base.arguments import require_one_of
from dofkit.scene.scene import Scene


def without(scene: Scene, names: Sequence[str]) -> Scene:
    """The scene without the constraints of these names; the others keep theirs, those given by position too.

    What the scene expects goes as well. Raises ArgumentError, with the nearest name, for one that is no
    constraint's.

    >>> import dofkit
    >>> scene = dofkit.load({"coordinates": ["x", "y"], "constraints": ["x = 1", "y = 2", "x = y"]})
    >>> [c.name for c in without(scene, ["c2"]).constraints]
    ['c1', 'c3']
    """
    named = {c.name or f"c{i}": c for i, c in enumerate(scene.constraints, 1)}
    for name in names:
        require_one_of(name, named, "constraint")
    kept = tuple(c.model_copy(update={"name": name}) for name, c in named.items() if name not in names)
    return scene.model_copy(update={"constraints": kept, "expect": {}})
