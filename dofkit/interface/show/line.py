"""A report on one line: in a list of many scenes, or only some of its fields."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.text import Text

from dofkit.interface.show.faults import safe
from dofkit.interface.show.report import number, system_labels
from dofkit.interface.show.sheet import TONES
from dofkit.interface.show.terminal import STYLES, Screen
from dofkit.report import Report

#: The widths of the line of a scene: the most for a name; the labels; a verdict.
WIDEST_NAME, LABELS, VERDICT = 40, len("non-holonomic, scleronomic"), len("undecided")


def headline(name_width: int) -> str:
    """Return the heading above the lines of scenes; ``f``: degrees of freedom, ``v``: velocity freedom."""
    return f"{'scene':<{min(name_width, WIDEST_NAME)}}  {'f':>3} {'v':>3}  {'system':<{LABELS}}  verdict"


def brief_line(report: Report, name_width: int, screen: Screen) -> str:
    """Return ``NAME  f  v  labels  verdict`` and remarkable findings; ``name_width``: that of the longest name."""
    name, verdict = safe(report.scene), report.verdict
    text = Text.assemble(
        (f"{name:<{min(name_width, WIDEST_NAME)}}", "bold"),
        f"  {number(report.dof):>3} {number(report.velocity_dof):>3}  {system_labels(report):<{LABELS}}  ",
        (f"{verdict:<{VERDICT}}", STYLES[TONES[verdict]]),
        *((f"  {finding}", STYLES["care"]) for finding in _findings(report)),
    )
    if screen.colours is None:
        return text.plain.rstrip()
    width = len(text.plain) + 1
    console = Console(file=io.StringIO(), width=width, force_terminal=True, color_system=screen.colours)
    with console.capture() as captured:
        console.print(text, end="")
    return captured.get().rstrip()


def _findings(report: Report) -> Iterator[str]:
    if report.consistent is False:
        yield "inconsistent"
    if report.feasible is False:
        yield "infeasible"
    if report.redundant_equations:
        yield f"{report.redundant_equations} redundant"
    if report.singular:
        yield "singular"


def outcome_of(report: Report) -> dict[str, Any]:
    """Return what a summary counts of a report; ``is``: the findings that ``--fail-on`` may name."""
    findings = {
        "inconsistent": report.consistent is False,
        "infeasible": report.feasible is False,
        "redundant": bool(report.redundant or report.redundant_equations),
        "undecided": report.verdict == "undecided",
    }
    return {"scene": report.scene, "verdict": report.verdict, "is": [name for name in findings if findings[name]]}


def selection_of(fields: Mapping[str, Any], only: Sequence[str]) -> dict[str, Any]:
    """Return the scene's name and some fields of a report in JSON."""
    return {"scene": fields["scene"], **{name: fields[name] for name in only}}


def selected_line(report: Report, only: Sequence[str]) -> str:
    """Return ``SCENE  dof 4 (proved)``: each field with its verdict."""
    fields = report.model_dump(mode="json", include=set(only))
    texts = []
    for name in only:
        verdict = report.verdicts.get(name)
        texts.append(f"{name} {_value(fields[name])}" + ("" if verdict is None else f" ({verdict.verdict})"))
    return safe("  ".join([report.scene, *texts]))


def _value(value: Any) -> str:
    if value is None:
        return "-"
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
