"""Each method by itself: what it answers to each question, right or wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dofkit.methods.names import MethodName, Question
from dofkit.methods.shared.reply import Knobs, MethodReply, cannot
from dofkit.methods.shared.reporting import FAILURES
from dofkit.methods.table import METHODS
from dofkit.scene.reading import load
from dofkit.scene.scene import Scene

__all__ = ["Knobs", "MethodReply", "answered"]


def answered(
    scene: Scene | Mapping[str, Any],
    question: Question,
    method: MethodName,
    knobs: Knobs | None = None,
    answer: Mapping[str, str] | None = None,
) -> MethodReply:
    """What a method by itself answers to a question: what one would believe who trusted it, be it right or wrong.

    ``answer``: for ``equivalence``, ``{"constraint": NAME, "text": TEXT}``. Where the method cannot or does not
    answer, ``value`` is None and ``reason`` says why. Raises SceneError where the scene cannot be read.
    """
    work = METHODS[method].answering(question)
    if work is None:
        return cannot(f"{method} has no way to answer this: {METHODS[method].cannot}")
    given = scene if isinstance(scene, Scene) else load(scene)
    turned = Knobs() if knobs is None else knobs
    try:
        return work(given, turned, answer) if question == "equivalence" else work(given, turned)
    except OverflowError as error:
        return MethodReply(None, f"a number that occurs is too large or too small to compute with ({error})")
    except FAILURES as error:
        return MethodReply(None, str(error) or type(error).__name__)
