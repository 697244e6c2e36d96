"""Texts of pictures about a report: the answer, the states of constraints, and the legend."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from dofkit.base.wording import first_of, many, verb
from dofkit.pictures.shapes import State
from dofkit.report import Report
from dofkit.scene.scene import Scene

INFINITESIMAL = "infinitesimally mobile"
UNDECIDED = "number of degrees of freedom undecided"
#: The most names that are listed.
MOST = 8


def state_of(report: Report, name: str) -> State:
    """Return the state of a constraint: conflicting, redundant (wholly or in part), or plain."""
    if name in report.conflicting or name in report.infeasible:
        return "conflicting"
    in_part = any(entry.redundant_equations for entry in report.constraints if entry.name == name)
    return "redundant" if in_part or name in (report.redundant or ()) else "plain"


def sure(report: Report, field: str) -> str:
    """Return `` (probable)`` or similar for the verdict of a field; empty if it is proved."""
    entry = report.verdicts.get(field)
    return "" if entry is None or entry.verdict == "proved" else f" ({entry.verdict})"


def can_hold(report: Report) -> bool:
    """Return whether the report does not exclude that all constraints are satisfied together."""
    return report.consistent is not False and report.feasible is not False


def meanings(report: Report, looked: bool) -> Mapping[State, str]:
    """Return {state: text of the legend}. ``looked``: whether motions were computed.

    The motions are infinitesimal; they are called mobility only if the report says that they are finite.
    """
    words: dict[State, str] = {
        "redundant": f"redundant or partly redundant{sure(report, 'redundant')}",
        "conflicting": f"contradicts others{sure(report, 'consistent' if report.conflicting else 'feasible')}",
    }
    if not looked:
        return words
    if report.velocity_dof is None or report.consistent is None:
        return {**words, "moving": f"{INFINITESIMAL}; finite motion undecided", "plain": "immobile"}
    return {**words, "moving": INFINITESIMAL if report.singular else "mobile", "plain": "immobile"}


def answer(report: Report) -> str:
    """Return the answer in one sentence.

    >>> import dofkit
    >>> answer(dofkit.classify("four-bar-linkage"))
    '1 degree of freedom (proved)'
    """
    if report.consistent is False:
        names = first_of(report.conflicting, MOST)
        text = f"no motion: {names} contradict each other" if report.conflicting else "no motion"
    elif report.feasible is False:
        text = f"no motion: {first_of(report.infeasible, MOST)} cannot be satisfied together"
    else:
        text = ", ".join(_freedom(report))
    return text if text == UNDECIDED else f"{text} ({report.verdict})"


def _freedom(report: Report) -> Iterator[str]:
    """Yield texts on the freedom, the velocity freedom if it differs, and what is undecided."""
    dof, velocities = report.dof, report.velocity_dof
    yield UNDECIDED if dof is None else f"{dof} {verb(dof, 'degree', 'degrees')} of freedom"
    if velocities is not None and velocities != dof:
        yield f"{velocities} independent {verb(velocities, 'velocity', 'velocities')}"
    if report.singular and report.instantaneous_dof is not None:
        yield f"instantaneous freedom {report.instantaneous_dof} at this singular configuration"
    if dof is not None and report.consistent is None:
        yield "if the constraints are consistent"
    if report.feasible is None and not all(entry.bilateral for entry in report.constraints):
        yield "if the inequalities can be satisfied"


def alternative(scene: Scene, report: Report) -> str:
    """Return a description of the picture and the answer, in a few sentences."""
    sentences = [f"{contents(scene, scene.title or scene.name)}.", f"{answer(report)}."]
    how = sure(report, "redundant")
    wholly = report.redundant or []
    if wholly:
        sentences.append(f"Redundant{how}: {first_of(wholly, MOST)}.")
    in_part = [entry.name for entry in report.constraints if entry.redundant_equations and entry.name not in wholly]
    if in_part:
        sentences.append(f"Partly redundant{how}: {first_of(in_part, MOST)}.")
    if report.growth_vector:
        vector = ", ".join(map(str, report.growth_vector))
        sentences.append(f"Growth vector ({vector}){sure(report, 'growth_vector')}.")
    return " ".join(sentences)


def contents(scene: Scene, title: str) -> str:
    """Return a title with the numbers of bodies, particles, coordinates and constraints of a scene."""
    further = "further " if scene.bodies or scene.particles else ""
    counts = [(scene.bodies, "body"), (scene.particles, "particle"), (scene.coordinates, f"{further}coordinate")]
    listed = [many(len(items), what) for items, what in (*counts, (scene.constraints, "constraint")) if items]
    return f"{title}: {', '.join(listed) or 'nothing is declared'}"
