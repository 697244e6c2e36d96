"""What a report says of a constraint, as a state that is drawn."""

from __future__ import annotations

from dofkit.pictures.shapes import State
from dofkit.report import Report


def state_of(report: Report, name: str) -> State:
    """Does a constraint contradict others, is it redundant (wholly or in part), or neither?"""
    if name in report.conflicting or name in report.infeasible:
        return "conflicting"
    in_part = any(entry.redundant_equations for entry in report.constraints if entry.name == name)
    return "redundant" if in_part or name in (report.redundant or ()) else "plain"
