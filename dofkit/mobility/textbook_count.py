"""f = N d - k and d(d+1)/2, in the lecture's words, and why the count errs where it does."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.base.records import dataclass
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
    """Every finite equation that was written, a rigid body as d(d+1)/2 coordinates."""
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
    """The count as a line of text, numbers filled in."""
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
    """Why the count differs from the freedom; None where it does not."""
    if facts.consistent is False:
        return "no motion satisfies all constraints, so there is no freedom to count"
    if facts.dof is None or facts.dof == naive:
        return None
    reasons = []
    if facts.dof > naive:
        independent = facts.written - facts.dof + naive
        reasons.append(
            f"of the {many(facts.written, 'finite equation')} only {independent} {verb(independent)} independent here: "
            "what the others say already takes nothing away"
        )
        complete = complete_sets(system)
        reasons += complete
    if facts.dof < naive:
        reasons += _why_fewer(facts)
    return "; ".join(reasons)


def _why_fewer(facts: CountedFacts) -> list[str]:
    """What takes freedom away and is no finite equation as written."""
    forms = [e for e in facts.entries if e.form in ("pfaffian", "nonlinear")]
    integrable = [e.name for e in forms if e.holonomic]
    found = []
    if integrable:
        verb = "integrates to a finite relation" if len(integrable) == 1 else "integrate to finite relations"
        found.append(f"{', '.join(integrable)} {verb}, which the count of finite equations does not see")
    if facts.hidden:
        found.append(f"the differential constraints hide {many(facts.hidden, 'finite relation')} that nobody wrote")
    if forms and not found:
        found.append("a combination of the differential constraints integrates to a finite relation that nobody wrote")
    if not found:
        found.append(
            "one equation forces more than one condition over the reals, so it takes more than one freedom away"
        )
    return found


def complete_sets(system: System) -> list[str]:
    """The lecture's caution: with N > d+1 mutually linked particles only N d - d(d+1)/2 links are independent."""
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
