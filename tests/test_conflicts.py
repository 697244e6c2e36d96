"""Conflicting sets: they conflict, and without any one of their members they do not."""

from __future__ import annotations

import time
from typing import Any

import pytest

import dofkit


def classified(coordinates: list[str], constraints: list[Any]) -> dofkit.Report:
    return dofkit.classify(dofkit.load({"coordinates": coordinates, "constraints": constraints}))


#: (coordinates, constraints, the only minimal set, why)
TABLE: list[tuple[str, list[str], list[str], str]] = [
    ("x y z", ["x = 1", "y = 2", "x = 3", "z = x"], ["c1", "c3"], "1 is not 3"),
    ("x y", ["x y = 0", "x = 1", "y = 1"], ["c1", "c2", "c3"], "any two hold together"),
    ("x y", ["x (x - 1) = 0", "x = 2", "y = 1"], ["c1", "c2"], "on both branches"),
    ("x y z", ["x^2 + y^2 = 1", "z = 4", "(x - 5)^2 + y^2 = 1"], ["c1", "c3"], "two circles apart"),
    ("x y z", ["z = x + y", "x^2 + y^2 + z^2 = 1", "x = 2"], ["c2", "c3"], "outside the sphere"),
    ("x y z", ["x + y = 1", "y + z = 1", "x - z = 1"], ["c1", "c2", "c3"], "the third less the difference is 1 = 0"),
    ("x y z", ["x = t^2", "z = y", "xddot = 0"], ["c1", "c3"], "prolonged twice: 2 = 0"),
    ("x y z", ["x = t", "z = 0", "xdot = 2"], ["c1", "c3"], "1 is not 2"),
    ("x y z", ["xdot = y", "z = 0", "ydot = 1", "x = 0"], ["c1", "c3", "c4"], "x = 0, so y = 0, so 1 = 0"),
    ("x y", ["sqrt(x) y = 0", "x = -1"], ["c1", "c2"], "no root of -1"),
    ("x y", ["x + abs(x) = 0", "y = 0", "x = 1"], ["c1", "c3"], "x <= 0"),
    ("x y z", ["z = 1", "x^2 + 1 = 0", "y = 2"], ["c2"], "alone"),
]


@pytest.mark.parametrize(("coordinates", "constraints", "expected", "why"), TABLE, ids=["; ".join(r[1]) for r in TABLE])
def test_conflicting_sets(coordinates: str, constraints: list[str], expected: list[str], why: str) -> None:
    assert why
    report = classified(coordinates.split(), list(constraints))
    assert (report.consistent, report.conflicting) == (False, expected)


@pytest.mark.parametrize(("coordinates", "constraints", "expected", "why"), TABLE, ids=["; ".join(r[1]) for r in TABLE])
def test_without_any_member_the_set_holds(
    coordinates: str, constraints: list[str], expected: list[str], why: str
) -> None:
    assert why
    members = [constraints[int(name[1:]) - 1] for name in expected]
    for left_out in members:
        rest = [text for text in members if text != left_out]
        assert classified(coordinates.split(), list(rest)).consistent is True


def test_unrelated_constraints_are_left_alone() -> None:
    """Forty pairs that have nothing to do with the two circles between them."""
    others = [f"p{i}^2 + q{i}^2 = {i + 1}" for i in range(40)]
    names = ["x", "y", *(f"{c}{i}" for i in range(40) for c in "pq")]
    start = time.process_time()
    report = classified(names, [*others[:20], "x^2 + y^2 = 1", *others[20:], "(x - 5)^2 + y^2 = 1"])
    assert report.conflicting == ["c21", "c42"]
    assert time.process_time() - start < 20


def test_a_long_chain_is_cut_down_to_its_conflict() -> None:
    """x0 = 0, x1 = x0 + 1, ..., x80 = x79 + 1 with x40 = 0: only the first forty-one steps are in conflict."""
    steps = ["x0 = 0", *(f"x{i} = x{i - 1} + 1" for i in range(1, 81))]
    report = classified([f"x{i}" for i in range(81)], [*steps, "x40 = 0"])
    assert report.consistent is False
    assert report.conflicting == [*(f"c{i}" for i in range(1, 42)), "c82"]
