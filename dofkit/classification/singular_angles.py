"""Euler angles that texts name, of bodies drawn where they are no chart of poses: the sine of the second is 0 there.

One pose has a line of angles, and poses beside it have angles far away. What is counted in angles there is told of the
poses only where all equations are independent, and no equation is one of angles.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import sin
from typing import Any

from dofkit.classification.agreements import CIRCUIT, INDEPENDENT, NAMED, untold
from dofkit.classification.study import Study
from dofkit.expressions.enclosures import approximate
from dofkit.system import Constraint, Rotation

#: What counts as 0.
ZERO = 1e-9
COUNTED = ("dof", "velocity_dof", "instantaneous_dof", "singular", "redundant_equations", "redundant", "redundancies")
FIELDS = (*COUNTED, "generalized_coordinates", "growth_vector", "integrable_part", INDEPENDENT, CIRCUIT, NAMED)
WARNING = (
    "Not told: {fields}. Texts name the Euler angles of {body}, which are singular where it is drawn: give it another "
    "{theta} in `configuration`, or name no angle."
)


def without_singular_angles(study: Study, told: Mapping[str, Any]) -> dict[str, Any]:
    """The fields of a report, without those that are told of angles and may not be so of poses."""
    found, labels = dict(told), (INDEPENDENT, CIRCUIT, NAMED)
    for rotation in _singular(study):
        fields = FIELDS if _counts_angles(study, rotation) else ("generalized_coordinates",)
        chosen = told["generalized_coordinates"]
        if len(fields) == 1 and (chosen is None or rotation.names[1] in chosen):
            continue
        known = [f for f in fields if f in labels or told[f] is not None]
        named = ", ".join(f for f in known if f not in labels)
        found = untold(found, known, WARNING.format(fields=named, body=rotation.body, theta=rotation.names[1]))
    return found


def _singular(study: Study) -> Iterator[Rotation]:
    """Those whose angles are named, singular where the body is drawn, and meant by a constraint that is no text."""
    for rotation in study.system.rotations:
        theta = approximate(rotation.initial[1]) if rotation.chart == "euler" else None
        met = any(_mentions(c, rotation) for c in study.system.constraints if not _is_text(c))
        if study.system.reference is not None and theta is not None and abs(sin(theta)) < ZERO and met:
            yield rotation


def _counts_angles(study: Study, rotation: Rotation) -> bool:
    """Does an equation in a text name the angles, or do equations that hold them depend on each other?"""
    if any(_is_text(c) and _mentions(c, rotation) for c in study.system.constraints):
        return True
    outcome = study.outcome
    own = [(b, a) for b, a in zip(outcome.blocks, outcome.answers, strict=True) if {*b.coordinates} & {*rotation.names}]
    return any(a.instantaneous != len(b.coordinates) - len(b.rows) for b, a in own)


def _is_text(constraint: Constraint) -> bool:
    return constraint.facts.written and not constraint.facts.lettered


def _mentions(constraint: Constraint, rotation: Rotation) -> bool:
    """Is an angle named in an equation of the constraint?"""
    symbols = (s for r in constraint.relations if r.sense == "=" for s in r.expr.symbols)
    return any(s.args[0] in ("coordinate", "velocity", "differential") and s.args[1] in rotation.names for s in symbols)
