"""A report on one line, for lists of many scenes."""

from __future__ import annotations

import io
from collections.abc import Iterator

from rich.console import Console
from rich.text import Text

from dofkit.interface.outcome import LABELS, VERDICT, WIDEST_NAME
from dofkit.interface.show.faults import safe
from dofkit.interface.show.report import number, system_labels
from dofkit.interface.show.sheet import TONES
from dofkit.interface.show.terminal import STYLES, Screen
from dofkit.report import Report


def brief_line(report: Report, widest: int, screen: Screen) -> str:
    """Return ``NAME  f  v  labels  verdict`` and remarkable findings; ``widest``: the longest name."""
    name, verdict = safe(report.scene), report.verdict
    text = Text.assemble(
        (f"{name:<{min(widest, WIDEST_NAME)}}", "bold"),
        f"  {number(report.dof):>3} {number(report.velocity_dof):>3}  {system_labels(report):<{LABELS}}  ",
        (f"{verdict:<{VERDICT}}", STYLES[TONES[verdict]]),
        *((f"  {safe(told)}", STYLES["care"]) for told in _remarks(report)),
    )
    if screen.colours is None:
        return text.plain.rstrip()
    console = Console(
        file=io.StringIO(),
        width=len(text.plain) + 1,
        force_terminal=True,
        force_jupyter=False,
        color_system=screen.colours,
    )
    with console.capture() as captured:
        console.print(text, end="")
    return captured.get().rstrip()


def _remarks(report: Report) -> Iterator[str]:
    if report.consistent is False:
        yield "inconsistent"
    if report.feasible is False:
        yield "infeasible"
    if report.redundant_equations:
        yield f"{report.redundant_equations} redundant"
    if report.singular:
        yield "singular"
