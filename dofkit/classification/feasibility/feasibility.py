"""Can all inequalities be met together with the constraints? A point shows that they can, a proof that they cannot.

They are judged for the set of all configurations and motions that the constraints allow, also where a reference
configuration is given; time and parameters may be as they like, so that what is met is met for an open set of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from flint import arb

from dofkit.base.deadline import limited, unless_late
from dofkit.base.verdicts import ArgumentKey, Claim, Verdict, weakest
from dofkit.classification.dependence.minimal_sets import minimal_set
from dofkit.classification.feasibility.state_problem import (
    Part,
    StateProblem,
    contradictory,
    parts_of,
    problems_of,
    refuted,
)
from dofkit.classification.feasibility.witness import Values, value_of, witness
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.freedom.preparation import copies
from dofkit.classification.study import Study
from dofkit.exact.zero import BOTH
from dofkit.expressions import tree as ex
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import BITS, GAP, Answer
from dofkit.relations.normal.pieces import Reduced
from dofkit.relations.setting import Setting
from dofkit.report import FieldVerdict
from dofkit.system import System, TypeFacts

#: In the plane two bodies that share a point are not turned over.
MOST_DIMENSIONS = 3
#: Seconds for a point or a proof, and for leaving constraints out.
SECONDS, LEAVING_SECONDS = 6.0, 6.0
#: Up to so many constraints are left out one by one from the beginning.
FEW = 8
#: So many constraints are named in a reason.
MOST_NAMES = 8
OPEN = "whether all inequalities can be satisfied together with the constraints was not decided"
NOT_MINIMAL = (
    "the constraints named as infeasible cannot all be satisfied; whether {names} are needed for this was not decided"
)


@dataclass(frozen=True)
class Feasibility:
    """Whether the all inequalities can be satisfied together with the constraints, and how sure that is.

    ``at``: where they are, values of the symbols that are coupled to them; ``infeasible``: where they cannot, the
    numbers of constraints that cannot all be met, none of which can be left out unless ``reasons`` say so.
    """

    feasible: bool | None
    infeasible: tuple[int, ...] = ()
    at: Values = field(default_factory=dict)
    verdict: Verdict = "undecided"
    reasons: tuple[str, ...] = ()


def feasibility(
    reduced: Sequence[Reduced], setting: Setting, outcome: Outcome, conflicting: Sequence[int]
) -> Feasibility:
    """Of a system with inequalities; ``conflicting``: what its constraints contradict each other by."""
    if outcome.consistent is False:
        answer = weakest(*(a.verdict for a in outcome.answers if a.consistent is False))
        return Feasibility(False, tuple(conflicting), verdict=answer)
    if setting.engines != BOTH:
        return Feasibility(None)
    repeated = copies(reduced)
    numbers = [i for i, r in enumerate(reduced) if i not in repeated and (r.normals or r.inequalities)]
    judge = _Judge(reduced, setting, outcome)
    with limited(SECONDS):
        result = unless_late(partial(judge.judged, numbers), Feasibility(None, reasons=(OPEN,)))
    return result if result.feasible is not False else _minimal(judge, result)


def _minimal(judge: _Judge, feasibility: Feasibility) -> Feasibility:
    """A set that cannot be met, none of which can be left out (a deletion filter, the last written first).

    What is left out leaves a set that is proved not to be met; what is kept is needed, where a point shows that the
    others can be met without it: then fewer of them can be as well.
    """
    members, satisfiable = list(feasibility.infeasible), list[set[int]]()

    def infeasible(some: list[int]) -> bool:
        answer = unless_late(partial(judge.judged, some), Feasibility(None)).feasible
        if answer:
            satisfiable.append({*some})
        return answer is False

    with limited(LEAVING_SECONDS):
        kept = minimal_set(members, infeasible, len(members) // 2 if len(members) > FEW else 1)
    open_ = [i for i in kept if not any(some.issuperset({*kept} - {i}) for some in satisfiable)]
    names = [f"'{judge.reduced[i].constraint.name}'" for i in open_]
    text = ", ".join(names[:MOST_NAMES]) + (f" and {len(names) - MOST_NAMES} more" if names[MOST_NAMES:] else "")
    reasons = (NOT_MINIMAL.format(names=text),) if open_ else ()
    return replace(feasibility, infeasible=tuple(kept), reasons=reasons)


@dataclass(frozen=True)
class _Judge:
    """Judges sets of the constraints of one system."""

    reduced: Sequence[Reduced]
    setting: Setting
    outcome: Outcome

    def judged(self, numbers: Sequence[int]) -> Feasibility:
        """A point for every part with an inequality, at the same values of time and parameters; or a proof.

        Parts that share time or parameters and are open are taken together, and these may then have any values.
        """
        met: dict[int, Feasibility] = {}
        alone, joined = (parts_of(self.reduced, numbers, shared) for shared in (False, True))
        for part, fixed in [*((p, True) for p in alone), *((p, False) for p in joined)]:
            if not all(i in met for i in part.numbers):
                result = self._of(part, fixed)
                if result.feasible is False:
                    return result
                met |= dict.fromkeys(part.numbers, result) if result.feasible else {}
        asked = {i for part in alone for i in part.numbers}
        others = self._answers(set(numbers) - asked)
        if not asked <= met.keys() or None in [a.consistent for a in others]:
            return Feasibility(None, reasons=(OPEN,))
        at = {s: v for result in met.values() for s, v in result.at.items()}
        sure = weakest(*(result.verdict for result in met.values()), *(a.verdict for a in others))
        return Feasibility(True, at=at, verdict=sure)

    def _answers(self, numbers: set[int]) -> list[Answer]:
        """The answers of blocks of these constraints: where a block can be met, so can a part of it."""
        pairs = zip(self.outcome.blocks, self.outcome.answers, strict=True)
        return [a for block, a in pairs if not numbers.isdisjoint(row.constraint for row in block.rows)]

    def _of(self, part: Part, fixed: bool) -> Feasibility:
        """Of one part; ``fixed``: time and parameters have given values where a point is looked for."""
        positive = self.setting.positive
        claims = part.written()
        if not contradictory(claims, positive):
            for problem in self._problems(part):
                fixed_values = {s: value_of(s) for s in problem.constants} if fixed else {}
                at = witness(replace(problem, fixed=fixed_values), positive, self._drawn)
                if at is not None:
                    return Feasibility(True, at=at, verdict="proved")
            if not _refuted(part, positive):
                return Feasibility(None)
        return Feasibility(False, part.numbers, verdict="proved")

    def _problems(self, part: Part) -> Iterator[StateProblem]:
        """Yield the problems of which a solution is searched, one or more for each choice of branches.

        Nothing where geometry is measured with a tolerance, or where a part is no list of equations and inequalities.
        Where a joint can also close turned over only the reference configuration is tried: ``drawn_only``.
        """
        measured = self.setting.tolerance is not None and any(r.normals for r in part.reduced)
        if measured or not part.readable:
            return
        turned = any(_turns_over(r.constraint.facts, self.setting.dimension) for r in part.reduced)
        for choice in part.choices() or ():
            for problem in problems_of(choice.rows, choice.conditions, choice.names):
                yield replace(problem, drawn_only=turned)

    @property
    def _drawn(self) -> Mapping[Expr, Expr]:
        return self.setting.pose if self.setting.reference is None else self.setting.reference


def _turns_over(facts: TypeFacts, dimension: int) -> bool:
    """Return whether the relations of a type also hold in an assembly that is turned over, which nobody means."""
    return facts.half_turns and not (facts.axial and dimension < MOST_DIMENSIONS)


def _refuted(part: Part, positive: frozenset[Expr]) -> bool:
    """Return whether it is proved that a part cannot be satisfied: as written, or on every choice of branches."""
    if not part.readable:
        return False
    if refuted(part.written(), positive):
        return True
    choices = list(part.choices() or ())
    claims = [choice.claims() for choice in choices]
    return bool(choices) and all(refuted(c, positive) for c in claims)


#: Decimals of a number that is known as a ball.
DIGITS = 15


def inequalities_together(study: Study, fields: Mapping[str, Any]) -> Mapping[str, Any]:
    """The report's fields, beside what is ``fields`` already."""
    result = feasibility(study.reduced, study.setting, study.outcome, study.dependence.conflicting.members)
    at = _texts(study.system, result.at) if result.feasible else None
    claims = _claims(result)
    return {
        "feasible": result.feasible,
        "infeasible": [study.names[i] for i in result.infeasible],
        "feasible_at": at,
        "verdict": weakest(fields["verdict"], *(v.verdict for v in claims.values())),
        "verdicts": {**fields["verdicts"], **claims},
        "witness": _moved(fields["witness"], at or {}),
        "warnings": [*fields["warnings"], *result.reasons],
    }


def _claims(feasibility: Feasibility) -> dict[str, FieldVerdict]:
    """How sure it is, and by which argument."""
    if feasibility.feasible is None:
        return {"feasible": FieldVerdict.of(Claim("undecided"))}
    argument: ArgumentKey = "met at a point" if feasibility.feasible else "excluded together"
    claim = FieldVerdict.of(Claim(feasibility.verdict, argument, BITS, GAP))
    return {"feasible": claim} | ({"infeasible": claim} if feasibility.infeasible and not feasibility.reasons else {})


def _moved(witness: Mapping[str, str] | None, at: Mapping[str, str]) -> dict[str, str] | None:
    """The witness, with all that is coupled to inequalities where these are met."""
    return None if witness is None else {**witness, **{name: at[name] for name in witness if name in at}}


def _texts(system: System, at: Values) -> dict[str, str]:
    """The values of the scene's symbols, coordinates first; of angles that no text names only those drawn."""
    answer = {_name(s): v for s, v in at.items()}
    for rotation in system.rotations:
        if rotation.chart == "gibbs":
            values = [answer.pop(name, None) for name in rotation.names]
            if all(v == ex.ZERO for v in values):
                answer |= dict(zip(rotation.names, rotation.initial, strict=True))
    order = [c.name for c in system.coordinates]
    named = [*order, *(f"{name}dot" for name in order), *system.parameters, "t"]
    return {name: _text(answer[name]) for name in named if name in answer}


def _name(s: Expr) -> str:
    return "t" if s == ex.TIME else f"{s.args[1]}dot" if s.args[0] == "velocity" else str(s.args[1])


def _text(value: Expr | arb) -> str:
    if isinstance(value, Expr):
        return to_text(value)
    text = f"{float(value.mid()):.{DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
