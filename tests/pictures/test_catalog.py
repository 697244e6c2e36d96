"""Every scene of the catalog is drawn as its system, and its picture changes no answer."""

from __future__ import annotations

import numpy as np
import pytest

import dofkit
from dofkit.pictures.stage import POINT

NAMES = dofkit.catalog_names()
#: Relations between coordinates that mean nothing further: their sets.
SETS = {"holonomic-definition", "velocities-that-integrate", "x-dy-plus-y-dx"}


def _check(name: str) -> None:
    scene = dofkit.load(name)
    picture = dofkit.draw(scene)
    kinds = {s.role for s in picture.sketch.shapes}
    assert "node" not in kinds
    assert (POINT in {v.carrier for s in picture.sketch.shapes for v in s.vertices}) == (name in SETS)
    assert all(np.all(np.isfinite(mark.positions)) for mark in picture.page.marks)
    if scene.picture:
        assert dofkit.classify(scene) == dofkit.classify(scene.model_copy(update={"picture": ()}))


@pytest.mark.parametrize("name", NAMES[::12])
def test_a_scene_is_drawn_as_its_system(name: str) -> None:
    _check(name)


@pytest.mark.sweep
@pytest.mark.parametrize("name", NAMES)
def test_every_scene_is_drawn_as_its_system(name: str) -> None:
    _check(name)
