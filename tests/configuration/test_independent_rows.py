"""Rows that are independent within a tolerance: one by one, or all at once where that tells the same."""

from __future__ import annotations

import numpy as np
import pytest

from dofkit.configuration.measured.equations import independent_rows

#: With a tolerance of 1e-3 what differs by less than 3e-3 is the same.
TOLERANCE = 1e-3


@pytest.mark.parametrize(
    ("rows", "kept"),
    [
        ([[1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1]], [0, 1, 3]),
        # 1e-3 from the first row, then 1e-2 from it.
        ([[1, 0, 0], [1, 0.001, 0], [1, 0.01, 0], [0, 0, 1]], [0, 2, 3]),
        # Apart from each of the first two by 4e-3, but the least singular value is about 4e-3 / sqrt(3).
        ([[1, 0, 0], [0, 1, 0], [1, 1, 0.004], [0, 0, 1]], [0, 1, 3]),
    ],
)
def test_the_first_rows(rows: list[list[float]], kept: list[int]) -> None:
    assert independent_rows(np.array(rows, dtype=float), len(kept), TOLERANCE) == kept


def test_none_of_nothing() -> None:
    assert independent_rows(np.zeros((0, 3)), 0, TOLERANCE) == []
    assert independent_rows(np.zeros((2, 3)), 0, TOLERANCE) == []
