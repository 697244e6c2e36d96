"""Roots beside inequalities: the branch that a root loses may be forbidden anyway."""

from __future__ import annotations

import pytest

import dofkit
from dofkit.classification.dependence.equivalence import Sameness, compare
from dofkit.scene.lowering import lower


def sameness(side: str, answer: str) -> Sameness:
    """How an answer compares with x^2 + y^2 = 4 beside an inequality."""
    scene = dofkit.load({"coordinates": ["x", "y"], "constraints": [side, "x^2 + y^2 = 4", answer]})
    return compare(lower(scene), [1], [2]).sameness


@pytest.mark.parametrize(
    ("side", "answer", "told"),
    [
        ("y >= 0", "y = sqrt(4 - x^2)", Sameness.SAME),
        ("-3 y <= 0", "y/2 = sqrt(1 - x^2/4)", Sameness.SAME),
        ("y <= 0", "y = -sqrt(4 - x^2)", Sameness.SAME),
        ("y >= 0", "y = -sqrt(4 - x^2)", Sameness.UNDECIDED),
        ("y >= 0", "x = sqrt(4 - y^2)", Sameness.UNDECIDED),
        ("y >= -1", "y = sqrt(4 - x^2)", Sameness.UNDECIDED),
        ("y >= 0", "y = sqrt(3 - x^2)", Sameness.DIFFERENT),
    ],
)
def test_the_lost_branch_counts_where_it_is_allowed(side: str, answer: str, told: Sameness) -> None:
    assert sameness(side, answer) is told
