"""What is counted of a report among many, and how wide a line of it is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dofkit.report import Report

#: What ``--fail-on`` may name.
FAILURES = ("inconsistent", "infeasible", "redundant", "undecided")
#: The widths of a line a scene: a name is given no more room than this; the labels; a verdict.
WIDEST_NAME, LABELS, VERDICT = 40, len("non-holonomic, scleronomic"), len("undecided")


def headline(widest: int) -> str:
    """What stands above a line a scene; ``f``: degrees of freedom, ``v``: independent velocities."""
    return f"{'scene':<{min(widest, WIDEST_NAME)}}  {'f':>3} {'v':>3}  {'the system':<{LABELS}}  verdict"


def outcome_of(report: Report) -> dict[str, Any]:
    """What is counted of a report; ``is`` holds those of `FAILURES` that it is."""
    found = {
        "inconsistent": report.consistent is False,
        "infeasible": report.feasible is False,
        "redundant": bool(report.redundant or report.redundant_equations),
        "undecided": report.verdict == "undecided",
    }
    return {"scene": report.scene, "verdict": report.verdict, "is": [name for name in FAILURES if found[name]]}
