"""What a report says of a constraint and of motions, as states that are drawn, and in the words of a legend."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.pictures.shapes import State
from dofkit.report import Report

INFINITESIMAL = "infinitesimally mobile"


def state_of(report: Report, name: str) -> State:
    """Does a constraint contradict others, is it redundant (wholly or in part), or neither?"""
    if name in report.conflicting or name in report.infeasible:
        return "conflicting"
    in_part = any(entry.redundant_equations for entry in report.constraints if entry.name == name)
    return "redundant" if in_part or name in (report.redundant or ()) else "plain"


def sure(report: Report, field: str) -> str:
    """`` (probable)`` and the like behind what a field says; nothing where it is proved."""
    found = report.verdicts.get(field)
    return "" if found is None or found.verdict == "proved" else f" ({found.verdict})"


def can_hold(report: Report) -> bool:
    """Is it not ruled out that all constraints are met together?"""
    return report.consistent is not False and report.feasible is not False


def meanings(report: Report, looked: bool) -> Mapping[State, str]:
    """What the legend says of each state that it tells. ``looked``: was it looked for what moves?

    Motions are drawn to first order: only where the report says so are they motions.
    """
    told: dict[State, str] = {
        "redundant": f"redundant or partly redundant{sure(report, 'redundant')}",
        "conflicting": f"contradicts others{sure(report, 'consistent' if report.conflicting else 'feasible')}",
    }
    if not looked:
        return told
    if report.velocity_dof is None or report.consistent is None:
        return {**told, "moving": f"{INFINITESIMAL}; finite motion undecided", "plain": "immobile"}
    moves = INFINITESIMAL if report.singular else "mobile"
    return {**told, "moving": moves, "plain": "immobile"}
