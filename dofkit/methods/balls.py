"""One engine alone: balls of ``bits`` bits at real points."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.exact.engines import BALLS
from dofkit.exact.points.balls import balls_of
from dofkit.methods.auto import told
from dofkit.methods.shared.reply import Knobs, MethodReply
from dofkit.methods.table import Question
from dofkit.scene.scene import Scene


def dof(scene: Scene, knobs: Knobs) -> MethodReply:
    """By certified pivots; what a ball does not tell from 0 is taken for it."""
    return _told(scene, "dof", knobs)


def integrability(scene: Scene, knobs: Knobs) -> MethodReply:
    """By the Lie algebra along a curve, in balls."""
    return _told(scene, "integrability", knobs)


def redundancy(scene: Scene, knobs: Knobs) -> MethodReply:
    """By certified pivots at a real point."""
    return _told(scene, "redundancy", knobs)


def equivalence(scene: Scene, knobs: Knobs, answer: Mapping[str, str]) -> MethodReply:
    """By what holds at real states."""
    return _told(scene, "equivalence", knobs, answer)


def _told(scene: Scene, question: Question, knobs: Knobs, answer: Mapping[str, str] | None = None) -> MethodReply:
    with balls_of(knobs.bits):
        return told(scene, question, answer, BALLS)
