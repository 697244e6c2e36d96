"""The textbook count f = N d - k, with d(d+1)/2 for a rigid body, and why it is off where it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from dofkit.base.wording import many, verb
from dofkit.report import ConstraintEntry, Count
from dofkit.system import System


@dataclass(frozen=True)
class CountedFacts:
    """What the count is held against."""

    written: int
    dof: int | None
    consistent: bool | None
    hidden: int
    redundant_rows: int
    entries: Sequence[ConstraintEntry]


def count(system: System, facts: CountedFacts) -> Count:
    """Return the count of all geometric equations as written, with d(d+1)/2 coordinates for a rigid body."""
    coordinates = len(system.coordinates)
    naive = coordinates - facts.written
    independent = None if facts.dof is None else coordinates - facts.dof
    return Count(
        particles=len(system.particles),
        bodies=len(system.bodies),
        dimension=system.dimension,
        coordinates=coordinates,
        constraints=facts.written,
        independent=independent,
        naive_dof=naive,
        formula=formula(system, facts.written),
        errs=why(system, facts, naive),
    )


def formula(system: System, written: int) -> str:
    """Return the count as a line of text with its numbers."""
    d, terms, numbers = system.dimension, [], []
    if system.particles:
        terms.append("N d")
        numbers.append(f"{len(system.particles)}*{d}")
    if system.bodies:
        terms.append("B d(d+1)/2")
        numbers.append(f"{len(system.bodies)}*{d * (d + 1) // 2}")
    owned = len(system.particles) * d + len(system.bodies) * d * (d + 1) // 2
    further = len(system.coordinates) - owned
    if further or not terms:
        terms.append("n")
        numbers.append(str(further))
    return f"f = {' + '.join(terms)} - k = {' + '.join(numbers)} - {written} = {len(system.coordinates) - written}"


def why(system: System, facts: CountedFacts, naive: int) -> str | None:
    """Return why the count differs from the degrees of freedom, or None where it does not."""
    if facts.consistent is False:
        return "no motion satisfies all constraints, so there are no degrees of freedom to count"
    if facts.dof is None or facts.dof == naive:
        return None
    reasons = []
    if facts.dof > naive:
        independent = facts.written - facts.dof + naive
        reasons.append(
            f"only {independent} of the {many(facts.written, 'geometric equation')} {verb(independent)} independent: "
            "a dependent equation removes no degree of freedom"
        )
        complete = complete_sets(system)
        reasons += complete
    if facts.dof < naive:
        reasons += _why_fewer(facts)
    return "; ".join(reasons)


def _why_fewer(facts: CountedFacts) -> list[str]:
    """Return what removes degrees of freedom besides the geometric equations as written."""
    forms = [e for e in facts.entries if e.form in ("pfaffian", "nonlinear")]
    integrable = [e.name for e in forms if e.holonomic]
    found = []
    if integrable:
        verb = "integrates to a geometric equation" if len(integrable) == 1 else "integrate to geometric equations"
        found.append(f"{', '.join(integrable)} {verb}, which the count does not include")
    if facts.hidden:
        found.append(
            f"the differential constraints imply {many(facts.hidden, 'geometric equation')} besides those written"
        )
    if forms and not found:
        found.append("a combination of the differential constraints integrates to a geometric equation")
    if not found:
        found.append(
            "over the reals one equation imposes several conditions, so it removes more than one degree of freedom"
        )
    return found


def complete_sets(system: System) -> list[str]:
    """Return the complete sets of N > d+1 linked particles, of whose links only N d - d(d+1)/2 are independent."""
    d = system.dimension
    found = []
    for constraint in system.constraints:
        if not constraint.facts.complete:
            continue
        links = len(constraint.relations)
        n = round((1 + (1 + 8 * links) ** 0.5) / 2)
        if n > d + 1:
            found.append(
                f"of the N(N-1)/2 = {links} links among N = {n} particles in {many(d, 'dimension')} only "
                f"N d - d(d+1)/2 = {n * d - d * (d + 1) // 2} are independent, because N > d+1 = {d + 1}"
            )
    return found
