"""Is an answer the same constraint as the one that was asked for, in the presence of the scene's others?

With O the other constraints, F those asked for and G the answer: they say the same where O and F imply G, and O and G
imply F. What else there is, is distinguished: the same set, but irregular there (the gradient vanishes on it), one
branch, weaker, stronger, different, empty, differentiated, integrated with or without its constant.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from itertools import islice
from itertools import product as cartesian

from dofkit.base.deadline import part, unless_late
from dofkit.classification.dependence.comparison import (
    MAX_BRANCHES,
    Regularity,
    bounds,
    loses_nothing,
    same_side,
    same_up_to_numbers,
    unsound,
)
from dofkit.classification.dependence.implication import follows
from dofkit.classification.freedom.branches import Outcome, solve
from dofkit.classification.freedom.preparation import all_of, prepared
from dofkit.exact.points.balls import precise_for
from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.pieces import UNDONE_NOTE, Finite, Normal, Pfaffian, Reduced
from dofkit.relations.setting import Setting
from dofkit.system import System

#: The share of the time that is left in which an answer may be found impossible.
POSSIBLE = 0.3
#: Functions whose values are angles.
ANGLES = frozenset({"asin", "acos", "atan", "atan2"})


class Sameness(Enum):
    """How an answer compares with the constraints that were asked for; the value is a stable code."""

    SAME = "SAME"
    IRREGULAR = "IRREGULAR"
    BRANCH = "ONE_BRANCH"
    DIFFERENTIATED = "DIFFERENTIATED"
    INTEGRATED = "INTEGRATED"
    WITHOUT_CONSTANT = "INTEGRATED_NO_CONSTANT"
    WEAKER = "WEAKER"
    STRONGER = "STRONGER"
    DIFFERENT = "DIFFERENT"
    EMPTY = "EMPTY"
    UNDECIDED = "UNDECIDED"


class Leaves(Enum):
    """What geometric equations are together with forms: leaves through every point, one leaf, or neither."""

    ALL = "ALL"
    ONE = "ONE"
    NONE = "NONE"
    OPEN = "OPEN"


@dataclass(frozen=True)
class Compared:
    """What was found; ``met``: for every constraint asked for, does it follow from what is right in the answer?"""

    sameness: Sameness
    met: tuple[bool, ...] = ()


def compare(
    system: System,
    asked: Sequence[int],
    answer: Sequence[int],
    constants: frozenset[str] = frozenset(),
    engines: Engines = BOTH,
) -> Compared:
    """Compare the constraints of ``system`` numbered ``answer`` with those numbered ``asked``.

    ``constants``: parameters that the answer brought with it, as constants of integration; ``engines`` decide.
    """
    with precise_for(system.longest):
        return _comparison(system, asked, answer, constants, engines).result()


def is_integral(system: System, asked: Sequence[int], answer: Sequence[int]) -> bool | None:
    """Return whether the constraints ``answer`` are geometric equations to which those numbered ``asked`` integrate.

    Are the differentials of the answer and the forms the same in the presence of the others? None: undecided.
    """
    with precise_for(system.longest):
        return _comparison(system, asked, answer, frozenset()).integrates()


def leaves(system: System, asked: Sequence[int], answer: Sequence[int], constants: frozenset[str]) -> Leaves:
    """Return whether the forms ``asked`` vanish on what the answer describes, and that is as large as they allow.

    ``constants``: coordinates of ``system`` that other constraints keep still; the leaves are numbered by them.
    """
    with precise_for(system.longest):
        return _comparison(system, asked, answer, frozenset()).leaves(constants)


def _comparison(
    system: System, asked: Sequence[int], answer: Sequence[int], constants: frozenset[str], engines: Engines = BOTH
) -> Equivalence:
    reduced, setting = prepared(system)
    others = [r for i, r in enumerate(reduced) if i not in {*asked, *answer}]
    relations = [reduced[i] for i in asked], [reduced[i] for i in answer], others
    return Equivalence(system, replace(setting, engines=engines), *relations, constants)


@dataclass(frozen=True)
class Equivalence:
    """An answer, ``submitted``, with the constraints that are ``wanted``, in the ``context`` of all others."""

    system: System
    setting: Setting
    wanted: Sequence[Reduced]
    submitted: Sequence[Reduced]
    context: Sequence[Reduced]
    constants: frozenset[str]

    def result(self) -> Compared:
        """What the answer is."""
        if any(r.inequalities for r in (*self.wanted, *self.submitted)):
            return self._unilateral()
        if same_up_to_numbers(self.submitted, self.wanted, self.setting.positive):
            return Compared(Sameness.SAME, tuple(True for _ in self.wanted))
        sound = self._sound
        kept = [g for g, s in zip(self._answer, sound, strict=True) if s is True]
        met = [self._follow(r.normals, kept) for r in self.wanted]
        if None in sound or None in met:
            # What was decided may be enough to say that the answer is none.
            return Compared(Sameness.UNDECIDED) if self._possible else self._empty
        answer = tuple(bool(m) for m in met)
        if all(answer) and all(sound):
            return Compared(self._regularity(), answer)
        if all(answer):
            return Compared(self._too_strong(), answer)
        differentiated = all(sound) and not any(answer) and self._differentiated()
        if differentiated is not False:
            return Compared(Sameness.DIFFERENTIATED if differentiated else Sameness.UNDECIDED, answer)
        if not self._possible:
            return self._empty
        integrated = self._integrated()
        if integrated is not None:
            return Compared(integrated, answer)
        if all(sound):
            return Compared(Sameness.WEAKER, answer)
        implied = self._follow(self._all_wanted, self._answer)
        if implied is None:
            return Compared(Sameness.UNDECIDED, answer)
        return Compared(self._too_strong() if implied else Sameness.DIFFERENT, answer)

    @cached_property
    def _answer(self) -> list[Normal]:
        return _normals(self.submitted)

    @cached_property
    def _all_wanted(self) -> list[Normal]:
        return _normals(self.wanted)

    @cached_property
    def _others(self) -> list[Normal]:
        return _normals(self.context)

    @cached_property
    def _sound(self) -> list[bool | None]:
        """Which relations of the answer follow from what was asked for."""
        return [follows(g, [*self._others, *self._all_wanted], self.setting) for g in self._answer]

    def _follow(self, what: Sequence[Normal], premises: Sequence[Normal]) -> bool | None:
        """Return whether the relations all follow from the others and the premises."""
        return all_of(follows(n, [*self._others, *premises], self.setting) for n in what)

    @property
    def _empty(self) -> Compared:
        return Compared(Sameness.EMPTY, (False,) * len(self.wanted))

    @cached_property
    def _possible(self) -> bool:
        """Return whether the others and the answer can be satisfied together."""
        with part(POSSIBLE):
            return unless_late(lambda: self._with(self.submitted).consistent is not False, True)

    def _with(self, constraints: Sequence[Reduced]) -> Outcome:
        return solve([*self.context, *constraints], self.setting)

    def _too_strong(self) -> Sameness:
        """The answer implies what was asked for, and more."""
        if not self._possible:
            return Sameness.EMPTY
        integrated = self._integrated()
        if integrated is not None:
            return integrated
        mine, asked = self._with(self.submitted), self._with(self.wanted)
        if None in (mine.dof, asked.dof, mine.velocity_dof, asked.velocity_dof):
            return Sameness.UNDECIDED
        if (mine.dof, mine.velocity_dof) != (asked.dof, asked.velocity_dof):
            return Sameness.STRONGER
        if all(r.constraint.facts.half_turns for r in self.wanted):
            return Sameness.SAME
        if _turned(self.submitted, self._answer):
            return Sameness.UNDECIDED
        sides = bounds(self._all_wanted, self.context)
        lost = unsound(self.submitted, self._sound) if sides else []
        whole = [loses_nothing(e, self._all_wanted, self._others, sides, self.setting) for e in lost]
        return Sameness.BRANCH if not sides else Sameness.SAME if whole and all(whole) else Sameness.UNDECIDED

    # differentials

    def _differentiated(self) -> bool | None:
        """Return whether the answer is obtained by differentiating the geometric equations that were asked for.

        None where that was not decided.
        """
        finite = _finite(self._all_wanted)
        if not finite or any(isinstance(p, Finite) for n in self._answer for p in n.pieces):
            return False
        return self._follow([_differential(g) for g in finite], self._answer)

    def _integrated(self) -> Sameness | None:
        """Return how the answer states in geometric equations what was asked for in forms; None if it does not."""
        integrates = self.integrates()
        if not integrates:
            return None if integrates is False else Sameness.UNDECIDED
        new = [g for g, sound in zip(_finite(self._answer), self._sound, strict=True) if not sound]
        constants_in = [{s for s in g.symbols if s.args[1] in self.constants} for g in new]
        return Sameness.INTEGRATED if all(constants_in) else Sameness.WITHOUT_CONSTANT

    def integrates(self) -> bool | None:
        """Return whether the answer is finite, and its differentials are the forms that were asked for.

        Geometric equations among what was asked for follow from the answer itself. None where that was not decided.
        """
        finite = _finite(self._answer)
        standing = [n for n in self._all_wanted if all(isinstance(p, Finite) for p in n.pieces)]
        moving = [n for n in self._all_wanted if n not in standing]
        if not moving or not finite or len(finite) != len(self._answer):
            return False
        rates = [_differential(g) for g in finite]
        answer = self._follow(rates, self._all_wanted)
        answer = self._follow(standing, self._answer) if answer else answer
        return self._follow(moving, [*standing, *rates]) if answer else answer

    def leaves(self, constants: frozenset[str]) -> Leaves:
        """Leaves of the forms: they vanish there, and as many velocities are free as the forms leave.

        Where there are other forms, one of several constants may be that of another integral: that is undecided. So is
        what vanishes on one branch of the others only.
        """
        finite = _finite(self._answer)
        if not finite or len(finite) != len(self._answer):
            whole = all(isinstance(p, Finite) for n in self._answer for p in n.pieces)
            return Leaves.OPEN if whole and self._answer else Leaves.NONE
        if not self._possible:
            return Leaves.NONE
        named = {str(s.args[1]) for g in finite for s in g.symbols if s.args[0] == "coordinate"}
        moving = {q for n in self._all_wanted for q in _moved(n)}
        answer = self._follow(self._all_wanted, self._answer)
        if not answer:
            borrowed = len(named & constants) > 1 and any(_moved(n) - constants for n in self._others)
            on_branches = (self._follow(self._all_wanted, [*self._answer, *b]) for b in _branches_of(self._others))
            nowhere = answer is False and not borrowed and all(a is False for a in on_branches)
            return Leaves.NONE if nowhere else Leaves.OPEN
        mine, asked = self._with(self.submitted), self._with(self.wanted)
        if mine.velocity_dof is None or asked.velocity_dof is None:
            return Leaves.OPEN
        if mine.velocity_dof != asked.velocity_dof:
            return Leaves.NONE
        if len(moving) > 1 and len(named - constants) < 2:
            return Leaves.OPEN
        return Leaves.ALL if named & constants else Leaves.ONE

    def _regularity(self) -> Sameness:
        """The same set: is the answer's gradient as good there, on every branch?"""
        names = [c.name for c in self.system.coordinates]
        result = Regularity(self._others, self.wanted, self.submitted, self.setting, names).irregular()
        return Sameness.UNDECIDED if result is None else Sameness.IRREGULAR if result else Sameness.SAME

    # inequalities

    def _unilateral(self) -> Compared:
        """Inequalities are the same where they leave the same side of the same boundary."""
        if equations := [*self._answer, *self._all_wanted]:
            region = any(b and all(isinstance(p, DomainCondition) for p in b) for n in equations for b in n.branches)
            if region:  # abs(x) = x is x >= 0
                return Compared(Sameness.UNDECIDED)
            return Compared(Sameness.DIFFERENT, tuple(False for _ in self.wanted))
        submitted = [q for r in self.submitted for q in r.inequalities]
        asked = [q for r in self.wanted for q in r.inequalities]
        table = [[same_side(a, g, self._others, self.setting) for g in submitted] for a in asked]
        if any(True not in row and None in row for row in table):
            return Compared(Sameness.UNDECIDED)
        result = {q: True in row for q, row in zip(asked, table, strict=True)}
        met = tuple(all(result[q] for q in r.inequalities) for r in self.wanted)
        extra = [k for k in range(len(submitted)) if not any(row[k] for row in table)]
        if all(met):
            return Compared(Sameness.STRONGER if extra else Sameness.SAME, met)
        return Compared(Sameness.DIFFERENT if extra else Sameness.WEAKER, met)


def _moved(normal: Normal) -> set[str]:
    """The coordinates whose differentials occur in the forms of a normal."""
    return {q for p in normal.pieces if isinstance(p, Pfaffian) for q in p.coefficients}


def _branches_of(normals: Sequence[Normal]) -> list[list[Normal]]:
    """Choices of one branch of each; none where there is one choice only."""
    choices = islice(cartesian(*(n.branches for n in normals if n.branches)), MAX_BRANCHES)
    chosen = [[Normal((branch,)) for branch in choice] for choice in choices]
    return chosen if len(chosen) > 1 else []


def _normals(constraints: Sequence[Reduced]) -> list[Normal]:
    return [n for r in constraints for n in r.normals]


def _finite(normals: Sequence[Normal]) -> list[Expr]:
    """The geometric equations of normals with one branch; none where something else occurs."""
    pieces = [p for n in normals for p in n.pieces]
    if any(len(n.branches) != 1 for n in normals) or not all(isinstance(p, Finite) for p in pieces):
        return []
    return [p.expr for p in pieces if isinstance(p, Finite)]


def _differential(g: Expr) -> Normal:
    """dg as a Pfaffian form."""
    moving = sorted((s for s in g.symbols if s.args[0] == "coordinate"), key=repr)
    slopes = {str(s.args[1]): diff(g, s) for s in moving}
    return Normal(((Pfaffian({n: e for n, e in slopes.items() if not e.is_zero}, diff(g, ex.TIME)),),))


def _turned(submitted: Sequence[Reduced], answer: Sequence[Normal]) -> bool:
    """Return whether an angle of velocities was undone: theta = atan(dy/dx) may be meant for every theta."""
    written = (relation.expr for r in submitted for relation in r.constraint.relations)
    undone = any(UNDONE_NOTE in note for n in answer for note in n.notes)
    return undone and any(not e.functions.isdisjoint(ANGLES) for e in written)
