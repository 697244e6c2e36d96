"""How hard a problem is, as far as that can be counted: its size, the labels that are asked for, and its traps."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable
from typing import NamedTuple

from dofkit.homework.key.facts import SceneCounts
from dofkit.homework.key.key import Key
from dofkit.homework.key.misconceptions import ERRORS
from dofkit.homework.problem import Problem
from dofkit.homework.questions.equations import IntegralQuestion
from dofkit.homework.questions.labels import LabelQuestion, truths
from dofkit.homework.questions.names import Redundant
from dofkit.homework.questions.numbers import NumberQuestion

PROVED = "proved"


class Difficulty(NamedTuple):
    """``labels``: what is right of the labels asked for, and whether an integral or something redundant is there;
    ``traps``: the codes of errors that give a wrong number.
    """

    labels: tuple[Hashable, ...]
    traps: frozenset[str]

    def counted(self) -> Counter[Hashable]:
        """What is counted over a whole sheet."""
        return Counter([*self.labels, *self.traps])


def difficulty_of(problem: Problem, key: Key) -> Difficulty:
    """What the questions of a problem ask of its scene."""
    labels: list[Hashable] = []
    numbers = False
    for question in problem.questions:
        if isinstance(question, LabelQuestion):
            truth = truths(key.constraints[question.constraint])
            labels.append(tuple((part, truth[part]) for part in question.parts))
        elif isinstance(question, IntegralQuestion):
            labels.append(("integral", key.constraints[question.constraint].holonomic))
        elif isinstance(question, Redundant):
            labels.append(("redundant", bool(key.report.redundant)))
        numbers = numbers or isinstance(question, NumberQuestion)
    return Difficulty(tuple(labels), traps_of(key) if numbers else frozenset())


def traps_of(key: Key) -> frozenset[str]:
    """The errors that give a wrong number of degrees of freedom for a scene."""
    facts = SceneCounts(key)
    return frozenset(e.code for e in ERRORS if any(number != facts.dof for number in e.predicts(facts)))


def fit(key: Key, base: Key) -> str | None:
    """Why a variant of a problem is none to hand out; None where it is fit."""
    report = key.report
    if report.consistent is False:
        return "inconsistent"
    if report.verdict != PROVED or report.dof is None:
        return "the number of degrees of freedom is not proved"
    if (report.dof == 0) != (base.report.dof == 0):
        return "it has no freedom"
    if report.dof == len(key.coordinates) and base.report.dof != len(base.coordinates):
        return "it has no effective constraint"
    if len(key.coordinates) != len(base.coordinates):
        return "its size differs"
    if abs(len(report.constraints) - len(base.report.constraints)) > 1:
        return "its size differs"
    if any(entry.equations == 0 for entry in report.constraints):
        return "a constraint is empty"
    return None


def alike(key: Key, other: Key) -> bool:
    """Do two scenes of the same structure have the same answers, but for numbers and names in equations?"""
    first, second = key.report, other.report
    if (first.dof, first.velocity_dof, first.redundant) != (second.dof, second.velocity_dof, second.redundant):
        return False
    pairs = zip(first.constraints, second.constraints, strict=True)
    return all(
        (a.form, a.holonomic, a.scleronomic, a.bilateral, a.independent)
        == (b.form, b.holonomic, b.scleronomic, b.bilateral, b.independent)
        for a, b in pairs
    )
