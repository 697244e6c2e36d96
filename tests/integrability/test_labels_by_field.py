"""Whether a row integrates beside the others: it annihilates all that the others leave of the Lie algebra."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from dofkit.integrability.row_labels import _modulo_the_others


@pytest.mark.parametrize(
    ("vectors", "integrates"),
    [
        ([[0, 0, 1]], True),
        ([[0, 0, 1], [0, 1, 0]], True),
        ([[0, 0, 1], [1, 0, 0]], False),
        ([[1, 0, 0], [0, 0, 1]], False),
        ([[1, 0, 0]], False),
        ([[1, 1, 0], [0, 1, 0]], False),
    ],
)
def test_a_row_beside_another(vectors: list[list[int]], integrates: bool) -> None:
    """dx beside dy, in the span of all brackets: dx vanishes on what dy leaves, or not."""
    sampled: Any = SimpleNamespace(matrix=[[1, 0, 0], [0, 1, 0]], span=SimpleNamespace(vectors=vectors))
    assert _modulo_the_others(0, sampled, 101) is integrates
