"""Chosen coordinates are independent at the drawing too, not only beside it."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit

#: A jib that turns about the tower, a trolley on it, and the cable.
CRANE: list[dict[str, Any]] = [
    {"type": "revolute", "between": ["ground", "jib"], "at": [0, 0, 10], "axis": [0, 0, 1]},
    {"type": "prismatic", "between": ["jib", "trolley"], "axis": [1, 0, 0]},
    {"type": "link", "between": [{"on": "trolley", "at": [4, 0, 10]}, "hook"]},
]


def crane(hook: list[float]) -> dict[str, Any]:
    return {"particles": [{"name": "hook", "at": hook}], "bodies": ["jib", "trolley"], "constraints": CRANE}


def test_a_hook_that_hangs_straight_down_is_not_placed_by_its_height() -> None:
    """dz = 0 there to first order, whatever the crane does; its place from above, the jib and the trolley are free."""
    report = dofkit.classify(crane([4, 0, 2]))
    assert report.dof == 4
    assert report.generalized_coordinates == ["x_hook", "y_hook", "psi_jib", "x_trolley"]


def test_a_hook_that_hangs_aslant_may_be() -> None:
    report = dofkit.classify(crane([7, 0, 6]))
    assert report.dof == 4
    assert report.generalized_coordinates == ["x_hook", "y_hook", "z_hook", "psi_jib"]


@pytest.mark.parametrize(
    ("at", "free"), [([1, 0], "y_P"), ([0, 1], "x_P"), (["3/5", "4/5"], "x_P")], ids=["right", "top", "between"]
)
def test_beside_a_form_a_circle_is_told_by_what_changes_along_it(at: list[Any], free: str) -> None:
    report = dofkit.classify(
        {
            "dimension": 2,
            "particles": [{"name": "P", "at": at}],
            "coordinates": ["q", "r"],
            "constraints": ["x_P^2 + y_P^2 = 1", "qdot = y_P rdot"],
            "configuration": {"q": 0, "r": 0},
        }
    )
    assert report.dof == 3
    assert report.generalized_coordinates == [free, "q", "r"]
