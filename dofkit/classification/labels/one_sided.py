"""Constraints that also keep velocities to one side: what is left of them integrates, and yet no finite relation says
all of it.

sqrt(xdot^2 + ydot^2) = xdot says y = C, which takes freedom away as a holonomic constraint does, and xdot >= 0, which
follows from no finite relation, as no inequality does. Where the others see to that side, x = t, it is holonomic.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import NamedTuple

from dofkit.base.deadline import OutOfTimeError
from dofkit.base.verdicts import OPEN, VERDICTS, Claim, Verdict, weakest
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.freedom.velocity_domain import DRAWN, none_holds
from dofkit.configuration.states import States, state_relations, value_at
from dofkit.exact.points.frames import certified_rank
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import BITS
from dofkit.relations.blocks import Block, Row, split
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.normal_form import relation_of, velocities_of
from dofkit.relations.normal.pieces import Finite, Pfaffian, Piece
from dofkit.relations.reduced import Reduced
from dofkit.relations.setting import Setting
from dofkit.report import ConstraintEntry, FieldVerdict

#: Real states at which it is looked whether a side is kept to by itself.
STATES = 8
ASIDE = "It also restricts the velocities to one side, {sides}, which does not reduce the number of degrees of freedom"
NOT_WHOLE = f"{ASIDE} and is not implied by geometric equations: the constraint as a whole is not holonomic."
OPEN_SIDE = f"{ASIDE}; whether geometric equations imply this was not decided."


def with_a_side(outcome: Outcome) -> frozenset[int]:
    """The constraints that ask for a sign of an expression in the velocities, on the branch in use."""
    own = {r.constraint for r in outcome.rows if _is_side(r)}
    return frozenset(own | {copy for copy, i in outcome.copies.items() if i in own})


def sides_of(i: int, outcome: Outcome) -> list[DomainCondition]:
    """What a constraint asks of the sign of expressions in the velocities, on the branch in use."""
    own = outcome.copies.get(i, i)
    return [
        r.piece for r in outcome.rows if r.constraint == own and _is_side(r) and isinstance(r.piece, DomainCondition)
    ]


def _is_side(row: Row) -> bool:
    p = row.piece
    return isinstance(p, DomainCondition) and p.sense != "!=" and bool(velocities_of(p.expr))


class SideKept(NamedTuple):
    """Is a side kept to by what finite relations say (None: not known), and how sure is that?"""

    holds: bool | None
    verdict: Verdict = "proved"


ALWAYS = SideKept(True)


def kept_in_system(i: int, r: Reduced, outcome: Outcome, setting: Setting) -> SideKept:
    """Do the sides that a constraint keeps to hold in every motion that all rows leave? Yes where it has none.

    Not known where another of its branches, with lines that hold too, lies beyond: z abs(xdot) = ydot at z = 0.
    """
    sides = sides_of(i, outcome)
    if not sides:
        return ALWAYS
    blocks = list(zip(outcome.blocks, (a.hidden for a in outcome.answers), strict=True))
    found = _together(_kept(b, hidden, c, setting) for c in sides for b, hidden in blocks if c in b.conditions)
    beyond = found.holds is False and any(_is_beyond(b, sides, outcome, setting) for n in r.normals for b in n.branches)
    return SideKept(None) if beyond else found


def _is_beyond(branch: Sequence[Piece], sides: Sequence[DomainCondition], outcome: Outcome, setting: Setting) -> bool:
    """Is a branch on the other side of one of some sides, and do its lines hold in the motions that all rows leave?"""
    own = [p for p in branch if isinstance(p, DomainCondition)]
    if not any(not linear_terms(c.expr + d.expr) for c in sides for d in own):
        return False
    lines = [relation_of(p) for p in branch if isinstance(p, (Finite, Pfaffian))]
    rows = [row for row in outcome.rows if not isinstance(row.piece, DomainCondition)]
    names = [*outcome.untouched, *(n for b in outcome.blocks for n in b.coordinates)]
    states = States(names, rows, [g for a in outcome.answers for g in a.hidden], setting, lines)
    drawn = [p for p in (states.draw(k) for k in range(DRAWN)) if p is not None]
    return all(value_at(states.ring, p, states.extra[e]) == 0 for p in drawn for e in lines)


def kept_alone(i: int, outcome: Outcome, setting: Setting) -> SideKept:
    """The same with the other constraints forgotten."""
    own, sides = outcome.copies.get(i, i), sides_of(i, outcome)
    if not sides:
        return ALWAYS
    blocks, _ = split(
        [*outcome.untouched, *(n for b in outcome.blocks for n in b.coordinates)],
        [r for r in outcome.rows if r.constraint == own],
    )
    return _together(_kept(b, (), c, setting) for c in sides for b in blocks if c in b.conditions)


def _together(found: Iterable[SideKept]) -> SideKept:
    told = list(found)
    unkept = [k for k in told if k.holds is False]
    if unkept:
        return min(unkept, key=lambda k: VERDICTS.index(k.verdict))
    return SideKept(None) if any(k.holds is None for k in told) else ALWAYS


def _kept(block: Block, hidden: Sequence[Expr], side: DomainCondition, setting: Setting) -> SideKept:
    """Does a side hold wherever the rows of a block do?

    Not where at a regular state the rows leave it free: there the same configuration has velocities beyond it.
    """
    states = States(block.coordinates, block.rows, hidden, setting, [side.expr])
    node = states.extra[side.expr]
    try:
        drawn = [p for p in (states.draw(k) for k in range(DRAWN)) if p is not None]
        if drawn and all(value_at(states.ring, p, node) == 0 for p in drawn):
            return ALWAYS
        rank = max((states.ranks(p)[1] for p in drawn), default=len(states.moving))
        for point in states.certain(STATES):
            if certified_rank(states.by_velocity(point, [*states.moving, node])) > rank:
                return SideKept(False, "proved" if rank == len(states.moving) else "probable")
    except (OutOfTimeError, ArithmeticError):
        return SideKept(None)
    beyond = DomainCondition(-side.expr, ">" if side.sense == ">=" else ">=")
    return ALWAYS if none_holds(state_relations(block.rows, hidden), [beyond], setting.positive) else SideKept(None)


def with_sides(made: ConstraintEntry, i: int, r: Reduced, outcome: Outcome, setting: Setting) -> ConstraintEntry:
    """An entry that says so where a constraint keeps to a side, and is not called holonomic for its lines."""
    sides = sides_of(i, outcome)
    if not sides:
        return made
    asked = {"holonomic": partial(kept_in_system, i, r), "holonomic_alone": partial(kept_alone, i)}
    if outcome.consistent is False:
        del asked["holonomic"]
    told = {name: look(outcome, setting) for name, look in asked.items() if getattr(made, name)}
    changed = {name: kept for name, kept in told.items() if kept.holds is not True}
    claims = {name: OPEN if k.holds is None else Claim(k.verdict, "one side", BITS) for name, k in changed.items()}
    reason = made.reason
    if "holonomic" in changed:
        shown = " and ".join(f"{to_text(c.expr)} {c.sense} 0" for c in sides)
        text = OPEN_SIDE if changed["holonomic"].holds is None else NOT_WHOLE
        plain = reason.replace(": in this system it is holonomic, and the", "; the").replace(
            ": holonomic; the", "; the"
        )
        reason = f"{plain} {text.format(sides=shown)}"
    return made.model_copy(
        update={
            **{name: k.holds for name, k in changed.items()},
            "verdicts": {**made.verdicts, **{name: FieldVerdict.of(claim) for name, claim in claims.items()}},
            "verdict": weakest(made.verdict, *(claim.verdict for claim in claims.values())),
            "reason": reason,
        }
    )
