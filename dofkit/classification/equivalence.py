"""Are submitted constraints equivalent to the wanted ones, in the presence of the scene's others?

With O the other constraints, F the wanted and G the submitted ones: they are equivalent if O and F imply G, and O and G
imply F. Otherwise `Sameness` distinguishes: the same set, but irregular (the gradient vanishes on it), one branch,
weaker, stronger, different, empty, differentiated, integrated with or without its constant, different on the boundary
of a region only.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from itertools import islice
from itertools import product as cartesian

from dofkit.base.deadline import part, unless_late
from dofkit.classification.dependence.comparison import (
    MAX_BRANCHES,
    Regularity,
    by_root,
    same_up_to_numbers,
    unsound,
)
from dofkit.classification.dependence.implication import follows
from dofkit.classification.feasibility.regions import Regions
from dofkit.classification.freedom.branches import Outcome, solve
from dofkit.classification.freedom.preparation import all_of, prepared
from dofkit.exact.points.balls import precise_for
from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.pieces import Finite, Normal, Pfaffian, Reduced
from dofkit.relations.setting import Setting
from dofkit.system import Relation, System

#: Share of the remaining time for the test whether the submitted constraints are consistent.
POSSIBLE = 0.3


class Sameness(Enum):
    """How submitted constraints compare with the wanted ones; the values are stable codes."""

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
    BOUNDARY = "BOUNDARY"
    UNDECIDED = "UNDECIDED"


class Leaves(Enum):
    """Whether geometric equations describe all leaves of forms (a leaf through every point), one leaf, or neither."""

    ALL = "ALL"
    ONE = "ONE"
    NONE = "NONE"
    OPEN = "OPEN"


@dataclass(frozen=True)
class Compared:
    """The result of `compare`; ``met``: for each wanted constraint, whether the right submitted equations imply it.

    ``system``: if only one of two sides with inequalities allows some point, inequalities that such points satisfy.
    """

    sameness: Sameness
    met: tuple[bool, ...] = ()
    system: tuple[Relation, ...] = ()


def compare(
    system: System,
    asked: Sequence[int],
    answer: Sequence[int],
    constants: frozenset[str] = frozenset(),
    engines: Engines = BOTH,
) -> Compared:
    """Compare the constraints of ``system`` numbered ``answer`` (submitted) with those numbered ``asked`` (wanted).

    ``constants``: parameters introduced by the answer as constants of integration; ``engines``: those to use.
    """
    with precise_for(system.longest):
        return _comparison(system, asked, answer, constants, engines).result()


def leaves(system: System, asked: Sequence[int], answer: Sequence[int], constants: frozenset[str]) -> Leaves:
    """Return whether the equations ``answer`` describe leaves of the forms ``asked``: integral manifolds of full size.

    ``constants``: coordinates of ``system`` that other constraints fix; their values label the leaves.
    """
    with precise_for(system.longest):
        return _comparison(system, asked, answer, frozenset()).leaves(constants)


def _comparison(
    system: System, asked: Sequence[int], answer: Sequence[int], constants: frozenset[str], engines: Engines = BOTH
) -> Equivalence:
    reduced, setting = prepared(system)
    wanted, submitted = ({i: reduced[i] for i in some} for some in (asked, answer))
    context = [Reduced(r.constraint, (), ()) if i in wanted or i in submitted else r for i, r in enumerate(reduced)]
    return Equivalence(system, replace(setting, engines=engines), wanted, submitted, context, constants)


@dataclass(frozen=True)
class Equivalence:
    """The ``submitted`` constraints and the ``wanted`` ones, by number, in the ``context`` of all others.

    The context has a constraint without relations in the place of each of these, so that it keeps the numbers.
    """

    system: System
    setting: Setting
    wanted: Mapping[int, Reduced]
    submitted: Mapping[int, Reduced]
    context: Sequence[Reduced]
    constants: frozenset[str]

    def result(self) -> Compared:
        """Return how the submitted constraints compare with the wanted ones, and which of these they imply.

        Submitted ones are sound if the wanted ones imply them, wanted ones are met if the sound ones do.
        """
        submitted, wanted = self.submitted.values(), self.wanted.values()
        if any(r.inequalities for r in (*wanted, *submitted)):
            relations = ([q for r in some for q in r.constraint.relations] for some in (wanted, submitted))
            result = _compared(self._regions({}), *relations)
            same_set = result.sameness is Sameness.SAME and bool(self._all_wanted)
            return Compared(self._regularity()) if same_set else result
        if same_up_to_numbers(submitted, wanted):
            return Compared(Sameness.SAME, tuple(True for _ in wanted))
        sound = self._sound
        kept = [g for g, s in zip(self._answer, sound, strict=True) if s is True]
        met = [self._follow(r.normals, kept) for r in wanted]
        if None in sound or None in met:
            # The submitted constraints may be inconsistent even if the implications are undecided.
            return Compared(Sameness.UNDECIDED) if self._possible else self._empty
        are_met = tuple(bool(m) for m in met)
        if all(are_met) and all(sound):
            return Compared(self._regularity(), are_met)
        if all(are_met):
            return Compared(self._too_strong(), are_met)
        differentiated = all(sound) and not any(are_met) and self._differentiated()
        if differentiated is not False:
            return Compared(Sameness.DIFFERENTIATED if differentiated else Sameness.UNDECIDED, are_met)
        if not self._possible:
            return self._empty
        integrated = self._integrated()
        if integrated is not None:
            return Compared(integrated, are_met)
        if all(sound):
            return Compared(Sameness.WEAKER, are_met)
        implied = self._follow(self._all_wanted, self._answer)
        if implied is None:
            return Compared(Sameness.UNDECIDED, are_met)
        return Compared(self._too_strong() if implied else Sameness.DIFFERENT, are_met)

    @cached_property
    def _answer(self) -> list[Normal]:
        return _normals(self.submitted.values())

    @cached_property
    def _all_wanted(self) -> list[Normal]:
        return _normals(self.wanted.values())

    @cached_property
    def _others(self) -> list[Normal]:
        return _normals(self.context)

    @cached_property
    def _sound(self) -> list[bool | None]:
        """For each submitted relation, whether the wanted constraints imply it."""
        return [follows(g, [*self._others, *self._all_wanted], self.setting) for g in self._answer]

    def _follow(self, relations: Sequence[Normal], premises: Sequence[Normal]) -> bool | None:
        """Return whether the context and the premises imply all relations; None if undecided."""
        return all_of(follows(n, [*self._others, *premises], self.setting) for n in relations)

    @property
    def _empty(self) -> Compared:
        return Compared(Sameness.EMPTY, (False,) * len(self.wanted))

    @cached_property
    def _possible(self) -> bool:
        """Whether the context and the submitted constraints are not known to be inconsistent."""
        with part(POSSIBLE):
            return unless_late(lambda: self._with(self.submitted).consistent is not False, True)

    def _with(self, constraints: Mapping[int, Reduced]) -> Outcome:
        """Return the outcome of the context with some constraints."""
        return solve(self._context_with(constraints), self.setting)

    def _context_with(self, constraints: Mapping[int, Reduced]) -> list[Reduced]:
        return [constraints.get(i, r) for i, r in enumerate(self.context)]

    def _too_strong(self) -> Sameness:
        """Return how the submitted constraints compare with the wanted ones, given that they imply these and more."""
        if not self._possible:
            return Sameness.EMPTY
        integrated = self._integrated()
        if integrated is not None:
            return integrated
        submitted, wanted = self._with(self.submitted), self._with(self.wanted)
        if None in (submitted.dof, wanted.dof, submitted.velocity_dof, wanted.velocity_dof):
            return Sameness.UNDECIDED
        if (submitted.dof, submitted.velocity_dof) != (wanted.dof, wanted.velocity_dof):
            return Sameness.STRONGER
        if all(r.constraint.facts.half_turns for r in self.wanted.values()):
            return Sameness.SAME
        if not _is_bounded(self._all_wanted, self.context):
            return Sameness.BRANCH
        unimplied = unsound(self.submitted.values(), self._sound)
        return Sameness.SAME if unimplied and all(map(self._loses_nothing, unimplied)) else Sameness.UNDECIDED

    def _loses_nothing(self, e: Expr) -> bool:
        """Return whether e = a sqrt(P) + b = 0 is implied, because the inequalities of the context exclude a b > 0.

        False: not proved.
        """
        squared, allowed = by_root(e)
        implied = self._follow(squared, self._all_wanted) if squared else False
        return implied is True and self._regions(self.wanted).difference([], allowed).exists is False

    # differentials

    def _differentiated(self) -> bool | None:
        """Return whether the submitted relations are the wanted geometric equations, differentiated; or None.

        With as many independent velocities they may be so where the equations are satisfied: d(u g) is u dg there only.
        """
        finite = _finite(self._all_wanted)
        if not finite or any(isinstance(p, Finite) for n in self._answer for p in n.pieces):
            return False
        implied = self._follow([_differential(g) for g in finite], self._answer)
        if implied is not False:
            return implied
        as_many = self._with(self.submitted).velocity_dof == self._with(self.wanted).velocity_dof
        return None if as_many else False

    def _integrated(self) -> Sameness | None:
        """Return with or without a constant the wanted forms are integrated, or undecided; None if they are not."""
        integrates = self._integrates()
        if not integrates:
            return None if integrates is False else Sameness.UNDECIDED
        new = [g for g, sound in zip(_finite(self._answer), self._sound, strict=True) if not sound]
        constants_in = [{s for s in g.symbols if s.args[1] in self.constants} for g in new]
        return Sameness.INTEGRATED if all(constants_in) else Sameness.WITHOUT_CONSTANT

    def _integrates(self) -> bool | None:
        """Return whether the submitted relations are geometric and their differentials equivalent to the wanted forms.

        Wanted geometric equations have to be implied by the submitted ones. None if undecided.
        """
        finite = _finite(self._answer)
        geometric = [n for n in self._all_wanted if all(isinstance(p, Finite) for p in n.pieces)]
        forms = [n for n in self._all_wanted if n not in geometric]
        if not forms or not finite or len(finite) != len(self._answer):
            return False
        rates = [_differential(g) for g in finite]
        implied = self._follow(rates, self._all_wanted)
        implied = self._follow(geometric, self._answer) if implied else implied
        return self._follow(forms, [*geometric, *rates]) if implied else implied

    def leaves(self, constants: frozenset[str]) -> Leaves:
        """Return whether the submitted equations describe leaves: the forms vanish there, with equal velocity freedom.

        Undecided if one of several constants may be that of an integral of other forms, or if the forms vanish on one
        branch of the others only.
        """
        finite = _finite(self._answer)
        if not finite or len(finite) != len(self._answer):
            geometric = all(isinstance(p, Finite) for n in self._answer for p in n.pieces)
            return Leaves.OPEN if geometric and self._answer else Leaves.NONE
        if not self._possible:
            return Leaves.NONE
        named = {str(s.args[1]) for g in finite for s in g.symbols if s.args[0] == "coordinate"}
        moving = {q for n in self._all_wanted for q in _moved(n)}
        vanish = self._follow(self._all_wanted, self._answer)
        if not vanish:
            borrowed = len(named & constants) > 1 and any(_moved(n) - constants for n in self._others)
            on_branches = (self._follow(self._all_wanted, [*self._answer, *b]) for b in _branches_of(self._others))
            nowhere = vanish is False and not borrowed and all(a is False for a in on_branches)
            return Leaves.NONE if nowhere else Leaves.OPEN
        submitted, wanted = self._with(self.submitted), self._with(self.wanted)
        if submitted.velocity_dof is None or wanted.velocity_dof is None:
            return Leaves.OPEN
        if submitted.velocity_dof != wanted.velocity_dof:
            return Leaves.NONE
        if len(moving) > 1 and len(named - constants) < 2:
            return Leaves.OPEN
        return Leaves.ALL if named & constants else Leaves.ONE

    def _regularity(self) -> Sameness:
        """Return SAME, IRREGULAR or UNDECIDED for the same set, by the ranks of the gradients on every branch."""
        names = [c.name for c in self.system.coordinates]
        wanted, submitted = self.wanted.values(), self.submitted.values()
        result = Regularity(self._others, wanted, submitted, self.setting, names).irregular()
        return Sameness.UNDECIDED if result is None else Sameness.IRREGULAR if result else Sameness.SAME

    def _regions(self, more: Mapping[int, Reduced]) -> Regions:
        """Return the regions of relations in the context with more constraints."""
        return Regions(self.system, self._context_with(more), replace(self.setting, engines=BOTH))


def _compared(regions: Regions, asked: Sequence[Relation], answer: Sequence[Relation]) -> Compared:
    """Return the comparison of the regions that relations, with inequalities among them, describe."""
    beyond, lacking = regions.difference(answer, asked), regions.difference(asked, answer)
    if not beyond.exists and not lacking.exists:
        return Compared(Sameness.UNDECIDED if None in (beyond.exists, lacking.exists) else Sameness.SAME)
    if any(q.sense == "=" for q in (*asked, *answer)):
        return Compared(Sameness.DIFFERENT)
    if {q.sense for q in asked} != {q.sense for q in answer}:
        closed = ([q._replace(sense=">=") for q in some] for some in (asked, answer))
        if _compared(regions, *closed).sameness is Sameness.SAME:
            return Compared(Sameness.BOUNDARY)
    if beyond.exists:
        return Compared(Sameness.WEAKER if lacking.exists is False else Sameness.DIFFERENT, system=beyond.system)
    return Compared(Sameness.STRONGER if beyond.exists is False else Sameness.DIFFERENT, system=lacking.system)


def _is_bounded(wanted: Sequence[Normal], context: Sequence[Reduced]) -> bool:
    """Return whether inequalities of the context mention a coordinate of the wanted geometric equations."""
    symbols = {s for n in wanted for p in n.pieces if isinstance(p, Finite) for s in p.expr.symbols}
    moving = {s for s in symbols if s.args[0] == "coordinate"}
    return any(moving & q.expr.symbols for r in context for q in r.inequalities)


def _moved(normal: Normal) -> set[str]:
    """Return the coordinates whose differentials occur in the forms of a normal form."""
    return {q for p in normal.pieces if isinstance(p, Pfaffian) for q in p.coefficients}


def _branches_of(normals: Sequence[Normal]) -> list[list[Normal]]:
    """Return the choices of one branch of each, at most `MAX_BRANCHES`; an empty list if there is only one."""
    choices = islice(cartesian(*(n.branches for n in normals if n.branches)), MAX_BRANCHES)
    chosen = [[Normal((branch,)) for branch in choice] for choice in choices]
    return chosen if len(chosen) > 1 else []


def _normals(constraints: Iterable[Reduced]) -> list[Normal]:
    return [n for r in constraints for n in r.normals]


def _finite(normals: Sequence[Normal]) -> list[Expr]:
    """Return the expressions of geometric equations with one branch; an empty list if anything else occurs."""
    pieces = [p for n in normals for p in n.pieces]
    if any(len(n.branches) != 1 for n in normals) or not all(isinstance(p, Finite) for p in pieces):
        return []
    return [p.expr for p in pieces if isinstance(p, Finite)]


def _differential(g: Expr) -> Normal:
    """Return the relation dg = 0."""
    moving = sorted((s for s in g.symbols if s.args[0] == "coordinate"), key=repr)
    slopes = {str(s.args[1]): diff(g, s) for s in moving}
    return Normal(((Pfaffian({n: e for n, e in slopes.items() if not e.is_zero}, diff(g, ex.TIME)),),))
