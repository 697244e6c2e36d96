"""What follows from what: does a relation hold at every state of motion that other constraints leave?

Asked on every choice of the others' branches, at generic states over GF(p); where one of those does not satisfy the
relation and complex solutions may be meant, at real states with balls. What is finite follows from finite relations
only, the hidden ones included: a rate does not fix the constant.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product as cartesian
from typing import NamedTuple

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.classification.freedom.branches import in_time
from dofkit.classification.freedom.preparation import all_of, branches_at_reference, conditional
from dofkit.configuration.states import States, value_at, vanishes
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Row, coordinates_of, split
from dofkit.relations.normal.domain import DomainCondition, conditions_of
from dofkit.relations.normal.no_solution import hold_nowhere, no_solution
from dofkit.relations.normal.pieces import Finite, Nonlinear, Normal, Pfaffian, Piece
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import MAX_WAYS, Way, form_rate, ways_of

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
    here = replace(setting, reference=None, pose={}, grows=False, flag=False)
    relation = branches_at_reference(normal, setting)
    if conditional(relation):
        return None
    choices = list(cartesian(*(branches_at_reference(o, setting).branches for o in others)))
    if len(choices) > MAX_CHOICES:
        return None
    answer: list[bool | None] = []
    for choice in choices:
        rows = [Row(k, p) for k, b in enumerate(choice) for p in b]
        ways = ways_of(rows, setting.positive)
        if len(ways) >= MAX_WAYS:
            return None
        for way in ways:
            check()
            answer.append(_on(way, relation, here))
            if answer[-1] is False:
                return False
    return all_of(answer)


def _on(way: Way, relation: Normal, setting: Setting) -> bool | None:
    """Return whether one of the relation's branches is satisfied wherever the rows are."""
    names = sorted({n for r in way.rows for n in coordinates_of(r.piece)})
    blocks, _ = split(names, way.rows)
    answers = [in_time(b, setting) for b in blocks]
    if any(a.consistent is False for a in answers):
        return True
    hidden = [g for a in answers for g in a.hidden]
    if _undefined(relation, names, way.rows, setting):
        return False
    all_consistent = all(a.consistent for a in answers)
    domain = [r.piece for r in way.rows if isinstance(r.piece, DomainCondition)]
    branches = [
        AskedBranch(
            tuple(at_state(p) for p in b if isinstance(p, RELATIONS)),
            tuple(p for p in b if isinstance(p, DomainCondition) and p not in domain),
        )
        for b in relation.branches
        if not _beyond(b, way.rows, hidden, setting)
    ]
    still = all(isinstance(p, Finite) for p in relation.pieces)
    written = [s.written.piece.expr for s in way.slots if isinstance(s.written.piece, Nonlinear) and not still]
    more = [*(e for b in branches for e in b.relations), *(c.expr for b in branches for c in b.conditions)]
    more += [c.expr for c in domain]
    moving = {str(s.args[1]) for e in more for s in e.symbols if s.args[0] in ("coordinate", "velocity")}
    try:
        states = States(sorted({*names, *moving}), way.rows, hidden, setting, [*more, *written], still)
        smaller = any(a.degenerate or a.dof is None for a in answers)
        held = _vanishes_on_states(states, branches, written, domain, smaller)
    except (OutOfTimeError, ArithmeticError):
        return None
    return held if held or all_consistent else None


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
        states = States([*sorted(moved), SLACK], [*standing, Row(0, Finite(beyond))], (), setting, (), True)
        if next(states.certain(2), None) is not None:
            return True
    return False


def at_state(piece: Finite | Pfaffian | Nonlinear) -> Expr:
    """What is 0 at a state that satisfies a piece."""
    return form_rate(piece) if isinstance(piece, Pfaffian) else piece.expr


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
            seen.append(_some_vanish(states, p, branches))
            if seen[-1] is False:
                break
    plain = not written and not domain and states.independent and not smaller
    if plain and False in seen and states.rational:
        return False
    if seen and all(seen) and not asked and not states.chosen:
        return True
    answer = [
        _some_hold(states, p, branches)
        for p in states.certain(MANY_STATES if asked or False in seen else STATES)
        if _all_vanish(states, p, written) and all(_satisfied(states, p, c) is not False for c in domain)
    ]
    if False in answer:
        return False
    sure = bool(seen) and all(seen) and not states.chosen
    return True if answer and all(answer) and (sure or len(answer) > 1 or not seen) else None


def _some_vanish(states: States, point: FieldPoint, branches: Sequence[AskedBranch]) -> bool | None:
    """Return whether one of the branches vanishes; None where some expression has no value."""
    return _any([_all_vanish(states, point, b.relations) for b in branches])


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
