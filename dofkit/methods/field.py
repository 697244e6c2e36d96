"""One engine alone: exact arithmetic at random points modulo random primes of ``prime_bits`` bits."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.exact.engines import FIELD
from dofkit.exact.points.field import primes_of
from dofkit.methods.auto import told
from dofkit.methods.shared.reply import Knobs, MethodReply
from dofkit.methods.table import Question
from dofkit.scene.scene import Scene


def dof(scene: Scene, knobs: Knobs) -> MethodReply:
    """The freedom of the complex solutions."""
    return _told(scene, "dof", knobs)


def integrability(scene: Scene, knobs: Knobs) -> MethodReply:
    """By the Lie algebra along a random curve."""
    return _told(scene, "integrability", knobs)


def redundancy(scene: Scene, knobs: Knobs) -> MethodReply:
    """By rank at a random point."""
    return _told(scene, "redundancy", knobs)


def equivalence(scene: Scene, knobs: Knobs, answer: Mapping[str, str]) -> MethodReply:
    """By what holds at random states of the complex solutions."""
    return _told(scene, "equivalence", knobs, answer)


def _told(scene: Scene, question: Question, knobs: Knobs, answer: Mapping[str, str] | None = None) -> MethodReply:
    with primes_of(knobs.prime_bits):
        return told(scene, question, answer, FIELD)
