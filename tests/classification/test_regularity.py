"""Is an answer with the same solutions as good a constraint? What was not seen is not called regular."""

from __future__ import annotations

import pytest

import dofkit
from dofkit.classification.dependence import regularity
from dofkit.classification.dependence.regularity import Regularity
from dofkit.classification.freedom.preparation import prepared
from dofkit.configuration.variety import Variety
from dofkit.scene.lowering import lower


def regular(wanted: str, given: str) -> Regularity:
    """What was asked for and an answer, both without notes on how they were read."""
    reduced, setting = prepared(lower(dofkit.load({"coordinates": ["x", "y"], "constraints": [wanted, given]})))
    return Regularity((), reduced[0].normals, [reduced[1]], setting, ["x", "y"])


def test_two_ways_to_write_a_circle_are_regular() -> None:
    assert regular("x^2 + y^2 = 1", "2 x^2 + 2 y^2 = 2").irregular() is False


def test_without_a_point_it_is_not_decided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(regularity, "find", lambda *_: Variety(None, None, "undecided"))
    assert regular("x^2 + y^2 = 1", "2 x^2 + 2 y^2 = 2").irregular() is None


def test_more_branches_than_are_looked_at_are_not_decided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(regularity, "MAX_BRANCHES", 1)
    assert regular("x y = 0", "2 x y = 0").irregular() is None
