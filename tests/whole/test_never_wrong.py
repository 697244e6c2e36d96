"""Answers by hand where an easy way goes wrong: branches, real sets, impossible motions, units, hidden zeros.

An answer may be undecided (None) where that is said; it may never be wrong.
"""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.report import Report


def classified(**scene: Any) -> Report:
    return dofkit.classify(dofkit.load(scene))


@pytest.mark.parametrize(
    ("constraints", "at", "freedom", "first_order"),
    [
        (["x y = 0", "x z = 0"], (1, 0, 0), 1, 1),  # near it x is not 0, so y = z = 0
        (["x y = 0", "x z = 0"], (0, 1, 0), 2, 2),  # the plane x = 0
        (["x y = 0", "z = 0"], (1, 0, 0), 1, 1),
        (["x y = 0", "z = 0"], (0, 0, 0), 1, 2),  # two lines cross
        (["x^2 - y^2 = 0", "z = 0"], (1, -1, 0), 1, 1),
        (["x^2 + y^2 + z^2 = 1"], (0, 0, 1), 2, 2),
        (["x^2 + y^2 + z^2 = 1", "z = 1"], (0, 0, 1), 0, 2),  # a tangent plane
        (["z = x y", "z = 0"], (0, 2, 0), 1, 1),
    ],
)
def test_the_configuration_says_which_branch(
    constraints: list[str], at: tuple[int, int, int], freedom: int, first_order: int
) -> None:
    configuration = dict(zip("xyz", at, strict=True))
    report = classified(coordinates=["x", "y", "z"], configuration=configuration, constraints=constraints)
    assert (report.consistent, report.dof) == (True, freedom)
    assert report.instantaneous_dof in (first_order, None)
    assert report.singular in (freedom != first_order, None)


@pytest.mark.parametrize(
    ("constraints", "freedom"),
    [
        (["sqrt(-x) = 1"], 1),  # x = -1
        (["log(-x) = y"], 1),
        (["sqrt(x y) = 1", "x = -2"], 0),  # y = -1/2
        (["log(x y) = 0", "x = -2"], 0),
        (["sin(1e9 x) = y"], 1),
        (["x^(2/3) = x^(1/3)"], 1),  # x = 0 or x = 1
        (["x^(1/3) = -2"], 1),
        (["abs(x) + abs(y) = 1"], 1),
        (["abs(x) = x"], 2),
        (["x^3 = y^2"], 1),
        (["x^2 + x y + y^2 = 0"], 0),
        (["x^2 + y^2 = 1", "x + y = sqrt(2)"], 0),  # a tangent
        (["x^2 = 2", "x = sqrt(2)"], 1),
        (["(x^2 + y^2 - 1)^2 + (x - y)^2 = 0"], 0),
    ],
)
def test_real_sets_of_the_plane(constraints: list[str], freedom: int) -> None:
    report = classified(coordinates=["x", "y"], constraints=constraints)
    assert (report.consistent, report.dof) in ((True, freedom), (True, None), (None, None))


@pytest.mark.parametrize(
    "constraints",
    [
        ["exp(-200 x) = 0"],
        ["y = 0", "y + exp(-200 x) = 0"],
        ["y/x = 1", "x = 0"],
        ["x y = 1", "x = 0"],
        ["atan(x) = 2"],
        ["cosh(x) = 1/2"],
        ["x^2 + y^2 = 1", "x + y = 2"],
        ["x^2 + y^2 = 1", "x^2 + y^2 = 4"],
        ["x = 1", "x = 1 + 1e-30"],
        ["x^2 = 2", "x = 1.41421356"],
        ["exp(x) = x"],
        ["x = t", "x = 2 t"],
        ["x = t", "xdot = 2"],
        ["xdot^2 + ydot^2 = 1", "xdot = 2"],
        ["tanh(x) = 1"],
    ],
)
def test_what_no_motion_satisfies_is_never_called_consistent(constraints: list[str]) -> None:
    report = classified(coordinates=["x", "y"], constraints=constraints)
    assert report.consistent is not True
    assert report.dof is None


@pytest.mark.parametrize("size", ["1e-9", "1e-3", "1000", "5000", "1e6", "1e12"])
@pytest.mark.parametrize(
    ("constraints", "freedom"),
    [
        (["x = {0}"], 1),
        (["x + {0} t = 1"], 1),
        (["x^2 + y^2 = {0}"], 1),
        (["(x - {0})^2 + (y - 2*{0})^2 = {0}^2"], 1),
        (["x y = {0}"], 1),
        (["x = {0} sin(t)", "y = {0} cos(t)"], 0),
        (["exp(x) = {0}"], 1),
        (["{0} x + y = 1"], 1),
    ],
)
def test_units_do_not_matter(constraints: list[str], freedom: int, size: str) -> None:
    report = classified(coordinates=["x", "y"], constraints=[text.format(f"({size})") for text in constraints])
    assert (report.consistent, report.dof, report.velocity_dof) == (True, freedom, freedom)


@pytest.mark.parametrize("zero", ["atan(1) - pi/4", "cos(pi/5) - (1 + sqrt(5))/4", "sqrt(3 + 2 sqrt(2)) - 1 - sqrt(2)"])
def test_hidden_zeros_make_no_label_wrong(zero: str) -> None:
    """The coefficient is 0 in every case."""
    rolling = classified(coordinates=["x", "y"], constraints=[f"dx + ({zero}) dt = 0"]).constraints[0]
    closed = classified(coordinates=["x", "y"], constraints=[f"dx + (1 + ({zero}) x) dy = 0"]).constraints[0]
    finite = classified(coordinates=["x", "y"], constraints=[f"x + ({zero}) t = 1"]).constraints[0]
    assert rolling.scleronomic is not False
    assert rolling.catastatic is not False
    assert closed.exact is not False
    assert finite.scleronomic is not False
