"""What follows from other constraints where no rank tells it: constraints are left out one by one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import pytest

import dofkit
from dofkit.classification.dependence import by_implication
from dofkit.classification.dependence.circuits import OwnedRows, _Basis, analyse


@pytest.mark.parametrize(("most", "redundant"), [(2, ["c1"]), (1, None)])
def test_as_many_are_left_out_as_are_allowed(
    most: int, redundant: list[str] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """x y = 0 follows from x = 0; of more constraints than are tried it is left open."""
    monkeypatch.setattr(by_implication, "MAX_CHOICES", most)
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": ["x y = 0", "x = 0", "z = 0"]})
    assert report.redundant == redundant


class BothNeeded:
    """The last of three relations follows from the two others together, though it depends on the first at the point."""

    def follows(self, row: int, others: Sequence[int]) -> bool:
        return {0, 1} <= set(others)

    seems = follows

    def needed(self, row: int, others: Sequence[int]) -> list[int]:
        return list(others)

    def beside(self, rows: Iterable[int]) -> set[int]:
        return {0, 1, 2}

    within = beside


def test_a_relation_follows_from_what_implies_it_and_from_no_less() -> None:
    rows = OwnedRows([{0: 1}, {1: 1}, {0: 1}], [0, 1, 2], [True] * 3, 101, implication=BothNeeded())
    basis = _Basis(rows)
    assert basis.implies({0, 1}, 2)
    assert not basis.implies({0}, 2)
    assert not basis.implies({1}, 2)
    assert analyse([rows]).circuits == {2: [0, 1]}
