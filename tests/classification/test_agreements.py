"""Fields that must agree: every law fails where it is broken, and what contradicts each other is not told."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from typing import Any

import pytest

import dofkit
from dofkit.classification.passes import AGREEMENTS, agreed
from dofkit.report import Report

#: One holonomic form, and an equation too many: freedom 2 of 4, c3 follows from c1.
SCENE = {"coordinates": ["x", "y", "z", "w"], "constraints": ["x = y", "z dw + w dz = 0", "2 x = 2 y"]}
#: What breaks a law: other values of fields of the report, and of the entry of c3.
BREAKS: dict[str, tuple[Mapping[str, Any], Mapping[str, Any]]] = {
    "the velocity freedom exceeds": ({"velocity_dof": 3}, {}),
    "as many equations are redundant": ({"redundancies": []}, {}),
    "a circuit belongs": ({}, {"circuit": ["c3"]}),
    "the growth vector begins": ({"growth_vector": [2, 3]}, {}),
    "there are as many generalized coordinates": ({"generalized_coordinates": ["x"]}, {}),
}


def told() -> dict[str, Any]:
    report = dofkit.classify(SCENE)
    return {name: getattr(report, name) for name in Report.model_fields}


def broken(law: str) -> dict[str, Any]:
    """What is told with one law broken."""
    found, (fields, entry) = told(), BREAKS[law]
    first, second, third = found["constraints"]
    return {**found, **fields, "constraints": [first, second, third.model_copy(update=dict(entry))]}


def test_what_agrees_is_left_alone(caplog: pytest.LogCaptureFixture) -> None:
    assert agreed(told()) == told()
    assert not caplog.records


@pytest.mark.parametrize("law", BREAKS)
def test_a_broken_law_is_logged_and_its_fields_are_withheld(law: str, caplog: pytest.LogCaptureFixture) -> None:
    (row,) = [row for row in AGREEMENTS if row.law.startswith(law)]
    with caplog.at_level(logging.ERROR):
        left = agreed(broken(law))
    assert any("defect" in record.getMessage() for record in caplog.records)
    assert left["verdict"] == "undecided"
    assert all(left[name] in (None, []) for name in row.fields)
    withheld = [entry.independent for entry in left["constraints"]] == [None] * 3
    assert withheld == ("redundancies" in row.fields)
    assert any(row.law in line for line in left["warnings"])


def on(*curve: str) -> dict[str, Any]:
    return {"type": "on", "members": ["A"], "curve": [*curve]}


#: Equations of a particle (x, y, z) and of u, v: how many are independent of each constraint, and what can be dropped.
COUNTED: dict[str, tuple[list[Any], list[int], list[str], list[int]]] = {
    "2 x = 0 follows from x = 0, and u^2 + v^2 = 0 takes two freedoms": (
        [on("x = 0", "2 x = 0"), "u^2 + v^2 = 0"], [1, 1], [], [1]
    ),
    "x = y = 0 is stated twice, and implies the product that is written first": (
        ["x - y = 0", "x^2 = 0", on("x y z = 0", "x^2 = 0", "y = 0")], [1, 1, 0], ["c1", "c2"], [3]
    ),
    "x = abs(x) takes no freedom away": ([on("x abs(x) - y = 0", "x - abs(x) = 0"), "dx = 0"], [1, 1], [], [1]),
}  # fmt: skip


@pytest.mark.parametrize("case", COUNTED)
def test_groups_hold_the_equations_that_are_not_independent(case: str, caplog: pytest.LogCaptureFixture) -> None:
    constraints, independent, redundant, nullities = COUNTED[case]
    report = classified(constraints)
    assert [entry.independent for entry in report.constraints] == independent
    assert report.redundant == redundant
    assert [group.nullity for group in report.redundancies] == nullities
    assert not caplog.records


def test_an_equation_of_a_whole_region_contradicts_nothing(caplog: pytest.LogCaptureFixture) -> None:
    report = classified(["abs(x + abs(x)) = 0"])
    assert (report.dof, report.redundant_equations, report.redundant) == (5, 1, [])
    assert not caplog.records


def test_an_equation_that_is_an_inequality_has_no_gradient_at_the_reference() -> None:
    """abs(xdot) = xdot is xdot >= 0; at the crossing of x = 0 and z = 0 the others leave zdot, udot and vdot."""
    report = classified(["abs(xdot) = xdot", "x z = 0", "xdot^2 + ydot^2 = 0"], dict.fromkeys("xyzuv", 0))
    assert report.instantaneous_dof in (3, None)


def classified(constraints: list[Any], configuration: dict[str, int] | None = None) -> dofkit.Report:
    scene = {
        "particles": [{"name": "A", "coordinates": ["x", "y", "z"]}],
        "coordinates": ["u", "v"],
        "constraints": constraints,
    }
    return dofkit.classify(scene if configuration is None else {**scene, "configuration": configuration})
