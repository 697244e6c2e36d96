"""dofkit's own engines: both, or one of them alone, doing no more than the question needs."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass

from dofkit.exact.points.balls import balls_of
from dofkit.exact.points.field import primes_of
from dofkit.exact.zero import BALLS, FIELD, Engines
from dofkit.methods.ask import Reply, answered_by
from dofkit.methods.names import Question
from dofkit.methods.shared.reply import Knobs, MethodReply
from dofkit.scene.scene import Scene


@dataclass(frozen=True)
class EngineMethod:
    """Engines as a method; one alone takes the bits of its primes, or of its balls, from the knobs."""

    engines: Engines

    def dof(self, scene: Scene, knobs: Knobs) -> MethodReply:
        """The number of degrees of freedom, -1 for a contradiction; by the field alone that of complex solutions."""
        return self._reply(scene, "dof", knobs)

    def integrability(self, scene: Scene, knobs: Knobs) -> MethodReply:
        """Whether each constraint is holonomic in the system: the Lie algebra along a curve."""
        return self._reply(scene, "integrability", knobs)

    def redundancy(self, scene: Scene, knobs: Knobs) -> MethodReply:
        """The constraints that can be dropped together."""
        return self._reply(scene, "redundancy", knobs)

    def equivalence(self, scene: Scene, knobs: Knobs, answer: Mapping[str, str]) -> MethodReply:
        """Whether the answer says the same as a constraint in the presence of the others."""
        return self._reply(scene, "equivalence", knobs, answer)

    def _reply(
        self, scene: Scene, question: Question, knobs: Knobs, answer: Mapping[str, str] | None = None
    ) -> MethodReply:
        with ExitStack() as turned:
            if self.engines == FIELD:
                turned.enter_context(primes_of(knobs.prime_bits))
            if self.engines == BALLS:
                turned.enter_context(balls_of(knobs.bits))
            found: Reply = answered_by(scene, question, answer, engines=self.engines)
        value = sorted(found.value) if question == "redundancy" and found.value is not None else found.value
        return MethodReply(value, found.reason)
