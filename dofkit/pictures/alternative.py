"""What a picture says in words: the answer of a report, for who cannot see it."""

from __future__ import annotations

from collections.abc import Iterable

from dofkit.report import Report
from dofkit.scene.scene import Scene

#: So many names are told.
MOST = 8


def answer(report: Report) -> str:
    """The answer in one sentence.

    >>> import dofkit
    >>> answer(dofkit.classify("four-bar-linkage"))
    '1 degree of freedom (proved)'
    """
    if report.consistent is False:
        told = f"no motion: {_names(report.conflicting)} contradict each other" if report.conflicting else "no motion"
    elif report.dof is None:
        told = "degrees of freedom undecided"
    else:
        told = f"{report.dof} degree{'' if report.dof == 1 else 's'} of freedom"
        if report.velocity_dof is not None and report.velocity_dof != report.dof:
            told += f", {report.velocity_dof} independent velocities"
        if report.singular and report.instantaneous_dof is not None:
            told += f", {report.instantaneous_dof} to first order at this singular drawing"
    return f"{told} ({report.verdict})"


def alternative(scene: Scene, report: Report) -> str:
    """What is drawn, and the answer, in a few sentences."""
    parts = [f"{n} {one if n == 1 else many}" for n, one, many in _counts(scene) if n]
    told = [f"{scene.title or scene.name}: {', '.join(parts) or 'nothing is declared'}.", f"{answer(report)}."]
    if report.redundant:
        told.append(f"Redundant: {_names(report.redundant)}.")
    wholly = report.redundant or []
    in_part = [entry.name for entry in report.constraints if entry.redundant_equations and entry.name not in wholly]
    if in_part:
        told.append(f"Redundant in part: {_names(in_part)}.")
    if report.infeasible:
        told.append(f"Cannot be met together: {_names(report.infeasible)}.")
    if report.growth_vector:
        told.append(f"Growth vector ({', '.join(map(str, report.growth_vector))}).")
    return " ".join(told)


def _counts(scene: Scene) -> Iterable[tuple[int, str, str]]:
    yield len(scene.bodies), "body", "bodies"
    yield len(scene.particles), "particle", "particles"
    yield len(scene.coordinates), "further coordinate", "further coordinates"
    yield len(scene.constraints), "constraint", "constraints"


def _names(names: Iterable[str]) -> str:
    listed = list(names)
    more = f" and {len(listed) - MOST} more" if len(listed) > MOST else ""
    return ", ".join(listed[:MOST]) + more
