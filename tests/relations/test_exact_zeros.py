"""Functions of one coordinate that vanish at one value only, together with other equations; all answers by hand."""

from __future__ import annotations

from typing import Any

import pytest
from shared.known_scenes import swept

import dofkit


@pytest.mark.parametrize(
    ("constraints", "expected"),
    [
        (["x = sin(x)"], {"consistent": True, "dof": 1, "redundant": []}),
        (["x = sin(x)", "x = 0"], {"dof": 1}),  # each implies the other
        (["x = 0", "x = sin(x)"], {"dof": 1, "redundant": ["c2"]}),
        (["x = 2 sin(x)", "x = 0"], {"dof": 1, "redundant": ["c1"]}),
        swept(["x = sin(x)", "y = sin(y)", "x = y"], {"dof": 0}),  # any one of them is implied by the others
        (["x = sin(x)", "x = 1"], {"consistent": False, "dof": None}),
    ],
    ids="; ".join,
)
def test_it_is_that_value_or_undecided(constraints: list[str], expected: dict[str, Any]) -> None:
    report = dofkit.classify({"coordinates": ["x", "y"], "constraints": constraints})
    assert all(getattr(report, name) in (value, None) for name, value in expected.items())
