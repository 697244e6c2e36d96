"""What is told of equations of motion, in the order in which they are read."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from dofkit.interface.show.sheet import TONES, Fact, Formula, Matrix, Remark, Sheet, SheetSection
from dofkit.motion.lagrange.report import Linearized, MotionReport


def sheet_of_motion(report: MotionReport, title: str | None = None) -> Sheet:
    """The whole report; its lines are not broken, so that equations can be copied."""
    return Sheet(
        name=report.scene,
        title=title or "",
        facts=tuple(_facts(report)),
        sections=tuple(section for section in _sections(report) if section.parts),
        copied=True,
    )


def _facts(report: MotionReport) -> Iterator[Fact]:
    yield Fact("coordinates", ", ".join(report.coordinates) or "none: nothing is left that can move")
    for name, value in report.eliminated.items():
        yield Fact("eliminated", _formula(f"{name} = {value}"))
    if report.left_out:
        yield Fact("left out", f"{', '.join(report.left_out)} (redundant)")
    yield Fact("verdict", report.verdict, tone=TONES[report.verdict])
    yield Fact("Lagrangian", _formula(f"L = {report.lagrangian}"))


def _sections(report: MotionReport) -> Iterator[SheetSection]:
    yield SheetSection("Equations of motion", _formulas(report.equations))
    pairs = zip(report.multipliers, report.constraints, strict=True)
    yield SheetSection("Constraints with a multiplier", [Remark(_formula(m), _formula(c)) for m, c in pairs])
    yield SheetSection("Generalized momenta", _formulas(f"p_{n} = {p}" for n, p in report.momenta.items()))
    yield SheetSection("Generalized forces", _formulas(f"Q_{n} = {f}" for n, f in report.forces.items()))
    yield SheetSection("Cyclic coordinates", _formulas(report.cyclic))
    held = [Remark("", _formula(f"{c.name} = {c.quantity}"), c.reason.rstrip(".")) for c in report.conserved]
    yield SheetSection("Conserved", held)
    if report.linearized is not None:
        yield _small_motions(report.linearized)
    yield SheetSection("Notes", [Remark("", note) for note in (*report.notes, f"q*p is an {report.action}.")])


def _formula(text: str) -> Formula:
    return Formula(_by_hand(text))


def _by_hand(text: str) -> str:
    """A product as it is written by hand, with a space between its factors; scenes read it as well."""
    return re.sub(r"\*(?![\d*])", " ", text)


def _formulas(texts: Iterable[str]) -> list[Remark]:
    return [Remark("", _formula(text)) for text in texts]


def _small_motions(found: Linearized) -> SheetSection:
    """M, C, K and the frequencies about a place of rest."""
    told = [Remark("", _formula("M qddot + C qdot + K q = 0"), f"q = ({', '.join(found.coordinates)})")]
    for name, matrix in (("M", found.mass), ("C", found.damping), ("K", found.stiffness)):
        told.append(Remark("", Matrix(name, [[*map(_by_hand, row)] for row in matrix])))
    if found.characteristic:
        told.append(Remark("characteristic equation", _formula(f"{found.characteristic} = 0")))
    told += [Remark("angular frequency", _formula(frequency)) for frequency in found.frequencies]
    if found.unstable:
        told.append(Remark("unstable", "the square of a frequency is negative, and deviations grow"))
    told += [Remark("another equilibrium", _place(other)) for other in found.others]
    return SheetSection(f"Linearized at {_place(found.equilibrium)}", told)


def _place(values: Mapping[str, str]) -> str:
    return ", ".join(f"{name} = {value}" for name, value in values.items())
