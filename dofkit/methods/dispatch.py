"""One question asked of one method on its own: its answer, right or wrong."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack
from typing import Any

from dofkit.base.deadline import OutOfTimeError
from dofkit.exact.points.balls import balls_of
from dofkit.exact.points.field import primes_of
from dofkit.exact.zero import BALLS, FIELD, Engines
from dofkit.methods.ask import answered_by
from dofkit.methods.reply import Knobs, MethodReply, cannot
from dofkit.methods.table import METHODS, MethodName, Question, function_of
from dofkit.scene.reading import load
from dofkit.scene.scene import Scene

#: What a method may end with where a scene is not what it is for.
FAILURES = (ArithmeticError, OutOfTimeError, NotImplementedError, ValueError)


def answered(
    scene: Scene | Mapping[str, Any],
    question: Question,
    method: MethodName,
    knobs: Knobs | None = None,
    answer: Mapping[str, str] | None = None,
) -> MethodReply:
    """Return the answer that a reader would believe who trusted this method alone, right or wrong.

    ``answer``: for ``equivalence``, ``{"constraint": NAME, "text": TEXT}``. Where the method cannot or does not
    answer, ``value`` is None and ``reason`` says why. Raises SceneError where the scene cannot be read.
    """
    row, settings = METHODS[method], knobs or Knobs()
    if question not in row.uses:
        return cannot(f"{method} has no way to answer this: {row.cannot}")
    read = scene if isinstance(scene, Scene) else load(scene)
    try:
        if row.engines:
            return _by_engines(row.engines, read, question, settings, answer)
        work = function_of(method, question)
        return work(read, settings, answer) if question == "equivalence" else work(read, settings)
    except OverflowError as error:
        return MethodReply(None, f"a number that occurs is too large or too small to compute with ({error})")
    except FAILURES as error:
        return MethodReply(None, str(error) or type(error).__name__)


def _by_engines(
    engines: Engines, scene: Scene, question: Question, knobs: Knobs, answer: Mapping[str, str] | None
) -> MethodReply:
    """Return the answer of dofkit's engines; one alone takes the bits of its primes, or of its balls."""
    with ExitStack() as precisions:
        if engines == FIELD:
            precisions.enter_context(primes_of(knobs.prime_bits))
        if engines == BALLS:
            precisions.enter_context(balls_of(knobs.bits))
        reply = answered_by(scene, question, answer, engines=engines)
    value = sorted(reply.value) if question == "redundancy" and reply.value is not None else reply.value
    return MethodReply(value, reply.reason, verdict=reply.verdict)
