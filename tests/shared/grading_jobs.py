"""A question whose answers do to their worker what the worst of bugs and attacks would do."""

from __future__ import annotations

import os
import pickle
import signal
from typing import Literal

from pydantic import Field

from dofkit.base.workers import MEMORY
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.assignment import Assignment, Prepared, Problem
from dofkit.homework.judgement import Given, Judgement, Reading, right
from dofkit.homework.key.key import Key
from dofkit.homework.questions import Earlier, QuestionBase
from dofkit.homework.runs.batch import Orders
from dofkit.scene.reading import load


class Hostile(QuestionBase):
    """``hang``, ``eat``, ``die``, ``fail``; everything else is right."""

    ask: Literal["hostile"] = Field("hostile", description="trouble")

    def readings(self, answer: Given, names: DeclaredNames) -> list[Reading]:
        del names
        return [Reading(answer, str(answer))]

    def judged(self, reading: Reading, key: Key, earlier: Earlier) -> Judgement:
        del key, earlier
        answer = reading.value
        while answer == "hang":
            pass
        if answer == "eat":
            bytearray(2 * MEMORY)
        if answer == "die":
            os.kill(os.getpid(), signal.SIGKILL)
        if answer == "fail":
            raise ValueError("a fault of dofkit")
        return right(str(answer))


def orders() -> Orders:
    """Two hostile questions about a scene; a second of processor time for each."""
    problem = Problem.model_construct(id="p", title=None, scene={}, questions=(Hostile(id="a"), Hostile(id="b")))
    assignment = Assignment.model_construct(title="t", convention="configuration", feedback="hint", problems=(problem,))
    prepared = Prepared(assignment, {"p": Key(load({"coordinates": ["x"]}))})
    return Orders(pickle.dumps(prepared), 2.0, hard=1.0, wall=20.0)
