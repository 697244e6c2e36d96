"""What every stable code of feedback means, to whoever asks."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.homework.key.misconceptions import ERRORS

_OF_LABELS = {
    "RHEO_MISSED": "Time occurs in the constraint, or in the relation that it integrates to, so it is rheonomic, and "
    "it was called scleronomic.",
    "RHEO_NH": "A constraint on velocities was called rheonomic, but velocities are not time: time does not enter it.",
    "RHEO_MOVES": "What the constraint is attached to moves, but time itself does not enter: it is scleronomic.",
    "EQ_AS_INEQ": "An equation, which holds from both sides, was called unilateral.",
    "HOLONOMIC_MISSED": "A relation between coordinates (and time) alone was called non-holonomic.",
    "NH_MISSED": "A constraint on velocities that no relation between coordinates gives was called holonomic.",
}
_OF_NUMBERS = {
    "CARRIED": "The number follows from an earlier answer that was wrong: the step itself is right.",
    "OTHER_CONVENTION": "The number of velocities was given where the dimension of the configuration space was asked "
    "for, or the other way round.",
}
_OF_EQUATIONS = {
    "SAME": "The same constraint, in other words.",
    "IRREGULAR": "The same set of configurations, but written so that its differential vanishes there (squared).",
    "ONE_BRANCH": "Only one branch of the constraint, such as a square root with one sign.",
    "DIFFERENTIATED": "The constraint differentiated by time: its constant is lost.",
    "INTEGRATED": "The differential constraint integrated, with its constant.",
    "INTEGRATED_NO_CONSTANT": "The differential constraint integrated, its constant left out.",
    "WEAKER": "It follows from the constraint, but allows more.",
    "STRONGER": "It implies the constraint, but forbids more.",
    "DIFFERENT": "Another constraint.",
    "ROUNDED": "The constraint with a number that was rounded, where the exact one was asked for.",
    "EMPTY": "No configuration satisfies it together with the other constraints.",
    "UNDECIDED": "Whether it is the same constraint could not be decided.",
    "INTEGRABLE": "The constraint integrates to a finite relation, and it was said not to.",
    "NOT_INTEGRABLE": "The constraint does not integrate to a finite relation, and one was given.",
    "NOT_INTEGRATED": "Velocities are left where the finite relation was asked for.",
    "WRONG_INTEGRAL": "A finite relation that is not what the constraint integrates to.",
}
_OF_NAMES = {
    "REDUNDANT_MISSED": "Some constraint that follows from the others was left out of the answer.",
    "INCOMPLETE": "The coordinates named do not fix the configuration.",
    "DEPENDENT": "The constraints tie the coordinates named to each other.",
    "NOT_REDUNDANT": "Without the constraints named the system would move more freely.",
}
_OF_MOTION = {
    "TOTAL_ENERGY": "The energy T + V stands where the Lagrangian T - V was asked for.",
    "SIGN": "The sign is wrong, as that of V - T where the Lagrangian T - V was asked for.",
    "WRONG_LAGRANGIAN": "Another Lagrangian: it differs by more than a total derivative by time.",
    "WRONG_MOMENTUM": "It is not the derivative of the Lagrangian by that velocity.",
    "WRONG_FORCE": "It is not the derivative of the Lagrangian by that coordinate, with the forces without potential.",
    "WRONG_MOTION": "An equation that does not hold for the motion.",
    "NO_ACCELERATION": "An equation that holds but does not say what the acceleration is.",
    "INEQUALITY": "An inequality stands where an equation of motion was asked for.",
    "OTHER_COORDINATE": "The equation of motion of another coordinate.",
    "FOLLOWS": "It follows from the equations of motion.",
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
