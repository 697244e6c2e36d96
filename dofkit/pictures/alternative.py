"""What a picture says in words: the answer of a report, for who cannot see it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from dofkit.pictures.states import sure
from dofkit.report import Report
from dofkit.scene.scene import Scene

#: At most this many names are listed.
MOST = 8
OPEN = "number of degrees of freedom undecided"


def answer(report: Report) -> str:
    """The answer in one sentence.

    >>> import dofkit
    >>> answer(dofkit.classify("four-bar-linkage"))
    '1 degree of freedom (proved)'
    """
    if report.consistent is False:
        told = f"no motion: {_names(report.conflicting)} contradict each other" if report.conflicting else "no motion"
    elif report.feasible is False:
        told = f"no motion: {_names(report.infeasible)} cannot be satisfied together"
    else:
        told = ", ".join(_freedom(report))
    return told if told == OPEN else f"{told} ({report.verdict})"


def _freedom(report: Report) -> Iterator[str]:
    """The freedom, velocities where there are not as many, and what is not decided."""
    dof, velocities = report.dof, report.velocity_dof
    yield OPEN if dof is None else f"{dof} degree{'' if dof == 1 else 's'} of freedom"
    if velocities is not None and velocities != dof:
        yield f"{velocities} independent {'velocity' if velocities == 1 else 'velocities'}"
    if report.singular and report.instantaneous_dof is not None:
        yield f"instantaneous freedom {report.instantaneous_dof} at this singular configuration"
    if dof is not None and report.consistent is None:
        yield "if the constraints are consistent"
    if report.feasible is None and not all(entry.bilateral for entry in report.constraints):
        yield "if the inequalities can be satisfied"


def alternative(scene: Scene, report: Report) -> str:
    """What is drawn, and the answer, in a few sentences."""
    parts = [f"{n} {one if n == 1 else many}" for n, one, many in _counts(scene) if n]
    told = [f"{scene.title or scene.name}: {', '.join(parts) or 'nothing is declared'}.", f"{answer(report)}."]
    how = sure(report, "redundant")
    if report.redundant:
        told.append(f"Redundant{how}: {_names(report.redundant)}.")
    wholly = report.redundant or []
    in_part = [entry.name for entry in report.constraints if entry.redundant_equations and entry.name not in wholly]
    if in_part:
        told.append(f"Partly redundant{how}: {_names(in_part)}.")
    if report.growth_vector:
        told.append(f"Growth vector ({', '.join(map(str, report.growth_vector))}){sure(report, 'growth_vector')}.")
    return " ".join(told)


def _counts(scene: Scene) -> Iterable[tuple[int, str, str]]:
    yield len(scene.bodies), "body", "bodies"
    yield len(scene.particles), "particle", "particles"
    further = "further " if scene.bodies or scene.particles else ""
    yield len(scene.coordinates), f"{further}coordinate", f"{further}coordinates"
    yield len(scene.constraints), "constraint", "constraints"


def _names(names: Iterable[str]) -> str:
    listed = list(names)
    more = f" and {len(listed) - MOST} more" if len(listed) > MOST else ""
    return ", ".join(listed[:MOST]) + more
