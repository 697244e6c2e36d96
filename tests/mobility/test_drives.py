"""Drives: how much of the mobility they take, and a motor that is written as a second joint."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.report import Report

MOTOR = {"name": "motor", "type": "revolute", "between": ["ground", "crank"], "at": [0, 0]}


def four_bar(*more: dict[str, Any], drive: str | None = None) -> Report:
    """Classify a four-bar linkage (mobility 1), its crank driven where a drive is given."""
    first = {**MOTOR, "name": "A"} | ({} if drive is None else {"drive": drive})
    joints = [("B", ["crank", "rod"], [0, 1]), ("C", ["rod", "rocker"], [3, 2]), ("D", ["rocker", "ground"], [4, 0])]
    others = [{"name": n, "type": "revolute", "between": ends, "at": at} for n, ends, at in joints]
    scene = {"dimension": 2, "bodies": ["crank", "rod", "rocker"], "constraints": [first, *others, *more]}
    return dofkit.classify(scene)


def line(report: Report) -> str:
    """Return the report's text without its line breaks."""
    return " ".join(report.text(width=200).split())


def test_a_driven_mechanism_moves_as_driven() -> None:
    report = four_bar(drive="t")
    assert report.mobility is not None
    assert (report.dof, report.mobility.undriven, report.mobility.undriven_verdict) == (0, 1, "proved")
    assert "mobility 1 of which 1 is driven: it moves as driven" in line(report)


def test_an_undriven_mechanism_has_no_such_line() -> None:
    report = four_bar()
    assert report.mobility is not None
    assert (report.dof, report.mobility.undriven) == (1, None)
    assert "is driven" not in line(report)


def test_what_a_drive_leaves_free() -> None:
    """Two links hinged in a row have 2 freedoms, one of them driven."""
    hinges = [{**MOTOR, "drive": "t"}, {"type": "revolute", "between": ["crank", "rod"], "at": [1, 0]}]
    report = dofkit.classify({"dimension": 2, "bodies": ["crank", "rod"], "constraints": hinges})
    assert "mobility 2 of which 1 is driven: 1 is left free" in line(report)


@pytest.mark.parametrize("ends", [["ground", "crank"], ["crank", "ground"]])
def test_a_motor_written_as_a_second_hinge_is_named(ends: list[str]) -> None:
    """The hinge's 2 equations stand there twice: 9 - 8 - 3 = -2 by the count, 0 with the drive, 1 without it."""
    report = four_bar({**MOTOR, "between": ends, "drive": "t"})
    assert report.mobility is not None
    assert (report.dof, report.redundant_equations, report.redundant) == (0, 2, ["A"])
    assert (report.mobility.kutzbach, report.mobility.undriven) == (-2, 1)
    hints = [warning for warning in report.warnings if "write `drive: t` on 'A' and remove 'motor'" in warning]
    assert len(hints) == 1
    assert report.mobility.differs is not None
    assert "A and motor allow the same bodies the same motions" in report.mobility.differs


@pytest.mark.parametrize("more", [{}, {"at": [0, 1], "drive": "t"}, {"between": ["ground", "rod"], "drive": "t"}])
def test_a_second_hinge_that_is_no_motor_has_no_such_warning(more: dict[str, Any]) -> None:
    """It is not driven, stands elsewhere, or joins other bodies."""
    assert not [w for w in four_bar({**MOTOR, **more}).warnings if "remove 'motor'" in w]
