"""The sheet of the equations of motion: facts, equations, conserved quantities, and small motions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from dofkit.interface.show.sheet import TONES, Fact, Formula, Matrix, Remark, Sheet, SheetSection
from dofkit.motion.lagrange.report import Linearized, MotionReport

#: The equation of a coordinate that does not occur in the Lagrangian.
_TRIVIAL = "0 = 0"
#: Names of the mass, damping and stiffness matrices: the first triple of which no name occurs in their entries.
_MATRICES = (("M", "C", "K"), ("A", "B", "C"), ("M_q", "C_q", "K_q"))
_WORDS = re.compile(r"[^\W\d]\w*")


def sheet_of_motion(report: MotionReport, title: str | None = None) -> Sheet:
    """Return the sheet of equations of motion; lines are not broken, so that equations can be copied."""
    return Sheet(
        name=report.scene,
        title=title or "",
        facts=tuple(_facts(report)),
        sections=tuple(section for section in _sections(report) if section.content),
        copied=True,
    )


def _facts(report: MotionReport) -> Iterator[Fact]:
    yield Fact("coordinates", ", ".join(report.coordinates) or "none: the system cannot move")
    for name, value in report.eliminated.items():
        yield Fact("eliminated", _formula(f"{name} = {value}"))
    if report.left_out:
        yield Fact("left out", f"{', '.join(report.left_out)} (redundant)")
    yield Fact("verdict", report.verdict, tone=TONES[report.verdict])
    yield Fact("Lagrangian", _formula(f"L = {report.lagrangian}"))


def _sections(report: MotionReport) -> Iterator[SheetSection]:
    trivial = [n for n, e in zip(report.coordinates, report.equations, strict=True) if e == _TRIVIAL]
    equations = _formulas(e for e in report.equations if e != _TRIVIAL)
    yield SheetSection("Equations of motion", [*equations, *_without_equation(trivial)])
    pairs = zip(report.multipliers, report.constraints, strict=True)
    yield SheetSection("Constraints with a multiplier", [Remark(_formula(m), _formula(c)) for m, c in pairs])
    momenta = (f"p_{n} = {p}" for n, p in report.momenta.items() if n not in trivial)
    yield SheetSection("Generalized momenta", _formulas(momenta))
    added = {n: f" + Q_{n}" for n in report.non_conservative}
    forces = (f"dL/d{n}{added.get(n, '')} = {f}" for n, f in report.forces.items() if n not in trivial)
    yield SheetSection("Generalized forces", _formulas(forces))
    yield SheetSection("Cyclic coordinates", _formulas(n for n in report.cyclic if n not in trivial))
    conserved = (c for c in report.conserved if c.quantity != "0")
    remarks = [Remark("", _formula(f"{c.name} = {c.quantity}"), c.reason.rstrip(".")) for c in conserved]
    yield SheetSection("Conserved", remarks)
    if report.linearized is not None:
        yield _small_motions(report.linearized)
    yield SheetSection("Notes", [Remark("", note) for note in report.notes])


def _without_equation(trivial: list[str]) -> Iterator[Remark]:
    """Yield a remark that names the coordinates whose equation of motion is 0 = 0, if there are any."""
    if trivial:
        noun = "the coordinate" if len(trivial) == 1 else "the coordinates"
        yield Remark("", f"No mass, force or constraint determines {noun} {', '.join(trivial)}: 0 = 0.")


def _formula(text: str) -> Formula:
    return Formula(_by_hand(text))


def _by_hand(text: str) -> str:
    """Return a formula with spaces between factors instead of `*`, which scenes can read as well."""
    return re.sub(r"\*(?![\d*])", " ", text)


def _formulas(texts: Iterable[str]) -> list[Remark]:
    return [Remark("", _formula(text)) for text in texts]


def _small_motions(small: Linearized) -> SheetSection:
    """Return the section with the matrices M, C, K and the frequencies about an equilibrium."""
    matrices = (small.mass, small.damping, small.stiffness)
    taken = {word for matrix in matrices for row in matrix for entry in row for word in _WORDS.findall(entry)}
    names = next((names for names in _MATRICES if taken.isdisjoint(names)), _MATRICES[-1])
    mass, damping, stiffness = names
    law = f"{mass} qddot + {damping} qdot + {stiffness} q = 0"
    remarks = [Remark("", _formula(law), f"q = ({', '.join(small.coordinates)})")]
    for name, matrix in zip(names, matrices, strict=True):
        remarks.append(Remark("", Matrix(name, [[*map(_by_hand, row)] for row in matrix])))
    if small.characteristic:
        remarks.append(Remark("characteristic equation", _formula(f"{small.characteristic} = 0")))
    remarks += [Remark("angular frequency", _formula(frequency)) for frequency in small.frequencies]
    if small.unstable:
        remarks.append(Remark("unstable", "some deviation grows"))
    return SheetSection(f"Linearized at {_place(small.equilibrium)}", remarks)


def _place(values: Mapping[str, str]) -> str:
    return ", ".join(f"{name} = {value}" for name, value in values.items())
