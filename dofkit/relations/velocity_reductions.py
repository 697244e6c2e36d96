"""Relations nonlinear in the velocities reduced by linear ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from itertools import product as cartesian
from typing import NamedTuple

from dofkit.base.errors import NoValueError
from dofkit.exact.ring.canonical import quotients_of
from dofkit.exact.zero import is_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Row, coordinates_of, split
from dofkit.relations.linear_relations import explicit_relations, number_coefficients
from dofkit.relations.normal.domain import DomainCondition, conditions_of
from dofkit.relations.normal.normal_form import normalise, velocities_of
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian
from dofkit.relations.normal.zero_set import never_vanishes

#: Bounds on the number of alternatives and of rounds of reduction.
MAX_ALTERNATIVES, MAX_ROUNDS = 16, 6


def rate(g: Expr) -> Expr:
    """Return the time derivative of g(q, t) along a motion."""
    moving = sorted((s for s in g.symbols if s.args[0] == "coordinate"), key=repr)
    terms = [diff(g, s) * ex.velocity(str(s.args[1])) for s in moving]
    return ex.add(*terms, diff(g, ex.TIME))


@dataclass(frozen=True)
class RewrittenRow:
    """A row ``written``, and the ``rows`` that replace it given the others: none if it is implied by them."""

    written: Row
    rows: tuple[Row, ...]

    @property
    def unchanged(self) -> bool:
        return self.rows == (self.written,)


class Alternative(NamedTuple):
    """All ``rows`` on one choice of branches, in the order of the scene.

    ``slots``: the replacement of each row; ``reduced``: the slots of rows that are no longer nonlinear; ``divided``:
    whether an expression that may vanish was divided by.
    """

    rows: list[Row]
    slots: tuple[RewrittenRow, ...] = ()
    reduced: tuple[RewrittenRow, ...] = ()
    divided: bool = False

    @classmethod
    def of(cls, slots: tuple[RewrittenRow, ...], divided: bool) -> Alternative:
        """Return the alternative with these replacements of rows."""
        linear = (s for s in slots if not s.unchanged and not any(isinstance(r.piece, Nonlinear) for r in s.rows))
        return cls([row for slot in slots for row in slot.rows], slots, tuple(linear), divided)


def alternatives_of(rows: Sequence[Row], positive: frozenset[Expr]) -> list[Alternative]:
    """Return the alternatives (choices of branches) of the rows, nonlinear rows being reduced by linear ones.

    The linear rows are solved for velocities, which are substituted into the nonlinear rows; these may then split into
    linear ones, used in the next round: xdot^2 + ydot^2 = zdot^2 with y = 2 x is zdot = +-sqrt(5) xdot.
    """
    alternatives, done = [Alternative.of(tuple(RewrittenRow(r, (r,)) for r in rows), False)], list[Alternative]()
    for _ in range(MAX_ROUNDS):
        following: list[Alternative] = []
        for alternative in alternatives:
            changed = _step(alternative, positive)
            if changed is None:
                done.append(alternative)
            else:
                following += changed
        alternatives = following[:MAX_ALTERNATIVES]
        if not alternatives:
            break
    return [*done, *alternatives][:MAX_ALTERNATIVES]


def _step(alternative: Alternative, positive: frozenset[Expr]) -> list[Alternative] | None:
    """Return the alternatives after one more reduction; None if no nonlinear row changes."""
    rows = alternative.rows
    if not any(isinstance(r.piece, Nonlinear) for r in rows):
        return None
    rewritings = {id(r): _rewritten(r, rows, positive) for r in rows if isinstance(r.piece, Nonlinear)}
    by_linear = {i: rewriting.alternatives for i, rewriting in rewritings.items()}
    divided = any(rewriting.divided for rewriting in rewritings.values())
    if all(len(result) == 1 and len(result[0]) == 1 and id(result[0][0]) in by_linear for result in by_linear.values()):
        return None
    options: list[list[RewrittenRow]] = []
    for slot in alternative.slots:
        choices = cartesian(*(by_linear.get(id(r), [(r,)]) for r in slot.rows))
        options.append([RewrittenRow(slot.written, tuple(r for part in choice for r in part)) for choice in choices])
    return [
        Alternative.of(choice, alternative.divided or divided)
        for choice in islice(cartesian(*options), MAX_ALTERNATIVES)
    ]


class _Rewriting(NamedTuple):
    """The branches of a row; ``divided``: whether an expression that may vanish was divided by."""

    alternatives: list[tuple[Row, ...]]
    divided: bool = False


def _rewritten(row: Row, rows: Sequence[Row], positive: frozenset[Expr]) -> _Rewriting:
    """Return a nonlinear row after substituting coordinates solved by finite rows and velocities by linear ones.

    If a divisor may vanish, the result is used only if it is linear; otherwise the velocities are not substituted.
    """
    if not isinstance(row.piece, Nonlinear):
        return _Rewriting([(row,)])
    near = _rows_near(row, rows)
    try:
        finite = (r.piece.expr for r in near if isinstance(r.piece, Finite))
        explicit = explicit_relations(finite, number_coefficients).by_others
        there = substitute(row.piece.expr, explicit)
        changed, divisors = eliminated(there, [substitute(e, explicit) for e in _rates_of(near)])
    except NoValueError:
        return _Rewriting([(row,)])
    if changed != there:
        try:
            result = _branches(row, *_without_divisors(row.piece.expr, changed, divisors, positive), positive)
        except NoValueError:  # what was put in leaves 0 to a power, which has no value
            return _Rewriting([(row,)])
        divided = not all(never_vanishes(d, positive) for d in divisors)
        alternatives = [b for b in result if not b] or result  # a branch without rows contains the others
        if not (divided and any(isinstance(r.piece, Nonlinear) for w in alternatives for r in w)):
            return _Rewriting(alternatives, divided)
    return _Rewriting([(row,)] if there == row.piece.expr else _branches(row, there, (), positive))


def _without_divisors(
    written: Expr, changed: Expr, divisors: Sequence[Expr], positive: frozenset[Expr]
) -> tuple[Expr, tuple[DomainCondition, ...]]:
    """Return the numerator of ``changed`` and the conditions for a value of ``written``, if there are divisors."""
    if not divisors:
        return changed, ()
    try:
        canon, [(numerator, _)] = quotients_of([changed], positive)
        top = canon.to_expr(numerator)
    except NoValueError:
        return changed, ()
    return top, tuple(c for c in conditions_of(written, positive) if not velocities_of(c.expr))


def _branches(
    row: Row, changed: Expr, within: Sequence[DomainCondition], positive: frozenset[Expr]
) -> list[tuple[Row, ...]]:
    """Return the branches of ``changed`` = 0 as rows, with conditions ``within``; for an empty set the row 1 = 0."""
    normal = normalise(changed, positive, True)
    alternatives = [tuple(Row(row.constraint, p) for p in (*b, *within)) for b in normal.branches]
    return alternatives or [(Row(row.constraint, Finite(ex.ONE)),)]


def _rows_near(row: Row, rows: Sequence[Row]) -> list[Row]:
    """Return the finite and linear rows that are connected to a row through coordinates."""
    others = [r for r in rows if not isinstance(r.piece, Nonlinear)]
    blocks, _ = split(sorted({name for r in others for name in coordinates_of(r.piece)}), others)
    return [r for b in blocks if not coordinates_of(row.piece).isdisjoint(b.coordinates) for r in b.rows]


def _rates_of(rows: Sequence[Row]) -> list[Expr]:
    """Return expressions linear in the velocities that vanish by the finite and linear rows."""
    rates = []
    for r in rows:
        if isinstance(r.piece, Finite):
            rates.append(rate(r.piece.expr))
        elif isinstance(r.piece, Pfaffian):
            rates.append(r.piece.rate)
    return rates


def eliminated(e: Expr, linear: Sequence[Expr]) -> tuple[Expr, list[Expr]]:
    """Return (``e`` after substituting the velocities for which ``linear`` can be solved, the divisors used)."""
    remaining, divisors = list(linear), list[Expr]()
    while remaining:
        relation = remaining.pop(0)
        choice = _pivot(relation)
        if choice is None:
            continue
        v, coefficient = choice
        divisors += [coefficient] if coefficient.op != "num" else []
        value = -(substitute(relation, {v: ex.ZERO}) / coefficient)
        remaining = [substitute(other, {v: value}) for other in remaining]
        e = substitute(e, {v: value})
    return e, divisors


def _pivot(relation: Expr) -> tuple[Expr, Expr] | None:
    """Return (velocity, coefficient) with a number as coefficient, or else one not identically 0; None if none."""
    result = [(v, diff(relation, v)) for v in velocities_of(relation)]
    for v, c in result:
        if c.op == "num" and not c.is_zero:
            return v, c
    return next(((v, c) for v, c in result if not is_zero(c, frozenset())), None)
