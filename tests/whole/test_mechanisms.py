"""The named linkages and mechanisms: each has its source, exact geometry, and answers that were derived by hand."""

from __future__ import annotations

from pathlib import Path

import pytest
from shared.known_scenes import SCENES, scene_of, stem

from dofkit.scene.lowering import lower

MECHANISMS = [path for path in SCENES if path.parent.name == "mechanisms"]
#: Drawn nowhere: lengths in general position, or only constraints.
UNDRAWN = {"jansen-leg", "klann-leg"}


@pytest.mark.parametrize("path", MECHANISMS, ids=stem)
def test_a_mechanism_has_its_source_its_geometry_and_its_answers(path: Path) -> None:
    scene = scene_of(path)
    assert scene.title
    assert scene.source
    assert scene.notes
    assert len(scene.notes) > 40
    expect = dict(scene.expect)
    assert {"dof", "velocity_dof", "consistent"} <= expect.keys()
    if path.stem not in UNDRAWN:
        assert lower(scene).reference is not None
        assert expect["consistent"] is False or {"instantaneous_dof", "singular"} <= expect.keys()
    assert scene.tolerance is None


def test_there_are_many() -> None:
    assert len(MECHANISMS) >= 85
    assert {p.stem for p in MECHANISMS} >= UNDRAWN
