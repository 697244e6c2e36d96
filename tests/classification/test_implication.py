"""What follows from other constraints where no rank tells it: constraints are left out one by one."""

from __future__ import annotations

import pytest

import dofkit
from dofkit.classification.dependence import by_implication


@pytest.mark.parametrize(("most", "redundant"), [(2, ["c1"]), (1, None)])
def test_as_many_are_left_out_as_are_allowed(
    most: int, redundant: list[str] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """x y = 0 follows from x = 0; of more constraints than are tried it is left open."""
    monkeypatch.setattr(by_implication, "MAX_CHOICES", most)
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": ["x y = 0", "x = 0", "z = 0"]})
    assert report.redundant == redundant
