"""Fields that must agree: every law fails where it is broken, and what contradicts each other is not told."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from typing import Any

import pytest

import dofkit
from dofkit.classification.agreements import AGREEMENTS, agreed
from dofkit.report import Redundancy, Report

#: One holonomic form, and an equation too many: freedom 2 of 4, c3 follows from c1.
SCENE = {"coordinates": ["x", "y", "z", "w"], "constraints": ["x = y", "z dw + w dz = 0", "2 x = 2 y"]}
#: What breaks a law: other values of fields of the report, and of the entry of c3.
BREAKS: dict[str, tuple[Mapping[str, Any], Mapping[str, Any]]] = {
    "velocities are no more than freedoms": ({"velocity_dof": 3}, {}),
    "freedoms are no more than coordinates": ({"dof": 5}, {}),
    "velocities of motions are velocities to first order": ({"instantaneous_dof": 1}, {}),
    "singular is where the first order has other velocities": ({"instantaneous_dof": 3, "singular": False}, {}),
    "equations too many are equations less (coordinates less velocities)": ({"redundant_equations": 2}, {}),
    "as many equations follow as are too many": ({}, {"independent": 1}),
    "groups hold what is too many": ({"redundancies": []}, {}),
    "groups hold the equations that follow": ({"redundancies": [Redundancy(nullity=0, members=["c1", "c3"])]}, {}),
    "what can be dropped stands in groups": ({"redundant": ["c2"]}, {}),
    "a circuit is of what can be dropped, and was written before": ({"redundant": []}, {}),
    "as many equations are named as follow": ({}, {"redundant_equations": []}),
    "as many coordinates are chosen as are free": ({"generalized_coordinates": ["x"]}, {}),
    "growth begins with the velocities and ends with the freedom": ({"growth_vector": [2, 3]}, {}),
    "the system is holonomic where all constraints are": ({"holonomic": False}, {}),
    "the system is scleronomic where all constraints are": ({}, {"scleronomic": False}),
    "a holonomic system has as many velocities as freedoms": ({"velocity_dof": 1}, {}),
    "what is inconsistent has no freedom": ({"consistent": False}, {}),
    "what conflicts is inconsistent": ({"conflicting": ["c1"]}, {}),
    "what is not known makes the whole undecided": ({"redundant": None}, {}),
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


def test_every_law_has_a_case() -> None:
    assert [row.law for row in AGREEMENTS] == list(BREAKS)


@pytest.mark.parametrize("law", BREAKS)
def test_a_broken_law_is_seen_and_logged_and_its_fields_are_not_told(
    law: str, caplog: pytest.LogCaptureFixture
) -> None:
    row = next(row for row in AGREEMENTS if row.law == law)
    assert row.holds(told()) is not False
    found = broken(law)
    assert row.holds(found) is False
    with caplog.at_level(logging.ERROR):
        left = agreed(found)
    assert any(law in record.getMessage() and "defect" in record.getMessage() for record in caplog.records)
    assert left["verdict"] == "undecided"
    for name in row.fields:
        where, _, inner = name.rpartition(".")
        if where:
            assert all(getattr(e, inner) is None and e.verdict == "undecided" for e in left["constraints"])
        else:
            assert left[name] in (None, [])
    assert any(law in line for line in left["warnings"])
