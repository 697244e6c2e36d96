"""What every stable code of feedback means, to whoever asks."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.homework.key.misconceptions import ERRORS

_OF_LABELS = {
    "RHEO_MISSED": "Time occurs explicitly in the constraint or in its integral, so it is rheonomic; it was called "
    "scleronomic.",
    "RHEO_NH": "A constraint on velocities was called rheonomic, but time does not occur in it explicitly.",
    "RHEO_MOVES": "A constraint in which time does not occur explicitly was called rheonomic.",
    "EQ_AS_INEQ": "An equation, which is bilateral, was called unilateral.",
    "HOLONOMIC_MISSED": "A relation between coordinates (and possibly time) was called non-holonomic.",
    "NH_MISSED": "A constraint on velocities that is not integrable was called holonomic.",
}
_OF_NUMBERS = {
    "CARRIED": "The number is consistent with an earlier answer that was wrong: the step itself is correct.",
    "OTHER_CONVENTION": "The number of independent velocities was given instead of the dimension of the configuration "
    "space, or vice versa.",
}
_OF_EQUATIONS = {
    "SAME": "An equivalent form of the constraint.",
    "IRREGULAR": "The same set of configurations, but the gradient vanishes on it, as for a squared equation.",
    "ONE_BRANCH": "Only one branch of the constraint, such as a square root with one sign.",
    "DIFFERENTIATED": "The time derivative of the constraint: its constant is lost.",
    "INTEGRATED": "The integral of the differential constraint, with its constant.",
    "INTEGRATED_NO_CONSTANT": "The integral of the differential constraint without its constant.",
    "WEAKER": "A weaker condition: it is implied by the constraint but does not imply it.",
    "STRONGER": "A stronger condition: it implies the constraint but is not implied by it.",
    "DIFFERENT": "A different constraint.",
    "ROUNDED": "The constraint with a rounded number instead of the exact one.",
    "EMPTY": "No configuration satisfies it together with the other constraints.",
    "UNDECIDED": "It could not be decided whether this is the same constraint.",
    "INTEGRABLE": "The constraint is integrable but was said not to be.",
    "NOT_INTEGRABLE": "The constraint is not integrable, but an integral was given.",
    "NOT_INTEGRATED": "The answer still contains velocities instead of an integral.",
    "WRONG_INTEGRAL": "A relation between coordinates that is not an integral of the constraint.",
}
_OF_NAMES = {
    "REDUNDANT_MISSED": "A redundant constraint is missing from the answer.",
    "INCOMPLETE": "The named coordinates do not determine the configuration.",
    "DEPENDENT": "The named coordinates are not independent.",
    "NOT_REDUNDANT": "Without the named constraints the system would have more freedom.",
}
_OF_MOTION = {
    "TOTAL_ENERGY": "The energy T + V was given instead of the Lagrangian T - V.",
    "SIGN": "The sign is wrong, for example V - T instead of the Lagrangian T - V.",
    "WRONG_LAGRANGIAN": "A different Lagrangian: it does not give the equations of motion.",
    "WRONG_MOMENTUM": "Not the derivative of the Lagrangian with respect to that velocity.",
    "WRONG_FORCE": "Not the derivative of the Lagrangian with respect to that coordinate plus non-potential forces.",
    "WRONG_MOTION": "An equation that is not satisfied by the motion.",
    "SMALL_ANGLES": "The equations of motion linearized for small oscillations.",
    "NO_ACCELERATION": "A correct equation that does not determine the acceleration.",
    "INEQUALITY": "An inequality was given instead of an equation of motion.",
    "OTHER_COORDINATE": "The equation of motion of another coordinate.",
    "FOLLOWS": "An equation that is implied by the equations of motion.",
}

#: Code -> what it means.
CODES: Mapping[str, str] = {
    **{error.code: error.hint for error in ERRORS},
    **_OF_LABELS,
    **_OF_NUMBERS,
    **_OF_EQUATIONS,
    **_OF_NAMES,
    **_OF_MOTION,
}
