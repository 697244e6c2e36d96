"""All kinds of questions. A new kind is a class and an entry in `AnyQuestion`."""

from __future__ import annotations

from typing import Annotated, get_args

from pydantic import Field

from dofkit.homework.questions.base import Earlier, Identifier, Points, QuestionBase
from dofkit.homework.questions.equations import EquationQuestion, IntegralQuestion
from dofkit.homework.questions.labels import LabelQuestion
from dofkit.homework.questions.motion import GeneralizedForce, Lagrangian, Momentum, MotionQuestion
from dofkit.homework.questions.names import Coordinates, Redundant
from dofkit.homework.questions.numbers import CountQuestion, Dof, NumberQuestion, VelocityDof

__all__ = ["KINDS", "MOTION", "AnyQuestion", "Earlier", "Identifier", "NumberQuestion", "Points", "QuestionBase"]

AnyQuestion = Annotated[
    Dof
    | VelocityDof
    | CountQuestion
    | LabelQuestion
    | EquationQuestion
    | IntegralQuestion
    | Coordinates
    | Redundant
    | Lagrangian
    | Momentum
    | GeneralizedForce
    | MotionQuestion,
    Field(discriminator="ask"),
]

#: The kinds of questions about equations of motion.
MOTION = (Lagrangian, Momentum, GeneralizedForce, MotionQuestion)
#: {value of `ask`: class of the question}.
KINDS: dict[str, type[QuestionBase]] = {q.kind(): q for q in get_args(get_args(AnyQuestion)[0])}
