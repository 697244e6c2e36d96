"""A branch beside a measured drawing is as large as its ways where the set goes on in some of them drawn at random."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dofkit.configuration.drawing import measured_branches
from dofkit.configuration.drawing.measured_relations import MeasuredDrawing


class Plane:
    """Three relations of rank 1 in three coordinates, without motions of the whole."""

    def system(self, *_: Any) -> tuple[Any, Any]:
        return np.zeros(3), np.array([[1.0, 0, 0], [2, 0, 0], [3, 0, 0]])

    def whole(self, _: Any) -> Any:
        return np.zeros((0, 3))

    def norms(self, _: Any) -> Any:
        return np.ones(3)


@pytest.mark.parametrize(("goes_on", "told"), [(99, 2), (measured_branches.WAYS, 1), (1, 1), (0, 0)])
def test_all_ways_that_are_drawn_are_followed(goes_on: int, told: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """``goes_on``: so many paths do, that along the branch among them."""
    followed: list[None] = []

    def follow(*_: Any) -> Any:
        followed.append(None)
        number = len(followed)
        return SimpleNamespace(goes_on=lambda _: number <= goes_on)

    monkeypatch.setattr(measured_branches, "follow", follow)
    relations: Any = Plane()
    at: Any = None
    drawing = MeasuredDrawing(relations, at, relations.system()[1], 1, 1e-7)
    assert measured_branches._from(drawing, at, 1, np.array([0.0, 1, 0])) == told
