"""Compares the equations of an answer with constraints of the scene: the same, one branch, weaker, different, ..."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

from dofkit.base.errors import SceneError, TextError
from dofkit.classification.equivalence import Compared, Sameness, compare
from dofkit.expressions.text import parse_relations, to_text
from dofkit.expressions.tree import Expr
from dofkit.homework.answers.relations import AnswerReading, is_constant_name
from dofkit.homework.judgement import HALF, NOTHING, JudgedReading, Judgement, needs_review, partly, right, wrong
from dofkit.homework.key.counterexamples import counterexample
from dofkit.homework.key.key import Key
from dofkit.homework.key.own_names import renamed, without_own
from dofkit.homework.sentences import Said, meanings, say
from dofkit.methods.classify import classify
from dofkit.scene.added_equations import Read, with_equations
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene
from dofkit.system import Relation, System

_UNDECIDED = "it could not be decided in the time available whether this is the same constraint."
#: Results of the comparison that are worth half of the points; and those worth all.
_HALVES = frozenset({Sameness.IRREGULAR, Sameness.BRANCH, Sameness.DIFFERENTIATED, Sameness.WITHOUT_CONSTANT})
_RIGHT = frozenset({Sameness.SAME, Sameness.INTEGRATED})
#: The name of an answer's equations in a scene to which they are added.
ANSWER = "the answer"
_ALLOWS = "Your equation allows {point}, which the constraint forbids."
_FORBIDS = "Your equation forbids {point}, which the constraint allows."
_INEQUALITY_ALLOWS = "Your inequality allows {point}, which the constraint forbids."
_INEQUALITY_FORBIDS = "Your inequality forbids {point}, which the constraint allows."
#: The generated name of the square of a length without a name, in equations of a scene.
_UNNAMED = re.compile(r"\b_[A-Z]\d+\b")


def lowered(scene: Scene) -> System:
    """Return the system of a scene with an answer. Raises TextError if the answer's equations are invalid in it."""
    try:
        return lower(scene)
    except SceneError as error:
        fault = error.faults[0]
        raise TextError(fault.message, fault.column or 1, fault.hint) from None


@dataclass(frozen=True)
class EquationComparison:
    """Compares answers with the constraints ``names`` of a scene."""

    key: Key
    names: tuple[str, ...]

    def judgement(self, reading: AnswerReading) -> Judgement:
        """Return the judgement of one reading of an answer; with unexplained names it needs a review."""
        verdict = self._compared_reading(reading)
        if verdict.codes == (Sameness.EMPTY.value,) and len(reading.relations) > 1 and not reading.derived:
            return self._contradictory(reading) or verdict
        if reading.derived and verdict.status != "right":
            last = self._compared_reading(reading.claim)
            if last.status == "right":
                return last
            return needs_review(reading.text, "it is not clear whether only the last equation is meant.")
        return verdict

    def _contradictory(self, reading: AnswerReading) -> Judgement | None:
        """Return that contradictory equations need a review, if one of them is worth points, else None."""
        readings = []
        for relation, bare in zip(reading.relations, reading.bare, strict=True):
            single = reading._replace(relations=(relation,), bare=(bare,))
            with suppress(TextError):
                verdict = self._compared_reading(single)
                readings.append(JudgedReading(verdict.read_as, verdict.share))
        if all(share == NOTHING for _, share in readings):
            return None
        return replace(needs_review(reading.text, "the answer contradicts itself."), readings=tuple(readings))

    def _compared_reading(self, reading: AnswerReading) -> Judgement:
        """Return the judgement after undeclared names are read as constants, eliminated or matched to declared ones."""
        if not reading.undeclared:
            return self._declared(reading)
        if not reading.on_coordinates:
            return self._undecided(reading)
        forms = any(self.key.constraints[name].form == "pfaffian" for name in self.names)
        if forms and not reading.moving and not reading.read().moving:
            verdict = self._verdict(reading.read(frozenset(reading.undeclared)), reading.text)
            if verdict.status in ("right", "partly") or all(map(is_constant_name, reading.undeclared)):
                return verdict
        gone = without_own(reading, self.key.scene)
        if gone is not None:
            return self._declared(gone, reading.text)
        for other, names in renamed(reading, self.key.scene, self.key.declared.constants):
            verdict = self._declared(other)
            if verdict.status == "right":
                listing = ", ".join(f"{undeclared_name} = {name}" for undeclared_name, name in names.items())
                return right(other.text, say("The names were matched to those of the problem: {names}.", names=listing))
        return self._undecided(reading)

    def _undecided(self, reading: AnswerReading) -> Judgement:
        """Return that an equation needs a review, because of an undeclared name or an undecided comparison."""
        strange = [name for name in reading.undeclared if name not in self.key.also]
        return needs_review(reading.text, undeclared(strange[0]) if strange else _UNDECIDED)

    def _declared(self, reading: AnswerReading, text: str = "") -> Judgement:
        if not reading.on_coordinates and reading.symbols:
            raise TextError("the answer contains no coordinates", 1, "write an equation between the coordinates")
        if any(s.args[0] == "acceleration" for s in reading.symbols):
            return needs_review(reading.text, "it contains accelerations.")
        verdict = self._verdict(reading.read(), text or reading.text)
        return self._with_counterexample(verdict, reading) if verdict.share == NOTHING else verdict

    def _with_counterexample(self, verdict: Judgement, reading: AnswerReading) -> Judgement:
        """Return a judgement with a state, if one is found, that only the answer or only the constraints allow."""
        relations = [c.relation for c in reading.relations] + [r.sense for r in self._asked]
        if verdict.codes == (Sameness.EMPTY.value,) or any(relation != "=" for relation in relations):
            return verdict
        answer, asked = [c.left - c.right for c in reading.relations], [r.expr for r in self._asked]
        if verdict.codes == (Sameness.STRONGER.value,):
            sentence, point = _FORBIDS, counterexample(self._others, asked, answer)
        else:
            sentence, point = _ALLOWS, counterexample(self._others, answer, asked)
        return verdict.saying(say(sentence, point=point)) if point else verdict

    @property
    def _asked(self) -> list[Relation]:
        """The relations of the constraints ``names``."""
        system = self.key.system
        return [r for i in system.numbers_of(*self.names) for r in system.constraints[i].relations]

    def _verdict(self, read: Read, text: str) -> Judgement:
        comparison = self.key.once((self.names, read.texts, read.constants), lambda: self._compared(read))
        if comparison.sameness is Sameness.UNDECIDED:
            return needs_review(text, _UNDECIDED)
        if comparison.sameness is Sameness.BOUNDARY:
            return needs_review(text, "it differs from the constraint on the boundary only.")
        code = comparison.sameness.value
        if comparison.sameness in _RIGHT:
            return right(text, meanings().get(code, ""))
        if comparison.sameness in _HALVES:
            return partly(HALF, text, code)
        judgement = self._in_part(comparison, read, text, code)
        point = counterexample(self._others, (), (), [q.expr for q in comparison.system]) if comparison.system else ""
        stronger = comparison.sameness is Sameness.STRONGER
        sentence = _INEQUALITY_FORBIDS if stronger else _INEQUALITY_ALLOWS
        return replace(judgement, said=(say(sentence, point=point),)) if point else judgement

    @cached_property
    def _others(self) -> Scene:
        """The scene without the constraints ``names``."""
        pairs = zip(self.key.scene.constraints, self.key.constraints, strict=True)
        kept = tuple(c for c, name in pairs if name not in self.names)
        return self.key.scene.model_copy(update={"constraints": kept, "expect": {}, "energies": None})

    def _is_product(self, text: str) -> bool:
        """Return whether an equation sets a product to 0, so that it is satisfied on more than one surface."""
        (c,) = parse_relations(text, self.key.declared.names)
        e = c.left - c.right if not c.right.is_zero else c.left
        return e.op == "mul" and sum(any(s.args[0] != "parameter" for s in f.symbols) for f in e.args) > 1

    def _by_rank(self, read: Read, text: str, code: str) -> Judgement:
        """Return the judgement of implied equations, by the number of independent velocities that they leave."""
        scene = self._others
        free = classify(scene).velocity_dof
        yours, system = classify(with_equations(scene, read, ANSWER)).velocity_dof, self.key.report.velocity_dof
        if free is None or yours is None or system is None:
            return needs_review(text, _UNDECIDED)
        if free - system < 2 or not system < yours < free or any(map(self._is_product, read.texts)):
            return wrong(text, code)
        more = "Your equations leave {yours} independent velocities; the system has {system}: equations are missing."
        count = say(more, yours=yours, system=system)
        return partly(Fraction(free - yours, free - system), text, code, why=count)

    def _compared(self, read: Read) -> Compared:
        system = lowered(with_equations(self.key.scene, read, ANSWER)).in_coordinates
        answer = range(len(self.key.scene.constraints), len(system.constraints))
        return compare(system, system.numbers_of(*self.names), answer, read.constants)

    def _in_part(self, comparison: Compared, read: Read, text: str, code: str) -> Judgement:
        """Return the judgement in proportion to the constraints that the answer implies, or to its rank."""
        met = comparison.met
        share = Fraction(sum(met), len(met)) if len(self.names) > 1 and met else NOTHING
        if comparison.sameness is Sameness.WEAKER and share == NOTHING and len(self.names) > 1:
            return self._by_rank(read, text, code)
        if not 0 < share < 1:
            return wrong(text, code)
        count = say("It implies {number} of the {all} constraints.", number=sum(met), all=len(self.names))
        return partly(share, text, code).saying(count)


def undeclared(name: str) -> Said:
    """Return the sentence that a name is not declared."""
    return say("the name {name} is not declared.", name=name)


def equations_of(key: Key, names: tuple[str, ...]) -> str:
    """Return the equations of these constraints, separated by semicolons; a written equation is unchanged.

    If equations contain names that an answer cannot use, such as rotations of a spatial body, the constraint is
    described in words.
    """
    return "; ".join(_equations(key, name) for name in names)


def _equations(key: Key, name: str) -> str:
    entry = key.constraints[name]
    (constraint,) = (c for c in key.system.constraints if c.name == name)
    if constraint.facts.written or not all(_sayable(key, relation.expr) for relation in constraint.relations):
        return entry.text
    texts = [f"{to_text(relation.expr)} {relation.sense} 0" for relation in constraint.relations]
    return "; ".join(_UNNAMED.sub("const", text) for text in texts)


def _sayable(key: Key, expr: Expr) -> bool:
    """Return whether all names in an expression are declared, except squares of unnamed lengths."""
    declared = {*key.declared.names.coordinates, *key.declared.names.parameters}
    names = {str(s.args[-1]) for s in expr.symbols if s.args[0] != "time"}
    return all(name in declared or _UNNAMED.fullmatch(name) for name in names)
