"""What dofkit itself answers, doing no more than the question needs."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.exact.engines import BOTH, Engines
from dofkit.methods.ask import Reply, asked
from dofkit.methods.shared.reply import Knobs, MethodReply
from dofkit.methods.table import Question
from dofkit.scene.scene import Scene


def told(
    scene: Scene, question: Question, answer: Mapping[str, str] | None = None, engines: Engines = BOTH
) -> MethodReply:
    """The answer of some engines."""
    found: Reply = asked(scene, question, answer, engines=engines)
    value = sorted(found.value) if question == "redundancy" and found.value is not None else found.value
    return MethodReply(value, found.reason)


def dof(scene: Scene, knobs: Knobs) -> MethodReply:
    """The number of degrees of freedom, -1 for a contradiction."""
    del knobs
    return told(scene, "dof")


def integrability(scene: Scene, knobs: Knobs) -> MethodReply:
    """Whether each constraint is holonomic in the system."""
    del knobs
    return told(scene, "integrability")


def redundancy(scene: Scene, knobs: Knobs) -> MethodReply:
    """The constraints that can be dropped together."""
    del knobs
    return told(scene, "redundancy")


def equivalence(scene: Scene, knobs: Knobs, answer: Mapping[str, str]) -> MethodReply:
    """Whether the answer says the same as a constraint in the presence of the others."""
    del knobs
    return told(scene, "equivalence", answer)
