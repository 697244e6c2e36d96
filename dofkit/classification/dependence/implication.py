"""Implication: is a relation satisfied at every state of motion that other constraints allow?

It is tested on every choice of the others' branches, at generic states over GF(p); if one of these does not satisfy the
relation but may be complex only, at real states with balls. A geometric equation can be implied only by geometric
equations, hidden ones included, because a differential does not fix the constant. With a
reference configuration implication is asked on the manifold through it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import product as cartesian
from typing import NamedTuple

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.base.verdicts import Claim
from dofkit.classification.dependence.near_reference import BlockImplication, implied_near
from dofkit.classification.freedom.branches import in_time
from dofkit.classification.freedom.preparation import (
    all_of,
    any_of,
    branches_at_reference,
    conditional,
    passes_reference,
)
from dofkit.configuration.states import States, value_at
from dofkit.exact.ideals import have_complex_points
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import vanishes
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import BITS, Answer
from dofkit.relations.blocks import NOBODY, Row, coordinates_of, split
from dofkit.relations.linear_relations import explicit_relations
from dofkit.relations.normal.domain import DomainCondition, conditions_of
from dofkit.relations.normal.no_solution import hold_nowhere, no_solution
from dofkit.relations.normal.pieces import Finite, Nonlinear, Normal, Pfaffian, Piece
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import MAX_ALTERNATIVES, Alternative, alternatives_of

#: The claim of an implication tested at random states.
IMPLIED = Claim("probable", "implication", bits=BITS)
#: The name of an auxiliary coordinate, which no scene has.
SLACK = "_s"
RELATIONS = (Finite, Pfaffian, Nonlinear)
#: Bound on the choices of branches, and number of random states on each.
MAX_CHOICES, STATES = 16, 4
#: Number of states if a root is chosen at random: all miss one half of a set that falls into two with chance 2^-40.
#: So many are drawn for every sign; states are not enough for more signs than `MOST_SIGNS`.
PARTED_STATES, MOST_SIGNS = 40, 2
#: Number of real states if a relation may be satisfied on one component of the set and not on another.
MANY_STATES = 16


class ImpliedBranch(NamedTuple):
    """One branch of the relation that is tested: expressions that are 0, and conditions."""

    relations: tuple[Expr, ...]
    conditions: tuple[DomainCondition, ...]


def follows(normal: Normal, others: Sequence[Normal], setting: Setting) -> bool | None:
    """Return whether a relation is satisfied wherever the others are, on all their branches; None if undecided."""
    relation = branches_at_reference(normal, setting)
    if conditional(relation):
        return None
    choices = list(cartesian(*(branches_at_reference(o, setting).branches for o in others)))
    if len(choices) > MAX_CHOICES:
        return None
    on_alternatives: list[bool | None] = []
    for choice in choices:
        rows = [Row(k, p) for k, b in enumerate(choice) for p in b]
        alternatives = alternatives_of(rows, setting.positive)
        if len(alternatives) >= MAX_ALTERNATIVES:
            return None
        for alternative in alternatives:
            check()
            on_alternatives.append(_on(alternative, relation, setting))
            if on_alternatives[-1] is False:
                return False
    return all_of(on_alternatives)


def _on(alternative: Alternative, relation: Normal, setting: Setting) -> bool | None:
    """Return whether the relation is satisfied wherever the rows of an alternative are; None if undecided.

    None also if it is satisfied on some branches of the hidden relations and not on others; only those through the
    reference configuration count, if there are any.
    """
    near = implied_near(alternative.rows, relation, setting)
    if near is not None:
        return near
    here = replace(setting, reference=None, pose={}, grows=False, flag=False)
    names = sorted({n for r in alternative.rows for n in coordinates_of(r.piece)})
    blocks, _ = split(names, alternative.rows)
    answers = [in_time(b, here) for b in blocks]
    if any(a.consistent is False for a in answers):
        return True
    if _undefined(relation, names, alternative.rows, here):
        return False
    choices = cartesian(*(a.hidden_branches or [a.hidden] for a in answers))
    hidden = [[g for branch in choice for g in branch] for choice in choices]
    if setting.reference is not None and len(hidden) > 1:
        hidden = [h for h in hidden if passes_reference([*map(Finite, h)], setting)] or hidden
    satisfied = {_on_hidden(alternative, relation, answers, h, here) for h in hidden}
    return satisfied.pop() if len(satisfied) == 1 else None


def _on_hidden(
    alternative: Alternative, relation: Normal, answers: Sequence[Answer], hidden: Sequence[Expr], setting: Setting
) -> bool | None:
    """Return whether the relation is satisfied wherever the rows and hidden relations are; None if undecided."""
    domain = [r.piece for r in alternative.rows if isinstance(r.piece, DomainCondition)]
    branches = [
        ImpliedBranch(
            tuple(p.rate if isinstance(p, Pfaffian) else p.expr for p in b if isinstance(p, RELATIONS)),
            tuple(p for p in b if isinstance(p, DomainCondition) and p not in domain),
        )
        for b in relation.branches
        if not _is_empty(b, alternative.rows, hidden, setting)
    ]
    still = all(isinstance(p, Finite) for p in relation.pieces)
    written = [s.written.piece.expr for s in alternative.slots if isinstance(s.written.piece, Nonlinear) and not still]
    more = [*(e for b in branches for e in b.relations), *(c.expr for b in branches for c in b.conditions)]
    more += [c.expr for c in domain]
    moving = {str(s.args[1]) for e in more for s in e.symbols if s.args[0] in ("coordinate", "velocity")}
    moving |= {n for r in alternative.rows for n in coordinates_of(r.piece)}
    try:
        states = States(sorted(moving), alternative.rows, hidden, setting, [*more, *written], still)
        smaller = any(a.degenerate or a.dof is None for a in answers)
        satisfied = _vanishes_on_states(states, branches, written, domain, smaller)
        if satisfied and still and all(isinstance(r.piece, Finite) for r in alternative.rows):
            return _on_all_components(alternative.rows, branches, setting)
    except (OutOfTimeError, ArithmeticError):
        return None
    return satisfied if satisfied or all(a.consistent for a in answers) else None


def _on_all_components(rows: Sequence[Row], branches: Sequence[ImpliedBranch], setting: Setting) -> bool | None:
    """Return whether the relation is satisfied on components that random states may have missed; True if not tested.

    Example: two minors of a matrix imply the third, but not where the column that they share is 0. The relation fails
    at a complex point if s g = 1 has a solution [Rabinowitsch1929]; False if it fails at a certified real point, None
    if no real one is found. True also if the ideal is too large to decide and no real one is found.
    """
    relations = [r.piece.expr for r in rows if isinstance(r.piece, Finite)]
    if not explicit_relations(relations).implicit:
        return True
    on_choices: list[bool | None] = [True]
    for choice in cartesian(*(b.relations for b in branches)):
        beyond = ex.mul(ex.coordinate(SLACK), *choice) - ex.ONE
        complex_points = have_complex_points([*relations, beyond], setting.positive)
        if complex_points is False:
            continue
        names = {str(s.args[1]) for g in (*relations, beyond) for s in g.symbols if s.args[0] == "coordinate"}
        states = States(sorted(names), [*rows, Row(NOBODY, Finite(beyond))], (), setting, (), True)
        if complex_points is None:
            on_choices.append(not states.has_near_real_state())
        else:
            on_choices.append(None if next(states.certain(STATES), None) is None else False)
    return all_of(on_choices)


def _is_empty(branch: Sequence[Piece], rows: Sequence[Row], hidden: Sequence[Expr], setting: Setting) -> bool:
    """Return whether the conditions of a branch are proved to be false wherever the rows are satisfied."""
    conditions = [p for p in branch if isinstance(p, DomainCondition)]
    finite = [r.piece.expr for r in rows if isinstance(r.piece, Finite)]
    return bool(conditions) and hold_nowhere([*finite, *hidden], conditions, setting.positive)


def _undefined(relation: Normal, names: Sequence[str], rows: Sequence[Row], setting: Setting) -> bool:
    """Return whether the relation requires u > 0 (as a logarithm does) and u = -s^2 at a certified configuration."""
    finite = [r for r in rows if isinstance(r.piece, Finite)]
    required, required_by_rows = (
        {c.expr for p in pieces if isinstance(p, Finite) for c in conditions_of(p.expr, setting.positive) if c.strict}
        for pieces in (relation.pieces, [r.piece for r in finite])
    )
    coordinates = {*names, *(str(s.args[1]) for u in required for s in u.symbols if s.args[0] == "coordinate")}
    for u in sorted(required - required_by_rows, key=repr):
        beyond = ex.add(u, ex.power(ex.coordinate(SLACK), ex.num(2)))
        if no_solution([*(r.piece.expr for r in finite if isinstance(r.piece, Finite)), beyond], setting.positive):
            continue
        states = States([*sorted(coordinates), SLACK], [*finite, Row(NOBODY, Finite(beyond))], (), setting, (), True)
        if next(states.certain(2), None) is not None:
            return True
    return False


def _vanishes_on_states(
    states: States,
    branches: Sequence[ImpliedBranch],
    written: Sequence[Expr],
    domain: Sequence[DomainCondition],
    smaller: bool,
) -> bool | None:
    """Return whether some branch is satisfied at every random state, given the ``domain`` conditions.

    First at states over GF(p). One of them refutes only if the real set is certainly as large (not ``smaller``) and has
    no component without real points; otherwise real states decide. None if there are too few of these.
    """
    many = STATES if states.rational else PARTED_STATES
    conditional = any(b.conditions for b in branches)
    over_field = list[bool | None]()
    for k in range(many):
        p = states.draw(k)
        if p is not None and _all_vanish(states, p, written):
            over_field.append(any_of([_all_vanish(states, p, b.relations) for b in branches]))
            if over_field[-1] is False:
                break
    plain = not written and not domain and states.independent and not smaller
    if plain and False in over_field and states.rational:
        return False
    if over_field and all(over_field) and not conditional and not states.chosen:
        return True
    at_real = list[bool | None]()
    wanted = MANY_STATES if conditional or False in over_field else STATES
    for real in states.certain(max(wanted, PARTED_STATES * min(states.ring.signs, MOST_SIGNS))):
        if _all_vanish(states, real, written) and all(_satisfied(states, real, c) is not False for c in domain):
            at_real.append(_some_hold(states, real, branches))
        if False in at_real:
            return False
    enough = states.ring.signs <= MOST_SIGNS and (len(at_real) > 1 or not over_field)
    return True if enough and at_real and all(at_real) else None


def _some_hold(states: States, point: BallPoint, branches: Sequence[ImpliedBranch]) -> bool | None:
    """Return whether one of the branches, with its conditions, is satisfied at a real state; None if undecided."""
    return any_of(
        [
            all_of((_all_vanish(states, point, b.relations), *(_satisfied(states, point, c) for c in b.conditions)))
            for b in branches
        ]
    )


def _all_vanish(states: States, point: FieldPoint | BallPoint, expressions: Sequence[Expr]) -> bool | None:
    """Return whether the expressions are 0 at a state (or their balls contain 0); None if one has no value."""
    result = [value_at(states.ring, point, states.extra[e]) for e in expressions]
    return all_of(None if v is None else vanishes(v) for v in result)


def _satisfied(states: States, point: BallPoint, condition: DomainCondition) -> bool | None:
    """Return whether a condition is satisfied at a real state; None if its ball contains 0."""
    value = value_at(states.ring, point, states.extra[condition.expr])
    if value is None or value.contains(0):
        return None
    return condition.sense == "!=" or bool(value > 0)


class Everywhere(BlockImplication):
    """Implications between any rows, at all states of motion that the premises ``others`` allow."""

    @cached_property
    def _coordinates(self) -> list[frozenset[str]]:
        return [coordinates_of(r.piece) for r in self.block.rows]

    @cached_property
    def _users(self) -> dict[str, set[int]]:
        users: dict[str, set[int]] = {}
        for i, names in enumerate(self._coordinates):
            for name in names:
                users.setdefault(name, set()).add(i)
        return users

    def adjacent_rows(self, rows: Iterable[int]) -> set[int]:
        """Return the rows that share a coordinate with some of ``rows``, these included."""
        named = frozenset[str]().union(*(self._coordinates[i] for i in rows))
        return set[int]().union(*(self._users[name] for name in named))

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Return whether a dependent row is satisfied wherever the others are; None if undecided.

        If no other row shares a coordinate with these, the dependence at a generic point is sufficient.
        """
        answer = self.linearly(row, others)
        if answer is not None:
            return answer
        if self.adjacent_rows([row, *others]) == {row, *others}:
            return True
        alone = {i: Normal(((self.block.rows[i].piece,),)) for i in (row, *others)}
        return follows(alone[row], [alone[i] for i in others], self.setting)

    def seems(self, row: int, others: Sequence[int]) -> bool:
        """Return whether `follows` is true; there is no quicker test."""
        return self.follows(row, others) is True

    def needed(self, row: int, others: Sequence[int]) -> list[int]:
        """Return all others; there is no quick way to see which are needed."""
        del row
        return list(others)
