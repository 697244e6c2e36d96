"""Compares an answer with the integral of a differential constraint; the constant may be anywhere or left out.

`y = C x` is an integral of y dx - x dy = 0 because the form vanishes on every curve of this family, and because the
family has a curve through every point. The constant is therefore treated as a further coordinate with dC = 0.
"""

from __future__ import annotations

from dataclasses import replace

from dofkit.classification.equivalence import Leaves, leaves
from dofkit.expressions.text import Comparison
from dofkit.expressions.tree import ONE, parameter
from dofkit.homework.answers.relations import AnswerReading
from dofkit.homework.judgement import Judgement, needs_review, right, wrong
from dofkit.homework.key.compared_equations import ANSWER, lowered
from dofkit.homework.key.key import Key
from dofkit.homework.key.own_names import without_own
from dofkit.scene.added_equations import Read, with_equations
from dofkit.scene.constraints.base import Equation
from dofkit.scene.scene import Scene

#: Names of the constant of an expression without `=`: `x y` is read as x y = C.
_FRESH = ("C", "c", "K", "C_1", "const")
_LEFT_OUT = "The constant of integration is missing: `... = C`."


def integral_judgement(reading: AnswerReading, key: Key, name: str) -> Judgement:
    """Return the judgement of one reading of an answer as the integral of the constraint ``name``."""
    reading = reading.claim if reading.derived else reading
    if len(reading.relations) > 1 and reading.undeclared:
        return _in_parameters(reading, key, name)
    return _judgement(reading, key, name)


def _in_parameters(reading: AnswerReading, key: Key, name: str) -> Judgement:
    """Return the judgement of equations of which an undeclared name is the parameter: `x = r cos(a), y = r sin(a)`."""
    for parameter_name in reading.undeclared:
        gone = without_own(reading._replace(undeclared=(parameter_name,)), key.scene)
        if gone is None:
            continue
        constants = tuple(n for n in reading.undeclared if n != parameter_name)
        verdict = _judgement(gone._replace(undeclared=constants), key, name)
        if verdict.status == "right":
            return replace(verdict, read_as=reading.text)
    return needs_review(reading.text, "it could not be decided in the time available whether this is an integral.")


def _judgement(reading: AnswerReading, key: Key, name: str) -> Judgement:
    """Return the judgement of a reading whose undeclared names are all constants."""
    read = _with_constants(reading, key)
    if read.moving:
        return wrong(read.text, "NOT_INTEGRATED")
    remark = "" if read.constants else _LEFT_OUT
    family = _leaves(key, read, name)
    if family is Leaves.ALL or (family is Leaves.ONE and not read.constants):
        return right(read.text, remark)
    if family is Leaves.OPEN:
        return needs_review(read.text, "it could not be decided in the time available whether this is an integral.")
    return wrong(read.text, "WRONG_INTEGRAL")


def _with_constants(reading: AnswerReading, key: Key) -> Read:
    """Return the answer, `x y` as x y = C with a new constant; that of both sides of `s + C = R phi + C` is none."""
    undeclared = {parameter(n) for n in reading.undeclared}
    constants = undeclared & {s for c in reading.relations for s in (c.left - c.right).symbols}
    fresh = (parameter(n) for n in _FRESH if key.declared.names.lookup.meaning(n) is None)
    relations = []
    for c, bare in zip(reading.relations, reading.bare, strict=True):
        c = c.substituted(dict.fromkeys(undeclared - constants, ONE))
        if bare and not undeclared:
            c = Comparison(c.left, "=", next(fresh), c.column)
            constants.add(c.right)
        relations.append(c)
    return reading._replace(relations=tuple(relations)).read(frozenset(str(s.args[1]) for s in constants))


def _leaves(key: Key, read: Read, name: str) -> Leaves:
    """Return on which curves or surfaces of the answer's family the constraint is satisfied."""
    system, before = lowered(_with_still(key.scene, read)), len(key.scene.constraints)
    return leaves(system, system.numbers_of(name), range(before, before + len(read.texts)), read.constants)


def _with_still(scene: Scene, read: Read) -> Scene:
    """Return the scene with the answer added, its constants as coordinates C with dC = 0."""
    plain = Read(read.texts, frozenset(), read.text, read.moving)
    posed = with_equations(scene, plain, ANSWER)
    still = tuple(Equation(name=f"{ANSWER} keeps {c}", text=f"d{c} = 0") for c in sorted(read.constants))
    more = {"coordinates": (*posed.coordinates, *sorted(read.constants))}
    return posed.model_copy(update={"constraints": (*posed.constraints, *still), **more})
