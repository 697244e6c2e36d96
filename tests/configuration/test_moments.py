"""Relations that hold at some times only: from when on is found together with a configuration; by hand."""

from __future__ import annotations

import pytest
from shared.known_scenes import swept

import dofkit

#: Constraints on x and y, dof and velocity_dof, why.
LATER = [
    # x^2 + y^2 >= 2 |x y|: from t = 2 |sin t| on, where t is 1.895; two relations for two coordinates
    swept(["x^2 + y^2 = t", "x*y = sin(t)"], (0, 0)),
    (["x^2 + y^2 = t - 10"], (1, 1)),
    (["x^2 = t - 3", "ydot = t"], (0, 0)),
    (["x^2 + y^2 = -t"], (1, 1)),
    (["sqrt(t - 5) = x", "x^2 = y"], (0, 0)),
    (["xdot^2 + ydot^2 = t - 5"], (2, 1)),
]
#: Those that hold at single moments, or never: no motion passes through an interval of time.
NEVER = [["x^2 + y^2 = -t^2"], ["x^2 + y^2 + t^2 + 1 = 0"], ["x*y = t", "x + y = sin(t)", "x = 2*y"]]


@pytest.mark.parametrize(("constraints", "numbers"), LATER)
def test_what_holds_from_some_time_on(constraints: list[str], numbers: tuple[int, int]) -> None:
    report = dofkit.classify({"coordinates": ["x", "y"], "constraints": constraints})
    assert (report.consistent, report.verdict, report.dof, report.velocity_dof) == (True, "proved", *numbers)


@pytest.mark.parametrize("constraints", NEVER)
def test_what_holds_at_single_moments_at_the_most(constraints: list[str]) -> None:
    assert dofkit.classify({"coordinates": ["x", "y"], "constraints": constraints}).consistent is False
