"""Angles that come out as fractions of pi on the set, though no sine or cosine of such a fraction is written."""

from __future__ import annotations

import pytest

import dofkit

#: (relations between x, y and z, which one can go): each follows from the others by hand.
FOLLOWING = [
    (["x = pi/2", "sin(x) = 1"], "c2"),
    (["sin(x) = 0", "x = pi"], "c1"),
    (["x = y + pi", "cos(x) + cos(y) = 0"], "c2"),
    (["x = y + pi/2", "sin(x) = cos(y)"], "c2"),
    (["sin(x - y) = 0", "x = y - pi"], "c1"),
    (["x = pi/4", "tan(x) = 1"], "c2"),
    (["x = pi/3", "2*cos(x) = 1"], "c2"),
    (["x = pi + t", "y = cos(x) + cos(t)", "y = 0"], "c3"),
    # sin(3 x) = 3 sin(x) - 4 sin(x)^3, at 20 degrees
    (["x = pi/9", "3*sin(x) - 4*sin(x)^3 = sqrt(3)/2"], "c2"),
]
NOWHERE = [
    ["x = pi/2", "sin(x) = -1"],
    ["x = pi/3", "2*cos(x) = -1"],
    ["x = pi/4", "tan(x) = -1"],
    ["x = pi/9", "3*sin(x) - 4*sin(x)^3 = -sqrt(3)/2"],
]


def _report(relations: list[str]) -> dofkit.Report:
    return dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": relations})


@pytest.mark.parametrize(("relations", "gone"), FOLLOWING, ids=[" ".join(r) for r, _ in FOLLOWING])
def test_what_follows_can_go(relations: list[str], gone: str) -> None:
    report = _report(relations)
    assert report.consistent is True
    assert report.dof == 3 - len(relations) + 1
    assert report.redundant == [gone]


@pytest.mark.parametrize("relations", NOWHERE, ids=" ".join)
def test_the_opposite_is_never_said_to_hold(relations: list[str]) -> None:
    assert not _report(relations).consistent


def test_a_double_zero_at_a_fraction_of_pi_is_never_denied() -> None:
    """At x = pi/14 sin(7 x) is 1, its maximum: the second relation follows, with a gradient of 0 there."""
    report = _report(["2*x = pi/7", "sin(7*x) = 1"])
    assert report.consistent in (True, None)
    assert report.dof in (2, None)


def test_a_sum_that_is_no_multiple_of_the_others_takes_freedom_away() -> None:
    """Beside x = y + pi, cos(x) = cos(y) says cos(y) = 0."""
    report = _report(["x = y + pi", "cos(x) = cos(y)"])
    assert (report.consistent, report.dof, report.redundant) == (True, 1, [])
