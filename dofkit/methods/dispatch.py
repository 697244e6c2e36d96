"""Each method by itself: what it answers to each question, right or wrong, and how sure it may be of it.

A module a method, named as the method is, with a function for each question it answers: ``dof(scene, knobs)``,
``integrability(scene, knobs)``, ``redundancy(scene, knobs)`` and ``equivalence(scene, knobs, answer)``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

from dofkit.base.deadline import OutOfTimeError
from dofkit.methods.shared.reply import Knobs, MethodReply, cannot
from dofkit.methods.table import METHODS, MethodName, Question
from dofkit.scene.reading import load
from dofkit.scene.scene import Scene

__all__ = ["Knobs", "MethodReply", "answered", "answering", "module_of"]

#: What a method may end with where a scene is not what it is for.
FAILURES = (ArithmeticError, OutOfTimeError, NotImplementedError, ValueError)


def module_of(method: MethodName) -> Any:
    """The module of a method, which has the name of its row."""
    return import_module(f"dofkit.methods.{method}")


def answering(method: MethodName, question: Question) -> Callable[..., MethodReply] | None:
    """The function that answers a question by a method; None where the method has none."""
    found: Callable[..., MethodReply] | None = None
    if question in METHODS[method].uses:
        found = getattr(module_of(method), question)
    return found


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
    work = answering(method, question)
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
