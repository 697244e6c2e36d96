"""Questions about equations of motion: the Lagrangian, momenta, forces, and the equations themselves."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import ClassVar, Literal

from pydantic import Field

from dofkit.base.errors import DofkitError
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.judgement import HALF, Given, Judgement, Reading, Sentence, needs_review, partly, right, wrong
from dofkit.homework.key.compared_equations import undeclared
from dofkit.homework.key.compared_motion import AnsweredMotion, Followed, same_lagrangian
from dofkit.homework.key.compared_motion import MotionSameness as Found
from dofkit.homework.key.key import Key
from dofkit.homework.key.own_coordinates import offered
from dofkit.homework.key.posed_motion import PosedMotion, motion_readings, posed_motion
from dofkit.homework.key.right_motion import RightMotion, is_zero
from dofkit.homework.questions.base import Earlier, QuestionBase
from dofkit.homework.sentences import Said, say


class _MotionQuestion(QuestionBase):
    """The base class of these questions: an answer may define coordinates, in which it is judged."""

    def readings(self, answer: Given, names: DeclaredNames) -> list[Reading]:
        return motion_readings(answer, names, value=isinstance(self, _Value))

    def judged(self, reading: Reading, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        return self._judged(posed_motion(reading.value, key, isinstance(self, _Value)), reading.text)

    def _judged(self, posed: PosedMotion, text: str) -> Judgement:
        for guess in posed.guesses:
            judgement = self._judged(guess, text)
            if judgement.status == "right":
                return judgement.saying("The names differ from those of the problem; they were matched to them.")
        if posed.strange:
            return needs_review(text, undeclared(posed.strange))
        motion = posed.key.motion
        if isinstance(motion, DofkitError):
            return needs_review(text, say("the equations of motion could not be derived ({reason}).", reason=motion))
        return self._judgement(posed, motion, text)

    def _judgement(self, posed: PosedMotion, motion: RightMotion, text: str) -> Judgement:
        raise NotImplementedError

    def solution(self, key: Key) -> Sentence:
        """Return a correct answer, if possible in the coordinates that the assignment offers."""
        if key.also and getattr(self, "coordinate", None) is None:
            motion = offered(key, sorted(key.also)).motion
            if not isinstance(motion, DofkitError) and set(motion.names) <= set(key.also):
                return self._solution(motion)
        return "" if isinstance(key.motion, DofkitError) else self._solution(key.motion)

    def _solution(self, motion: RightMotion) -> Sentence:
        raise NotImplementedError


class _Value(_MotionQuestion):
    """A question for one expression; a leading name such as `L =` is ignored."""

    def _judgement(self, posed: PosedMotion, motion: RightMotion, text: str) -> Judgement:
        return self._comparison(motion.in_kept(posed.value), motion, text)

    def _comparison(self, expression: Expr, motion: RightMotion, text: str) -> Judgement:
        raise NotImplementedError


class Lagrangian(_Value):
    """L = T - V, up to a total time derivative (the difference satisfies Euler's equation identically)."""

    ask: Literal["lagrangian"] = Field(description="the Lagrangian")

    def _comparison(self, expression: Expr, motion: RightMotion, text: str) -> Judgement:
        same = same_lagrangian(expression, motion.lagrangian, motion)
        if same:
            return right(text)
        if same is None:
            return needs_review(text, "it could not be decided whether this Lagrangian gives the same motion.")
        if same_lagrangian(expression, motion.total, motion):
            return wrong(text, "TOTAL_ENERGY")
        if same_lagrangian(expression, -motion.lagrangian, motion):
            return wrong(text, "SIGN", why="This is V - T; the Lagrangian is T - V.")
        return wrong(text, "WRONG_LAGRANGIAN")

    def _solution(self, motion: RightMotion) -> Sentence:
        return say("A correct answer is {text}.", text=f"L = {to_text(motion.lagrangian)}")


class _OfCoordinate(_Value):
    """Momenta and forces; an answer that may be right in other coordinates or conventions needs a review."""

    #: The code of a wrong answer.
    code: ClassVar[str]
    coordinate: str = Field(description="the coordinate it belongs to")

    def _right(self, motion: RightMotion) -> tuple[Expr | None, Expr]:
        """Return the right expressions (in the remaining coordinates or None, before elimination)."""
        raise NotImplementedError

    def _others(self, motion: RightMotion) -> list[Expr]:
        """Return what may be right in other conventions: the expression before elimination."""
        return [self._right(motion)[1]] if motion.motions else []

    def _comparison(self, expression: Expr, motion: RightMotion, text: str) -> Judgement:
        reduced, unreduced = self._right(motion)
        wanted = unreduced if reduced is None else reduced
        same = motion.zero(expression - wanted)
        if same:
            return right(text)
        if same is None:
            return needs_review(text, "it could not be decided whether this is equal to the correct expression.")
        if reduced is None or any(motion.zero(expression - other) is not False for other in self._others(motion)):
            return needs_review(text, "it may be right for other generalized coordinates, or in another convention.")
        if motion.zero(expression + wanted):
            return wrong(text, "SIGN")
        return wrong(text, self.code)

    def _solution(self, motion: RightMotion) -> Sentence:
        reduced, unreduced = self._right(motion)
        return say("A correct answer is {text}.", text=to_text(unreduced if reduced is None else reduced))


class Momentum(_OfCoordinate):
    """p = dL/d(qdot)."""

    code: ClassVar[str] = "WRONG_MOMENTUM"
    ask: Literal["momentum"] = Field(description="a generalized momentum")

    def _right(self, motion: RightMotion) -> tuple[Expr | None, Expr]:
        return motion.momenta.get(self.coordinate), motion.unreduced[self.coordinate][0]


class GeneralizedForce(_OfCoordinate):
    """dL/dq and the non-conservative forces."""

    code: ClassVar[str] = "WRONG_FORCE"
    ask: Literal["force"] = Field(description="a generalized force")

    def _right(self, motion: RightMotion) -> tuple[Expr | None, Expr]:
        return motion.forces.get(self.coordinate), motion.unreduced[self.coordinate][1]

    def _others(self, motion: RightMotion) -> list[Expr]:
        """Return also the forces without the derivative of T, and of L, by the coordinate."""
        energies = ((motion.total + motion.lagrangian) * ex.HALF, motion.lagrangian)
        forces = [motion.forces[self.coordinate] - diff(e, ex.coordinate(self.coordinate)) for e in energies]
        return super()._others(motion) + [force for force in forces if not force.is_zero]


class MotionQuestion(_MotionQuestion):
    """The equations of motion, up to factors and linear combinations."""

    ask: Literal["motion"] = Field(description="an equation of motion, or all of them")
    coordinate: str | None = Field(None, description="the coordinate whose equation is asked for")

    def _asked(self, about: str) -> Said:
        sentence = "What is the equation of motion for {about}?"
        return say(sentence, about=about) if self.coordinate is not None else super()._asked(about)

    def _judgement(self, posed: PosedMotion, motion: RightMotion, text: str) -> Judgement:
        relations, names_of_multipliers, key = posed.relations, posed.multipliers, posed.key
        if any(c.relation != "=" for c in relations):
            return wrong(text, "INEQUALITY")
        equations = tuple(c.left - c.right for c in relations)
        answered = AnsweredMotion(motion, equations, names_of_multipliers)
        followed = answered.follow()
        if followed is None and self.coordinate is None and isinstance(key.whole_motion, RightMotion):
            motion = key.whole_motion
            followed = AnsweredMotion(motion, equations, names_of_multipliers).follow()
        if followed is None:
            return needs_review(text, "it could not be decided whether these are the equations of motion.")
        if followed.contradictory:
            return needs_review(text, "the answer contradicts itself.")
        single = self.coordinate is not None and self.coordinate in motion.names
        return self._single(answered, followed.sameness, motion, text) if single else _all(followed, motion, text)

    def _single(self, answered: AnsweredMotion, sameness: Sequence[Found], motion: RightMotion, text: str) -> Judgement:
        """Return the judgement of one coordinate's equation, which contains its acceleration and is not another's."""
        if answered.multipliers or motion.multipliers:
            return needs_review(text, "a single equation with multipliers can be written in many ways.")
        if Found.NOT in sameness:
            return wrong(text, Found.NOT.value)
        rows = [r for r, t in zip(answered.rows or (), sameness, strict=True) if t is Found.FOLLOWS]
        place = motion.names.index(self.coordinate or "")
        if not any(is_zero(row[place], motion.positive) is False for row in rows):
            return wrong(text, Found.TRIVIAL.value)
        if len(rows) == 1 and len(motion.names) > 1:
            proportional = [_proportional(rows[0][:-1], other[:-1], motion.positive) for other in answered.right]
            if not proportional[place] and any(proportional):
                return wrong(text, "OTHER_COORDINATE")
        return right(text)

    def _solution(self, motion: RightMotion) -> Sentence:
        of_coordinates = motion.equations
        equation = None if self.coordinate is None else of_coordinates.get(self.coordinate)
        chosen = list(of_coordinates.values()) if equation is None else [equation]
        return say("A correct answer is {text}.", text="; ".join(f"{to_text(e)} = 0" for e in chosen))


def _all(followed: Followed, motion: RightMotion, text: str) -> Judgement:
    """Return the judgement of all equations: points in proportion to the accelerations that they determine."""
    sameness, rank = followed.sameness, followed.rank
    wanted = len(motion.names) - len(motion.rows)
    good = Found.NOT not in sameness
    if good and rank >= wanted:
        return right(text)
    if good and rank <= 0:
        why = "No acceleration is determined by this: write accelerations such as {name}."
        return wrong(text, "WEAKER", why=say(why, name=f"{motion.names[0]}ddot"))
    if good:
        share = Fraction(max(rank, 0), wanted)
        missing = say(
            "These equations determine only {number} of the {all} accelerations: an equation is missing.",
            number=max(rank, 0),
            all=wanted,
        )
        return partly(share, text, "WEAKER", why=missing)
    share = Fraction(max(0, min(rank, wanted - 1)), wanted) if wanted > 1 else (HALF if rank else Fraction(0))
    number = sum(t is Found.NOT for t in sameness)
    if len(sameness) == 1:
        return partly(share, text, Found.NOT.value)
    sentence = "Equations that are not satisfied by the motion: {number} of {all}."
    failing = say(sentence, number=number, all=len(sameness))
    return partly(share, text, Found.NOT.value, why=failing)


def _proportional(a: Sequence[Expr], b: Sequence[Expr], positive: frozenset[Expr]) -> bool:
    """Return whether two rows are multiples of each other."""
    pairs = [(i, j) for i in range(len(a)) for j in range(i)]
    return all(is_zero(a[i] * b[j] - a[j] * b[i], positive) for i, j in pairs)
