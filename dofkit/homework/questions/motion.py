"""Questions about equations of motion."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from dofkit.homework.judgement import Given, Judgement, needs_review
from dofkit.homework.key import Key
from dofkit.homework.questions.base import Earlier, QuestionBase
from dofkit.homework.words import one_text


class _MotionQuestion(QuestionBase):
    """Read as it is written; a person looks at it."""

    def read(self, answer: Given, key: Key) -> str:
        del key
        return one_text(answer)

    def solution(self, key: Key) -> str:
        del key
        return ""

    def judge(self, answer: Given, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        reason = "equations of motion are not graded by dofkit yet."
        return needs_review(self.read(answer, key), reason)


class Lagrangian(_MotionQuestion):
    """L = T - V."""

    ask: Literal["lagrangian"] = Field(description="the Lagrangian")


class Momentum(_MotionQuestion):
    """p = dL/d(qdot)."""

    ask: Literal["momentum"] = Field(description="a generalized momentum")
    coordinate: str = Field(description="the coordinate it belongs to")


class GeneralizedForce(_MotionQuestion):
    """dL/dq and the non-conservative forces."""

    ask: Literal["force"] = Field(description="a generalized force")
    coordinate: str = Field(description="the coordinate it belongs to")


class Motion(_MotionQuestion):
    """The equations of motion."""

    ask: Literal["motion"] = Field(description="an equation of motion, or all")
    coordinate: str | None = Field(None, description="the coordinate whose equation is asked for")
