"""The findings of a report that a summary counts, and the widths of its line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dofkit.report import Report

#: The findings that ``--fail-on`` may name.
FAILURES = ("inconsistent", "infeasible", "redundant", "undecided")
#: The widths of the line of a scene: the most for a name; the labels; a verdict.
WIDEST_NAME, LABELS, VERDICT = 40, len("non-holonomic, scleronomic"), len("undecided")


def headline(widest: int) -> str:
    """Return the heading above the lines of scenes; ``f``: degrees of freedom, ``v``: velocity freedom."""
    return f"{'scene':<{min(widest, WIDEST_NAME)}}  {'f':>3} {'v':>3}  {'system':<{LABELS}}  verdict"


def outcome_of(report: Report) -> dict[str, Any]:
    """Return what a summary counts of a report; ``is``: those of `FAILURES` that hold."""
    found = {
        "inconsistent": report.consistent is False,
        "infeasible": report.feasible is False,
        "redundant": bool(report.redundant or report.redundant_equations),
        "undecided": report.verdict == "undecided",
    }
    return {"scene": report.scene, "verdict": report.verdict, "is": [name for name in FAILURES if found[name]]}
