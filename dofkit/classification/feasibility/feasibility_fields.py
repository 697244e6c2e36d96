"""What the report tells of the inequalities together: names, and texts of the point at which they hold."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flint import arb

from dofkit.base.verdicts import ArgumentKey, Claim, weakest
from dofkit.classification.feasibility import feasibility
from dofkit.classification.feasibility.feasibility import Feasibility
from dofkit.classification.feasibility.witness import Values
from dofkit.classification.study import Study
from dofkit.expressions import tree as ex
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import BITS, GAP
from dofkit.report import FieldVerdict
from dofkit.system import System

#: Decimals of a number that is known as a ball.
DIGITS = 15


def inequalities_together(study: Study, told: Mapping[str, Any]) -> Mapping[str, Any]:
    """The report's fields, beside what is ``told`` already; nothing where there are no inequalities."""
    if not any(r.inequalities for r in study.reduced):
        return {}
    found = feasibility.feasibility(study.reduced, study.setting, study.outcome, study.dependence.conflicting.members)
    at = _texts(study.system, found.at) if found.feasible else None
    claims = {} if found.feasible is None else _claims(found)
    return {
        "feasible": found.feasible,
        "infeasible": [study.names[i] for i in found.infeasible],
        "feasible_at": at,
        "verdict": weakest(told["verdict"], *(v.verdict for v in claims.values())),
        "verdicts": {**told["verdicts"], **claims},
        "witness": _moved(told["witness"], at or {}),
        "warnings": [*told["warnings"], *found.reasons],
    }


def _claims(found: Feasibility) -> dict[str, FieldVerdict]:
    """How sure it is, and by which argument."""
    argument: ArgumentKey = "met at a point" if found.feasible else "excluded together"
    claim = FieldVerdict.of(Claim(found.verdict, argument, BITS, GAP))
    return {"feasible": claim} | ({"infeasible": claim} if found.infeasible and not found.reasons else {})


def _moved(witness: Mapping[str, str] | None, at: Mapping[str, str]) -> dict[str, str] | None:
    """The witness, with all that is coupled to inequalities where these are met."""
    return None if witness is None else {**witness, **{name: at[name] for name in witness if name in at}}


def _texts(system: System, at: Values) -> dict[str, str]:
    """The values of the scene's symbols, coordinates first; of angles that no text names only those drawn."""
    told = {_name(s): v for s, v in at.items()}
    for rotation in system.rotations:
        if rotation.chart == "gibbs":
            values = [told.pop(name, None) for name in rotation.names]
            if all(v == ex.ZERO for v in values):
                told |= dict(zip(rotation.names, rotation.initial, strict=True))
    order = [c.name for c in system.coordinates]
    named = [*order, *(f"{name}dot" for name in order), *system.parameters, "t"]
    return {name: _text(told[name]) for name in named if name in told}


def _name(s: Expr) -> str:
    return "t" if s == ex.TIME else f"{s.args[1]}dot" if s.args[0] == "velocity" else str(s.args[1])


def _text(value: Expr | arb) -> str:
    if isinstance(value, Expr):
        return to_text(value)
    shown = f"{float(value.mid()):.{DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if shown == "-0" else shown
