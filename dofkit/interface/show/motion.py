"""Equations of motion for a person at a terminal."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.interface.show.faults import safe
from dofkit.motion.lagrange.report import Linearized, MotionReport


def as_lines(report: MotionReport, title: str | None = None) -> str:
    """The whole report as plain lines, so that equations can be copied."""
    return "\n".join(safe(line) for line in _lines(report, title)) + "\n"


def _lines(report: MotionReport, title: str | None) -> Iterator[str]:
    yield report.scene + (f"  {title}" if title else "")
    yield f"  coordinates  {', '.join(report.coordinates) or 'none: nothing is left that can move'}"
    for name, value in report.eliminated.items():
        yield f"  eliminated   {name} = {value}"
    if report.left_out:
        yield f"  left out     {', '.join(report.left_out)} (redundant)"
    yield f"  verdict      {report.verdict}"
    yield f"  L = {report.lagrangian}"
    yield from _section("Generalized momenta", [f"p_{n} = {p}" for n, p in report.momenta.items()])
    yield from _section("Generalized forces", [f"Q_{n} = {f}" for n, f in report.forces.items()])
    yield from _section("Equations of motion", report.equations)
    pairs = zip(report.multipliers, report.constraints, strict=True)
    yield from _section("Constraints with a multiplier", [f"{m}: {c}" for m, c in pairs])
    yield from _section("Cyclic coordinates", report.cyclic)
    yield from _section("Conserved", [f"{c.name} = {c.quantity}: {c.reason}" for c in report.conserved])
    if report.linearized is not None:
        yield from _small_motion_lines(report.linearized)
    yield from _section("Notes", [*report.notes, f"q*p is an {report.action}."])


def _section(title: str, lines: list[str]) -> Iterator[str]:
    if lines:
        yield title
        yield from (f"  {line}" for line in lines)


def _small_motion_lines(found: Linearized) -> Iterator[str]:
    place = ", ".join(f"{n} = {v}" for n, v in found.equilibrium.items())
    yield f"Linearized at {place}: M qddot + C qdot + K q = 0, q = ({', '.join(found.coordinates)})"
    for name, matrix in (("M", found.mass), ("C", found.damping), ("K", found.stiffness)):
        yield f"  {name} = [" + "; ".join(", ".join(row) for row in matrix) + "]"
    if found.characteristic:
        yield f"  {found.characteristic} = 0"
    if found.frequencies:
        yield f"  angular frequencies {', '.join(found.frequencies)}"
    if found.unstable:
        yield "  unstable: the square of a frequency is negative, and deviations grow"
    for other in found.others:
        yield "  another equilibrium: " + ", ".join(f"{n} = {v}" for n, v in other.items())
