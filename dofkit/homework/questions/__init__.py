"""All kinds of questions. A new kind is a class here and a place in `AnyQuestion`."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from dofkit.homework.questions.base import Earlier, Identifier, Points, QuestionBase
from dofkit.homework.questions.equations import EquationQuestion, IntegralQuestion
from dofkit.homework.questions.labels import Label
from dofkit.homework.questions.motion import GeneralizedForce, Lagrangian, Momentum, Motion
from dofkit.homework.questions.names import Coordinates, Redundant
from dofkit.homework.questions.numbers import Count, Dof, VelocityDof

__all__ = ["KINDS", "AnyQuestion", "Earlier", "Identifier", "Points", "QuestionBase"]

AnyQuestion = Annotated[
    Dof
    | VelocityDof
    | Count
    | Label
    | EquationQuestion
    | IntegralQuestion
    | Coordinates
    | Redundant
    | Lagrangian
    | Momentum
    | GeneralizedForce
    | Motion,
    Field(discriminator="ask"),
]

#: What can be asked for -> its class.
KINDS: dict[str, type[QuestionBase]] = {
    q.kind(): q
    for q in (
        Dof, VelocityDof, Count, Label, EquationQuestion, IntegralQuestion, Coordinates, Redundant,
        Lagrangian, Momentum, GeneralizedForce, Motion,
    )
}  # fmt: skip
