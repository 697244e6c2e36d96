"""What one point tells for certain, for the report of a method that looks at points."""

from __future__ import annotations

from typing import Any

from dofkit.base.verdicts import Verdict
from dofkit.base.wording import many, verb
from dofkit.methods.shared.pointwise import Decider, SampledPoints, freedom, regular
from dofkit.methods.shared.reply import MethodFindings, MethodLabel

FAILS = "The form fails Frobenius' test at a regular point: its differential does not vanish on admissible velocities."
PASSES = "The form passes Frobenius' test at the point examined; elsewhere it need not."
SINGULAR = (
    "The form fails Frobenius' test at one point, which proves nothing: equations depend on each other there, or there "
    "may be other components."
)


def at_points(looked: SampledPoints, numbers: Decider, sure: Verdict, trusted: bool) -> MethodFindings:
    """Velocities at the drawing; freedom where all equations are independent there [ImplicitFunctions].

    ``trusted``: what is not 0 at the points is not 0, as surely as ``sure`` says.
    """
    written = looked.rows.written
    drawn = written.system.reference is not None
    where = "at the reference configuration" if drawn else "at one configuration"
    n, here = looked.rows.n, looked.samples[0].rows
    rank, rows = numbers.rank([row[:n] for row in here]), len(here)
    goes_on = numbers.rank(here) == rank
    fields: dict[str, Any] = {}
    told: list[str] = []
    euler = any(r.chart == "euler" for r in written.system.rotations)
    if written.others:
        told.append("Inequalities and equations nonlinear in the velocities were ignored.")
    elif drawn and not goes_on:
        told.append("At the reference configuration the equations fix the time: no motion passes through it.")
    elif drawn and not euler:
        fields["instantaneous_dof"] = n - rank
    elif drawn:
        told.append("Equations contain Euler angles, which may be singular at the reference configuration.")
    independent = drawn and trusted and rank == rows and not written.others
    if independent:
        fields |= {"consistent": True, "velocity_dof": n - rank, "redundant_equations": 0}
        fields |= {"singular": False} if "instantaneous_dof" in fields else {}
        fields |= {} if written.forms else {"dof": n - rank}
        told.append(
            f"All equations ({rows}) are independent {where}: each of the {n - rank} admissible velocities there "
            "belongs to a motion (implicit function theorem)."
        )
    else:
        told.append(_believed(looked, numbers, rows - rank, where))
    return MethodFindings(fields, _labels(looked, numbers, sure, trusted), told, independent, sure)


def _believed(looked: SampledPoints, numbers: Decider, dependent: int, where: str) -> str:
    count = many(freedom(looked, numbers), "degree")
    if dependent:
        also = f"{many(dependent, 'equation')} {verb(dependent, 'depends', 'depend')} on the others {where}"
        return f"The rank {where} gives {count} of freedom, but {also}: a rank at one point does not prove a motion."
    return f"The rank {where} gives {count} of freedom; it assumes that this rank is the same everywhere."


def _labels(looked: SampledPoints, numbers: Decider, sure: Verdict, trusted: bool) -> dict[int, MethodLabel]:
    written = looked.rows.written
    generic = written.system.reference is not None or not written.finite
    complete = set(written.others.values()) <= {"inequality"}
    good = trusted and generic and complete and regular(looked, numbers)
    told: dict[int, MethodLabel] = {}
    for (i, _), passes in zip(looked.rows.forms, looked.passing, strict=True):
        if i in written.others:
            continue
        if not passes and good:
            told[i] = MethodLabel(False, FAILS, sure)
        elif i not in told:
            told[i] = MethodLabel(None, PASSES if passes else SINGULAR, "undecided")
    return told
