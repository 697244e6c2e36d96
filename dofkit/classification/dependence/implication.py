"""What is implied by what: is a relation satisfied at every state of motion that other constraints leave?

Asked on every choice of the others' branches, at generic states over GF(p); where one of those does not satisfy the
relation and complex solutions may be meant, at real states with balls. What is finite is implied by geometric equations
only, the hidden ones included: a rate does not fix the constant.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product as cartesian
from typing import NamedTuple

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.base.verdicts import Claim
from dofkit.classification.freedom.branches import in_time
from dofkit.classification.freedom.preparation import all_of, branches_at_reference, conditional, passes_reference
from dofkit.configuration.implied_relations import ImpliedRelations
from dofkit.configuration.states import States, value_at
from dofkit.exact.ideals import have_complex_points
from dofkit.exact.matrices.sparse import echelon
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import vanishes
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import BITS, Answer
from dofkit.relations.blocks import NOBODY, Block, Row, coordinates_of, make_chart, split
from dofkit.relations.linear_relations import explicit_relations, linear, solve_linear
from dofkit.relations.normal.domain import DomainCondition, conditions_of
from dofkit.relations.normal.no_solution import hold_nowhere, no_solution
from dofkit.relations.normal.pieces import Finite, Nonlinear, Normal, Pfaffian, Piece
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import MAX_ALTERNATIVES, Alternative, alternatives_of

#: What the others imply at drawn states.
IMPLIED = Claim("probable", "implication", bits=BITS)
#: No coordinate has this name.
SLACK = "_s"
RELATIONS = (Finite, Pfaffian, Nonlinear)
#: Choices of branches that are looked at, and states on each.
MAX_CHOICES, STATES = 16, 4
#: States where a root is drawn on the way: the set may fall into parts, and all of these miss half of it once in 2^40.
PARTED_STATES = 40
#: Real states that are looked at where a relation may hold on one part of the set and fail on another.
MANY_STATES = 16


class AskedBranch(NamedTuple):
    """What is 0 on one branch of a relation, and the conditions on which it holds."""

    relations: tuple[Expr, ...]
    conditions: tuple[DomainCondition, ...]


def follows(normal: Normal, others: Sequence[Normal], setting: Setting) -> bool | None:
    """Return whether a relation is satisfied on every branch of the others; None if undecided."""
    relation = branches_at_reference(normal, setting)
    if conditional(relation):
        return None
    choices = list(cartesian(*(branches_at_reference(o, setting).branches for o in others)))
    if len(choices) > MAX_CHOICES:
        return None
    answer: list[bool | None] = []
    for choice in choices:
        rows = [Row(k, p) for k, b in enumerate(choice) for p in b]
        alternatives = alternatives_of(rows, setting.positive)
        if len(alternatives) >= MAX_ALTERNATIVES:
            return None
        for alternative in alternatives:
            check()
            answer.append(_on(alternative, relation, setting))
            if answer[-1] is False:
                return False
    return all_of(answer)


def _on(alternative: Alternative, relation: Normal, setting: Setting) -> bool | None:
    """Return whether one of the relation's branches is satisfied wherever the rows are.

    None where it is on some branches of the relations hidden in the rows, and on others not: of those through the
    reference configuration, if there are any.
    """
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
    held = {_on_hidden(alternative, relation, answers, h, here) for h in hidden}
    return held.pop() if len(held) == 1 else None


def _on_hidden(
    alternative: Alternative, relation: Normal, answers: Sequence[Answer], hidden: Sequence[Expr], setting: Setting
) -> bool | None:
    """Return whether one of the relation's branches is satisfied wherever the rows and hidden relations are."""
    domain = [r.piece for r in alternative.rows if isinstance(r.piece, DomainCondition)]
    branches = [
        AskedBranch(
            tuple(p.rate if isinstance(p, Pfaffian) else p.expr for p in b if isinstance(p, RELATIONS)),
            tuple(p for p in b if isinstance(p, DomainCondition) and p not in domain),
        )
        for b in relation.branches
        if not _beyond(b, alternative.rows, hidden, setting)
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
        held = _vanishes_on_states(states, branches, written, domain, smaller)
    except (OutOfTimeError, ArithmeticError):
        return None
    if held and still and all(isinstance(r.piece, Finite) for r in alternative.rows):
        return _on_all_components(alternative.rows, branches, setting)
    return held if held or all(a.consistent for a in answers) else None


def _on_all_components(rows: Sequence[Row], branches: Sequence[AskedBranch], setting: Setting) -> bool | None:
    """Return whether no component of a set of geometric equations is known on which all branches fail.

    Drawn states may miss one: two minors of a matrix imply the third, but not where the column that they share is 0.
    The branches fail at a complex point where s g = 1 has a solution [Rabinowitsch1929]; that is certified at a real
    one, and undecided where none is found. True also where the ideal is too large to tell.
    """
    relations = [r.piece.expr for r in rows if isinstance(r.piece, Finite)]
    if not explicit_relations(relations).implicit:
        return True
    answer: list[bool | None] = [True]
    for choice in cartesian(*(b.relations for b in branches)):
        beyond = ex.mul(ex.coordinate(SLACK), *choice) - ex.ONE
        if not have_complex_points([*relations, beyond], setting.positive):
            continue
        names = {str(s.args[1]) for g in (*relations, beyond) for s in g.symbols if s.args[0] == "coordinate"}
        states = States(sorted(names), [*rows, Row(NOBODY, Finite(beyond))], (), setting, (), True)
        answer.append(None if next(states.certain(STATES), None) is None else False)
    return all_of(answer)


def _beyond(branch: Sequence[Piece], rows: Sequence[Row], hidden: Sequence[Expr], setting: Setting) -> bool:
    """Return whether the conditions of a branch are satisfied nowhere where some rows are."""
    asked = [p for p in branch if isinstance(p, DomainCondition)]
    finite = [r.piece.expr for r in rows if isinstance(r.piece, Finite)]
    return bool(asked) and hold_nowhere([*finite, *hidden], asked, setting.positive)


def _undefined(relation: Normal, names: Sequence[str], rows: Sequence[Row], setting: Setting) -> bool:
    """Return whether a logarithm has no value at some configuration of the rows; True is certified.

    Where u > 0 does not hold, u = -s^2 for some s.
    """
    standing = [r for r in rows if isinstance(r.piece, Finite)]
    asked, theirs = (
        {c.expr for p in pieces if isinstance(p, Finite) for c in conditions_of(p.expr, setting.positive) if c.strict}
        for pieces in (relation.pieces, [r.piece for r in standing])
    )
    moved = {*names, *(str(s.args[1]) for u in asked for s in u.symbols if s.args[0] == "coordinate")}
    for u in sorted(asked - theirs, key=repr):
        beyond = ex.add(u, ex.power(ex.coordinate(SLACK), ex.num(2)))
        if no_solution([*(r.piece.expr for r in standing if isinstance(r.piece, Finite)), beyond], setting.positive):
            continue
        states = States([*sorted(moved), SLACK], [*standing, Row(NOBODY, Finite(beyond))], (), setting, (), True)
        if next(states.certain(2), None) is not None:
            return True
    return False


def _vanishes_on_states(
    states: States,
    branches: Sequence[AskedBranch],
    written: Sequence[Expr],
    domain: Sequence[DomainCondition],
    smaller: bool,
) -> bool | None:
    """Return whether a branch is satisfied at every state that is drawn, where the ``domain`` conditions are.

    ``smaller``: over the reals the set may be smaller than over GF(p), where nothing is refuted then. Nor is it where
    the set may have parts without real points.
    """
    many = STATES if states.rational else PARTED_STATES
    asked = any(b.conditions for b in branches)
    seen = list[bool | None]()
    for k in range(many):
        p = states.draw(k)
        if p is not None and _all_vanish(states, p, written):
            seen.append(_any([_all_vanish(states, p, b.relations) for b in branches]))
            if seen[-1] is False:
                break
    plain = not written and not domain and states.independent and not smaller
    if plain and False in seen and states.rational:
        return False
    if seen and all(seen) and not asked and not states.chosen:
        return True
    answer = list[bool | None]()
    for real in states.certain(MANY_STATES if asked or False in seen else STATES):
        if _all_vanish(states, real, written) and all(_satisfied(states, real, c) is not False for c in domain):
            answer.append(_some_hold(states, real, branches))
        if False in answer:
            return False
    return True if answer and all(answer) and (len(answer) > 1 or not seen) else None


def _some_hold(states: States, point: BallPoint, branches: Sequence[AskedBranch]) -> bool | None:
    """Return whether one of the branches vanishes where its conditions hold; None where a ball does not decide."""
    return _any(
        [
            all_of((_all_vanish(states, point, b.relations), *(_satisfied(states, point, c) for c in b.conditions)))
            for b in branches
        ]
    )


def _any(answers: Sequence[bool | None]) -> bool | None:
    return True if True in answers else None if None in answers else False


def _all_vanish(states: States, point: FieldPoint | BallPoint, expressions: Sequence[Expr]) -> bool | None:
    """Return whether the expressions are 0 at a state (or a ball holds 0); None where one has no value."""
    result = [value_at(states.ring, point, states.extra[e]) for e in expressions]
    return all_of(None if v is None else vanishes(v) for v in result)


def _satisfied(states: States, point: BallPoint, condition: DomainCondition) -> bool | None:
    """Return whether a condition is satisfied at a real state; None where a ball does not decide."""
    value = value_at(states.ring, point, states.extra[condition.expr])
    if value is None or value.contains(0):
        return None
    return condition.sense == "!=" or bool(value > 0)


@dataclass(frozen=True)
class BlockImplication:
    """The rows of a block, and which of them share coordinates."""

    block: Block
    setting: Setting

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
        """The rows that share a coordinate with some rows, those among them."""
        named = frozenset[str]().union(*(self._coordinates[i] for i in rows))
        return set[int]().union(*(self._users[name] for name in named))

    def linearly(self, row: int, others: Sequence[int]) -> bool | None:
        """Return whether a linear relation is a combination of others over Q; None if not all are linear."""
        pieces = [self.block.rows[i].piece for i in (*others, row)]
        relations = [p.expr for p in pieces if isinstance(p, Finite) and linear(p.expr) is not None]
        return solve_linear(relations[:-1]).implies(relations[-1]) if len(relations) == len(pieces) else None


class NearDrawing(BlockImplication):
    """Of geometric equations satisfied at the reference: what they imply near it. The others are independent there."""

    @cached_property
    def _relations(self) -> ImpliedRelations:
        return ImpliedRelations(make_chart(self.block, self.setting), self.setting.reference or {})

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Return whether a relation that is dependent at the reference vanishes near it where the others do."""
        answer = self.linearly(row, others)
        return self._relations.follows(row, others) if answer is None else answer

    def seems(self, row: int, others: Sequence[int]) -> bool:
        """Return whether it vanishes to some order near the reference."""
        answer = self.linearly(row, others)
        return bool(self._relations.follows(row, others, False) if answer is None else answer)

    def needed(self, row: int, others: Sequence[int]) -> list[int]:
        """Those with a multiplier that is not 0 all along a curve of the set."""
        return self._relations.needed(row, others)

    def imply(self, others: Sequence[int], rows: Sequence[int], a: Answer) -> bool:
        """Return whether some relations imply others near the reference, by those that are independent there."""
        result = echelon([a.matrix[i] for i in others], a.modulus).independent
        pivots = [others[k] for k in result]
        return all(self.follows(i, pivots) for i in rows)

    def seem_to_imply(self, others: Sequence[int], rows: Sequence[int]) -> bool:
        """Return whether others are satisfied at all sampled points near the reference at which some relations are."""
        return self._relations.seem_to_follow(rows, others)

    def is_orbit(self, rows: Sequence[int], dof: int | None) -> bool:
        """Return whether the set of ``dof`` dimensions that some relations leave is an orbit near the reference.

        It is a union of orbits of rigid motions, finitely many of that dimension, and all pass through the reference.
        """
        return dof is not None and self._relations.rigid(rows) == dof


class Everywhere(BlockImplication):
    """Of any rows: what is satisfied at every state of motion that the others leave, on all parts of their set."""

    def follows(self, row: int, others: Sequence[int]) -> bool | None:
        """Return whether what a row says is satisfied wherever the others are.

        A row that depends on others at a generic point follows there, where no other row shares a coordinate with them.
        """
        answer = self.linearly(row, others)
        if answer is not None:
            return answer
        if self.adjacent_rows([row, *others]) == {row, *others}:
            return True
        alone = {i: Normal(((self.block.rows[i].piece,),)) for i in (row, *others)}
        return follows(alone[row], [alone[i] for i in others], self.setting)

    def seems(self, row: int, others: Sequence[int]) -> bool:
        """The same: there is no shorter way."""
        return self.follows(row, others) is True

    def needed(self, row: int, others: Sequence[int]) -> list[int]:
        """All: which are needed is not seen at once."""
        del row
        return list(others)


def implication_of(block: Block, a: Answer, setting: Setting) -> NearDrawing | Everywhere:
    """By what the block was answered: its drawing, or generic points."""
    return NearDrawing(block, setting) if is_drawn(block, a, setting) else Everywhere(block, setting)


def is_drawn(block: Block, a: Answer, setting: Setting) -> bool:
    """Return whether all rows are finite, and were answered at the reference."""
    return setting.reference is not None and a.instantaneous is not None and len(block.finite) == len(block.rows)
