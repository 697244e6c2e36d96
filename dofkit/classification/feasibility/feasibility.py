"""Can all inequalities be satisfied together with the constraints? Decided by a certified point, or by a proof.

All configurations and motions that the constraints allow are considered, even if there is a reference configuration.
Time and parameters may have any values; inequalities that can be satisfied are so for an open set of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from flint import arb

from dofkit.base.deadline import limited, unless_late
from dofkit.base.verdicts import ArgumentKey, Claim, Verdict, weakest
from dofkit.classification.dependence.minimal_sets import minimal_set
from dofkit.classification.feasibility.state_problem import Part, StateProblem, Values, certified_state, parts_of
from dofkit.classification.freedom.common_point import may_restrict
from dofkit.classification.freedom.preparation import copies
from dofkit.classification.study import Study
from dofkit.exact.zero import BOTH, is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import BITS, GAP
from dofkit.relations.normal.domain import is_satisfied_at
from dofkit.relations.normal.no_solution import refuted
from dofkit.relations.normal.sign_claims import contradictory, point_of_linear
from dofkit.report import FieldVerdict
from dofkit.system import System, TypeFacts

#: Only in a space of this dimension can two bodies that share a point be assembled turned over.
MOST_DIMENSIONS = 3
#: Seconds for a point or a proof, and for leaving constraints out.
SECONDS, LEAVING_SECONDS = 6.0, 6.0
#: Larger sets are reduced by halves at first (see `minimal_set`).
FEW = 8
#: Bound on the constraints that a reason names.
MOST_NAMES = 8
OPEN = "whether all inequalities can be satisfied together with the constraints was not decided"
NOT_MINIMAL = (
    "the constraints named as infeasible cannot all be satisfied; whether {names} are needed for this was not decided"
)


@dataclass(frozen=True)
class Feasibility:
    """Whether all inequalities can be satisfied together with the constraints, and how certain that is.

    ``at``: if they can, values of the symbols of the parts with inequalities; ``infeasible``: if they cannot, the
    numbers of constraints that contradict each other, a minimal set unless ``reasons`` say otherwise.
    """

    feasible: bool | None
    infeasible: tuple[int, ...] = ()
    at: Values = field(default_factory=dict)
    verdict: Verdict = "undecided"
    reasons: tuple[str, ...] = ()


def feasibility(study: Study) -> Feasibility:
    """Return the feasibility of the inequalities of a system."""
    if study.outcome.consistent is False:
        answer = weakest(*(a.verdict for a in study.outcome.answers if a.consistent is False))
        members, claim = study.dependence.conflicting
        reasons = (NOT_MINIMAL.format(names="all of them"),) if claim.verdict != "proved" else ()
        return Feasibility(False, tuple(members), verdict=answer, reasons=reasons)
    result = judged(study)
    return result if result.feasible is not False else _minimal(study, result)


def judged(study: Study) -> Feasibility:
    """Return the feasibility of the inequalities of a consistent system; an infeasible set need not be minimal."""
    if study.setting.engines != BOTH:
        return Feasibility(None)
    reduced = study.reduced
    repeated = {i for i, j in copies(reduced).items() if {*reduced[i].domain()} <= {*reduced[j].domain()}}
    numbers = [i for i, r in enumerate(reduced) if i not in repeated and (r.normals or r.inequalities)]
    with limited(SECONDS):
        return unless_late(partial(_judged, study, numbers), Feasibility(None, reasons=(OPEN,)))


def _minimal(study: Study, feasibility: Feasibility) -> Feasibility:
    """Return the feasibility with a minimal infeasible set, by a deletion filter, the last written first.

    A constraint is left out if the others are proved to be infeasible. It is known to be needed if a point satisfies
    the others; constraints that are not known to be needed are named in a reason.
    """
    members, satisfiable = list(feasibility.infeasible), list[set[int]]()

    def infeasible(some: list[int]) -> bool:
        answer = unless_late(partial(_judged, study, some), Feasibility(None)).feasible
        if answer:
            satisfiable.append({*some})
        return answer is False

    with limited(LEAVING_SECONDS):
        kept = minimal_set(members, infeasible, len(members) // 2 if len(members) > FEW else 1)
    open_ = [i for i in kept if not any(some.issuperset({*kept} - {i}) for some in satisfiable)]
    names = [f"'{study.names[i]}'" for i in open_]
    text = ", ".join(names[:MOST_NAMES]) + (f" and {len(names) - MOST_NAMES} more" if names[MOST_NAMES:] else "")
    reasons = (NOT_MINIMAL.format(names=text),) if open_ else ()
    return replace(feasibility, infeasible=tuple(kept), reasons=reasons)


def _judged(study: Study, numbers: Sequence[int]) -> Feasibility:
    """Return the feasibility of some constraints: by a point for every part with an inequality, or by a proof.

    First each part is tried at the same given values of time and parameters; parts that share these and are still
    undecided are then joined, and time and parameters may have any values.
    """
    met: dict[int, Feasibility] = {}
    alone, joined = (parts_of(study.reduced, numbers, shared) for shared in (False, True))
    for part, fixed in [*((p, True) for p in alone), *((p, False) for p in joined)]:
        if not all(i in met for i in part.numbers):
            result = _of_part(study, part, fixed)
            if result.feasible is False:
                return result
            met |= dict.fromkeys(part.numbers, result) if result.feasible else {}
    in_parts, shared = ({i for part in some for i in part.numbers} for some in (alone, joined))
    blocks = [*zip(study.outcome.blocks, study.outcome.answers, strict=True)]
    restricting = {r.constraint for block, a in blocks if may_restrict(block, a) for r in block.rows}
    restricting |= {i for i in shared if study.reduced[i].domain()}
    # if a block is consistent, a part of it is
    others = [a for block, a in blocks if any(r.constraint in {*numbers} - in_parts for r in block.rows)]
    if not in_parts | (shared & restricting) <= met.keys() or None in [a.consistent for a in others]:
        return Feasibility(None, reasons=(OPEN,))
    at = {s: v for result in met.values() for s, v in result.at.items()}
    sure = weakest(*(result.verdict for result in met.values()), *(a.verdict for a in others))
    return Feasibility(True, at=at, verdict=sure)


def _of_part(study: Study, part: Part, fixed: bool) -> Feasibility:
    """Return the feasibility of one part: by a state on one choice of branches, or a proof for each that there is none.

    ``fixed``: time and parameters have given values in the search for a state.
    """
    positive, choices = study.setting.positive, part.choices()
    remaining = [problems for problems in choices if not contradictory(problems[-1].claims, positive)]
    for problem in (problem for problems in remaining for problem in problems):
        at = _state(study, part, problem, fixed)
        if at is not None:
            return Feasibility(True, at=at, verdict="proved")
    winds = any(r.constraint.winds for r in part.reduced)
    if choices and not winds and all(refuted(problems[-1].claims, positive) for problems in remaining):
        return Feasibility(False, part.numbers, verdict="proved")
    return Feasibility(None)


def _state(study: Study, part: Part, problem: StateProblem, fixed: bool) -> Values | None:
    """Return a state that solves a problem: the reference configuration, or one that a search finds; else None.

    None also if geometry has a tolerance. If a joint could also be assembled turned over, only the reference
    configuration is tried, because a search may find the wrong assembly.
    """
    setting = study.setting
    if setting.tolerance is not None and any(r.normals for r in part.reduced):
        return None
    reference, positive = setting.reference, setting.positive
    if reference is not None and problem.still and study.outcome.consistent and _is_met(problem, reference, positive):
        return {s: reference[s] for s in problem.places}
    if any(_turns_over(r.constraint.facts, setting.dimension) for r in part.reduced):
        return None
    if problem.still and not problem.constants:
        inner = point_of_linear([c if c.sense == "=" else c._replace(sense=">") for c in problem.claims])
        at = dict.fromkeys(problem.places, ex.ZERO) | dict(inner or {})
        if inner is not None and _is_met(problem, at, positive):
            return at
    return certified_state(problem, positive, fixed)


def _is_met(problem: StateProblem, configuration: Mapping[Expr, Expr], positive: frozenset[Expr]) -> bool:
    """Return whether a configuration at rest satisfies the equations, and the conditions strictly."""
    if not all(is_satisfied_at(c, configuration, positive, strictly=True) for c in problem.conditions):
        return False
    return all(is_proved_zero(substitute(e, configuration), positive) for e in problem.equations)


def _turns_over(facts: TypeFacts, dimension: int) -> bool:
    """Return whether the relations of a type are also satisfied by an unintended assembly, turned over."""
    return facts.half_turns and not (facts.axial and dimension < MOST_DIMENSIONS)


#: Decimals with which a ball is written.
DIGITS = 15


def inequalities_together(study: Study, fields: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the report's fields about inequalities, and new values of four of its ``fields`` that they change."""
    result = feasibility(study)
    at = _texts(study.system, result.at) if result.feasible else None
    claims = _claims(result)
    return {
        "feasible": result.feasible,
        "infeasible": [study.names[i] for i in result.infeasible],
        "feasible_at": at,
        "verdict": weakest(fields["verdict"], *(v.verdict for v in claims.values())),
        "verdicts": {**fields["verdicts"], **claims},
        "witness": _moved(fields, at or {}),
        "warnings": [*fields["warnings"], *result.reasons],
    }


def _claims(feasibility: Feasibility) -> dict[str, FieldVerdict]:
    """Return how certain the fields ``feasible`` and ``infeasible`` are, and by which argument."""
    if feasibility.feasible is None:
        return {"feasible": FieldVerdict.of(Claim("undecided"))}
    argument: ArgumentKey = "met at a point" if feasibility.feasible else "excluded together"
    claim = FieldVerdict.of(Claim(feasibility.verdict, argument, BITS, GAP))
    minimal = FieldVerdict.of(Claim("undecided")) if feasibility.reasons else claim
    return {"feasible": claim} | ({"infeasible": minimal} if feasibility.infeasible else {})


def _moved(fields: Mapping[str, Any], at: Mapping[str, str]) -> dict[str, str] | None:
    """Return the witness with the values of ``at``, or the old one if some claim is about its component."""
    witness: dict[str, str] | None = fields["witness"]
    verdicts = (fields["verdicts"], *(e.verdicts for e in fields["constraints"]))
    if witness is None or any(v.about == "component" for some in verdicts for v in some.values()):
        return witness
    return {**witness, **{name: at[name] for name in witness if name in at}}


def _texts(system: System, at: Values) -> dict[str, str]:
    """Return {name: value as text} of the scene's symbols, coordinates first.

    A Gibbs vector has no names in the scene; if it is 0 the Euler angles of the reference are given, otherwise none.
    """
    values_of = {_name(s): v for s, v in at.items()}
    for rotation in system.rotations:
        if rotation.chart == "gibbs":
            values = [values_of.pop(name, None) for name in rotation.names]
            if all(v == ex.ZERO for v in values):
                values_of |= dict(zip(rotation.names, rotation.initial, strict=True))
    order = [c.name for c in system.coordinates]
    named = [*order, *(f"{name}dot" for name in order), *system.parameters, "t"]
    return {name: _text(values_of[name]) for name in named if name in values_of}


def _name(s: Expr) -> str:
    return "t" if s == ex.TIME else f"{s.args[1]}dot" if s.args[0] == "velocity" else str(s.args[1])


def _text(value: Expr | arb) -> str:
    """Return an exact value as written, a ball as a decimal number."""
    if isinstance(value, Expr):
        return to_text(value)
    text = f"{float(value.mid()):.{DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
