"""What seems to follow near a drawing: at all points that are found, at least half of them away from it."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.classification.freedom.preparation import prepared
from dofkit.configuration import implied_relations
from dofkit.configuration.implied_relations import BESIDE, ImpliedRelations
from dofkit.relations.blocks import Block, Row, make_chart
from dofkit.scene.lowering import lower


@pytest.mark.parametrize(("away", "seems"), [(BESIDE, True), (BESIDE // 2, True), (BESIDE // 2 - 1, False)])
def test_half_of_the_points_that_are_found_are_away_from_the_drawing(
    away: int, seems: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Found:
        """A search that stays at the drawing for all but the first seeds."""

        def __init__(self, *_: Any) -> None:
            pass

        def start(self, seed: int, _: Any) -> dict[Any, float]:
            return dict.fromkeys(chart.symbols, 1.0 if seed < away else 0.0)

        def descend(self, *_: Any) -> bool:
            return True

    scene = {"coordinates": ["x", "y"], "constraints": ["x - y = 0"], "configuration": {"x": 1, "y": 1}}
    reduced, setting = prepared(lower(dofkit.load(scene)))
    rows = tuple(Row(0, piece) for piece in reduced[0].normals[0].branches[0])
    chart = make_chart(Block(("x", "y"), rows), setting)
    assert setting.reference is not None
    monkeypatch.setattr(implied_relations, "RealSearch", Found)
    assert ImpliedRelations(chart, setting, setting.reference).seem_to_follow([0], [0]) is seems
