"""Inequalities by themselves: consistent where a point is shown, inconsistent where it is proved, else open."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

import dofkit
from dofkit.expressions import tree as ex
from dofkit.relations.normal import no_solution
from dofkit.report import Report

#: Inequalities, each worked out by hand.
CASES = yaml.safe_load(Path(__file__).with_name("inequalities.yaml").read_text(encoding="utf-8"))


def classified(*texts: str) -> Report:
    made = {
        "coordinates": ["x", "y", "z"],
        "parameters": {"L": "positive"},
        "functions": {"h": ["s"]},
        "constraints": [*texts],
    }
    return dofkit.classify(dofkit.load(made))


@pytest.mark.parametrize("text", CASES["nowhere"])
def test_what_holds_nowhere_is_inconsistent(text: str) -> None:
    report = classified(text)
    assert (report.consistent, report.conflicting, report.dof) == (False, ["c1"], None)


@pytest.mark.parametrize("text", CASES["somewhere"])
def test_what_holds_somewhere_is_consistent(text: str) -> None:
    report = classified(text)
    sure = [report.verdicts[name].verdict for name in ("consistent", "dof")]
    assert (report.consistent, sure, report.dof) == (True, ["proved", "proved"], 3)


def test_what_may_be_undecided_is_not_called_consistent() -> None:
    """sin(x) + cos(x) is at most sqrt(2)."""
    assert classified("sin(x) + cos(x) >= 1.4143").consistent is not True


@pytest.mark.parametrize(
    ("text", "scleronomic"),
    [
        ("xdot^7 + ydot^7 = zdot^7", True),  # homogeneous, of a degree that is not tried but read off
        ("sqrt(xdot^2 + ydot^2 + zdot^2) = 2 zdot - xdot^3/zdot^2", True),  # degree 1, of a quotient
        ("xdot^2 + ydot^2 = 1", True),  # acatastatic, and t does not occur
        ("xdot^2 + ydot^2 = zdot", True),
        ("exp(t) (xdot^3 + ydot^3 - 2 zdot^3) = 0", True),  # a factor without zeros carries the time
        ("xdot^3 + ydot^3 = t zdot^3", False),
        ("(x - t) (xdot + y zdot) = 0", False),  # x = t is a branch
        ("x >= t", False),
        ("exp(t) x >= 0", True),
    ],
)
def test_time_enters_where_a_point_shows_it(text: str, scleronomic: bool) -> None:
    entry = classified(text).constraints[0]
    assert entry.scleronomic is scleronomic


def test_a_factor_without_zeros_is_not_said_to_carry_the_time() -> None:
    """x^4 - x t + t^4 + 10 is at least 9.875."""
    assert classified("(x^4 - x t + t^4 + 10) (xdot + y zdot) = 0").constraints[0].scleronomic in (True, None)


def test_so_many_points_are_tried_as_are_told() -> None:
    """The simple ones, then two kinds at each draw."""
    tried = list(no_solution._points(ex.coordinate("x"), frozenset()))
    assert len(tried) == len(no_solution._SIMPLE) + 2 * no_solution.POINTS
