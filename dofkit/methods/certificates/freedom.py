"""Evidence for numbers of freedoms, independence and redundancy: one way after another, the best first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from dofkit.methods.certificates.context import Context, Told, states_of
from dofkit.methods.certificates.dimension import everywhere, stationary, velocities_everywhere
from dofkit.methods.certificates.emptiness import refutations
from dofkit.methods.certificates.fields import backing, integral_steps, orbit, rows_above
from dofkit.methods.certificates.points import FoundPoint
from dofkit.report import ConstraintEntry


def consistent(context: Context) -> Iterator[Told]:
    """A point with a motion through it."""
    if context.report.consistent is False:
        yield from refutations(context, [relation.name for relation in context.problem.relations])
        return
    standing, inequalities = context.standing, _inequalities(context)
    if standing is None or inequalities is None:
        return
    if (backed := backing(context, standing)) is not None and (standing.rows or context.scenery.timed):
        yield {"rule": "regular", "minor": context.minor(standing), "inequalities": inequalities, **backed}
    yield {"rule": "point", "at": standing.point.name, "inequalities": inequalities}


def _inequalities(context: Context) -> dict[str, str] | None:
    """Return for every inequality a point where it holds, as an equality where no other was reached; else None."""
    places: dict[str, str] = {}
    for relation in context.problem.relations:
        if relation.kind == "inequality":
            point = _meeting(context, [relation.name]) or next(context.search.touching(relation.name), None)
            if point is None:
                return None
            places[relation.name] = context.add_point(point)
    return places


def _meeting(context: Context, inequalities: list[str]) -> FoundPoint | None:
    """Return a point of the configuration space, or of all relations if velocities occur, with ``inequalities``."""
    evidence = context.scenery.evidence
    moving = any(evidence.met_by(evidence.relation(name).tree) for name in inequalities)
    names, unknowns = states_of(context) if moving else (context.scenery.finite, context.problem.coordinates)
    return context.search.meeting(inequalities, names, unknowns)


def dof(context: Context) -> Iterator[Told]:
    """The dimension of the configuration space: everywhere where that is one line, else near the main point."""
    if not context.scenery.equations:
        yield {"rule": "everywhere", "about": "everywhere"}
        return
    if context.report.verdicts["dof"].about == "everywhere":
        yield from everywhere(context)
    if context.scenery.moving:
        yield from orbit(context)
    else:
        yield from _regular(context)
        yield from stationary(context)


def velocity_dof(context: Context) -> Iterator[Told]:
    """The independent velocities."""
    if not context.scenery.moving:
        yield from ({"rule": "count", "about": about} for about in ("everywhere", context.about))
        return
    if context.report.verdicts["velocity_dof"].about == "everywhere":
        yield from velocities_everywhere(context)
    yield from _regular(context)


def _regular(context: Context) -> Iterator[Told]:
    """The rank at the main point, where all relations follow from the rows."""
    standing = context.standing
    if standing is not None and (backed := backing(context, standing)) is not None:
        yield {"rule": "regular", "minor": context.minor(standing), "about": context.about, **backed}


def instantaneous(context: Context) -> Iterator[Told]:
    """The rank at the scene's configuration."""
    standing = context.standing if context.at_reference else None
    if standing is None:
        return
    claim: dict[str, Any] = {"rule": "rank", "at": standing.point.name}
    if not standing.dependent and standing.rows:
        yield {**claim, "minor": context.minor(standing)}
    yield claim


def counted(context: Context) -> Iterator[Told]:
    """What other claims imply."""
    yield {"rule": "count"}


def redundant(context: Context) -> Iterator[Told]:
    """What is redundant is implied by the other constraints."""
    dropped = set(context.report.redundant or [])
    relation = context.scenery.evidence.relation
    names = sorted(context.scenery.equations, key=lambda name: relation(name).owner in dropped)
    standing = context.accounted(names)
    if standing is not None and (backed := backing(context, standing)) is not None:
        yield {"rule": "cofactors", "minor": context.minor(standing), **backed}
    if not dropped:
        yield from _needed(context)


def _needed(context: Context) -> Iterator[Told]:
    """For every constraint a minor of all rows of the others."""
    minors, relation = {}, context.scenery.evidence.relation
    for owner in dict.fromkeys(relation(name).owner for name in context.scenery.evidence.equations):
        owned, shared = {*context.scenery.owned(owner)}, context.scenery.shared
        others = [n for n in context.scenery.equations if owned.isdisjoint((n, *shared.get(n, ())))]
        standing = context.accounted(others)
        if standing is None or not standing.accounted:
            return
        minors[owner] = context.minor(standing)
    yield {"rule": "cofactors", "without": minors}


def generalized_coordinates(context: Context) -> Iterator[Told]:
    """Yield evidence that the other coordinates are functions of the chosen ones, or of what stands for these."""
    chosen = context.report.generalized_coordinates
    if chosen == []:
        yield from counted(context)
    if chosen:
        moved = context.problem.world.charted(chosen)
        yield from rows_above(context, [q for q in context.problem.coordinates if q not in moved])
        yield from (claim["most"] for claim in stationary(context) if "fields" in claim["most"])


def independent(context: Context, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """How many rows of a constraint are independent of those before."""
    if entry.form == "inequality":
        yield {"rule": "inequality"}
        return
    scenery, equations = context.scenery, context.scenery.owned(entry.name)
    order = (*scenery.finite, *(name for name in scenery.moving if name not in scenery.shared))
    last = max((k for k, name in enumerate(order) if name in equations), default=-1)
    upto = context.accounted(order[: last + 1])
    if upto is not None and (backed := backing(context, upto)) is not None:
        yield {"rule": "independent", "minor": context.minor(upto), **backed}
    if upto is not None and last + 1 == len(order):
        yield {"rule": "independent", "minor": context.minor(upto), "last": True}


def redundancies(context: Context) -> Iterator[Told]:
    """What other claims imply; else the circuit of what is redundant, whatever was written first."""
    yield from counted(context)
    members = [name for group in context.report.redundancies for name in group.members]
    for name in context.report.redundant or []:
        for evidence in _circuit(context, name, [other for other in members if other != name]):
            yield {**evidence, "rule": "count", "of": name}


def circuit(context: Context, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """The constraint is implied by those of its circuit, and by no fewer."""
    if entry.circuit is not None:
        yield from _circuit(context, entry.name, entry.circuit)


def _circuit(context: Context, owner: str, members: Sequence[str]) -> Iterator[Told]:
    """Yield evidence that the members, and no fewer of them, imply the constraint ``owner``."""
    equations = context.scenery.owned(owner)
    rows = {name: context.scenery.owned(name) for name in members}
    whole = context.accounted([*(row for name in members for row in rows[name]), *equations])
    backed = backing(context, whole)
    minimal = {}
    for name in members:
        others = [row for other in members if other != name for row in rows[other]]
        for equation in equations:
            standing = context.standing_of([*others, equation])
            if standing is not None and not standing.dependent:
                minimal[name] = {"minor": context.minor(standing)}
                break
    if whole is not None and backed is not None and len(minimal) == len(members):
        yield {"rule": "cofactors", "at": whole.point.name, "minimal": minimal, **backed}


def feasible(context: Context) -> Iterator[Told]:
    """A point at which everything holds."""
    inequalities = [relation.name for relation in context.problem.relations if relation.kind == "inequality"]
    for point in (context.point, _meeting(context, inequalities)) if context.report.feasible else ():
        standing = None if point is None else context.standing_of(context.scenery.equations, point=point)
        if standing is not None:
            minor = {"minor": context.minor(standing)}
            yield {"rule": "point", "at": context.add_point(standing.point), **minor}
            yield {"rule": "regular", **minor}


def integrable_part(context: Context) -> Iterator[Told]:
    """Finite rows, and integrals for the texts of the basis."""
    part, finite = context.report.integrable_part, context.finite_standing
    if part is None or finite is None:
        return
    yield {"rule": "integrals", "minor": context.minor(finite), "steps": []}
    steps = integral_steps(context, part.basis or ())
    standing = context.standing_of([*finite.rows, *steps])
    if steps and standing is not None:
        yield {"rule": "integrals", "minor": context.minor(standing), "steps": steps}
