"""Conditions that velocities satisfy: do the rows of a block leave a motion on which they hold?

At a certified state of motion, regular as those drawn are, where all conditions hold strictly they hold nearby, for a
while and in a whole region of velocities: the freedom there is what the rows alone leave [Krener1974].
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from dofkit.configuration.states import States, rows_at, state_relations, value_at, vanishes
from dofkit.exact.errors import NoValueError
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.half_lines import freed
from dofkit.relations.normal.no_solution import no_solution
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.setting import Setting

#: Points over GF(p) at which conditions are evaluated, and real states that are looked at: more of them where it is not
#: proved that there are none.
DRAWN, REAL, MORE = 3, 24, 72


def on_velocities(conditions: Sequence[DomainCondition]) -> bool:
    """Does one of the conditions hold velocities?"""
    return any(velocities_of(c.expr) for c in conditions)


def in_motion(block: Block, hidden: Sequence[Expr], setting: Setting) -> bool | None:
    """Do the conditions of a block hold in some motion that its rows allow? None where that is not known.

    Where the rows have another rank than elsewhere the conditions may hold though they do so nowhere else: xdot = 0
    beside th = atan2(ydot, xdot) holds where cos(th) = 0. So that they hold nowhere asks for a proof.
    """
    relations = state_relations(block.rows, hidden)
    states = States(block.coordinates, block.rows, hidden, setting, [c.expr for c in block.conditions])
    drawn = [p for p in (states.draw(k) for k in range(DRAWN)) if p is not None]
    always = [c for c in block.conditions if drawn and all(_is_zero(states, p, c) for p in drawn)]
    left = [c for c in block.conditions if c not in always or c.sense != ">="]
    looked = not set(left) & set(always)
    if looked and any(all(_strictly(states, p, c) for c in left) for p in _regular(states, drawn, REAL)):
        return True
    if none_holds(relations, block.conditions, setting.positive):
        return False
    more = _regular(states, drawn, MORE, REAL) if looked else ()
    return True if any(all(_strictly(states, p, c) for c in left) for p in more) else None


def none_holds(relations: Sequence[Expr], conditions: Sequence[DomainCondition], positive: frozenset[Expr]) -> bool:
    """Is it proved that some conditions hold nowhere together where the relations do?

    u > 0 is u s^2 = 1 for some s, and u != 0 is u s = 1.
    """
    plain = [(freed(c.expr, relations), c.sense == ">") for c in conditions if c.sense != "!="]
    if any(never_holds(e, strictly, positive) for e, strictly in plain):
        return True
    slacks = [ex.coordinate(f"_slack {k}") for k in range(len(conditions))]
    strict = [
        c.expr * s * (s if c.strict else ex.ONE) - ex.ONE
        for c, s in zip(conditions, slacks, strict=True)
        if c.sense != ">="
    ]
    return no_solution([*relations, *strict], positive, [c.expr for c in conditions if c.sense != "!="])


def in_motion_at(block: Block, hidden: Sequence[Expr], setting: Setting, known: Mapping[Expr, Expr]) -> bool | None:
    """The same at one configuration, where all rows are relations of velocities with constant coefficients."""
    try:
        rows = rows_at(state_relations(block.rows, hidden), known)
        conditions = tuple(DomainCondition(substitute(c.expr, known), c.sense) for c in block.conditions)
    except NoValueError:
        return None
    there = Block(block.coordinates, rows, tuple(c for c in conditions if velocities_of(c.expr)))
    return in_motion(there, (), setting)


def _regular(states: States, drawn: Sequence[FieldPoint], count: int, first: int = 0) -> Iterator[BallPoint]:
    """Certified real states at which the rows have the ranks that they have at those drawn, or all that were found."""
    wanted = {states.ranks(p) for p in drawn[:1]}
    for point in states.certain(count, first):
        wanted = wanted or {states.ranks(point)}
        if states.ranks(point) in wanted:
            yield point


def _is_zero(states: States, point: FieldPoint, c: DomainCondition) -> bool:
    value = value_at(states.ring, point, states.extra[c.expr])
    return value is not None and vanishes(value)


def _strictly(states: States, point: BallPoint, c: DomainCondition) -> bool:
    value = value_at(states.ring, point, states.extra[c.expr])
    if value is None or value.contains(0):
        return False
    return c.sense == "!=" or bool(value > 0)


def still_conditions(conditions: Sequence[DomainCondition]) -> list[DomainCondition]:
    """Those on positions alone."""
    return [c for c in conditions if not any(s.args[0] == "velocity" for s in c.expr.symbols)]
