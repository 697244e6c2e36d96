"""Relations in the presence of others: nonlinear in the velocities beside linear ones, and two sides of a boundary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice
from itertools import product as cartesian
from typing import NamedTuple

from dofkit.base.errors import NoValueError
from dofkit.exact.ring.canonical import quotients_of
from dofkit.exact.zero import is_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, linear_terms, substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Row, coordinates_of, split
from dofkit.relations.linear_relations import explicit_relations, number_coefficients
from dofkit.relations.normal.domain import DomainCondition, conditions_of
from dofkit.relations.normal.normal_form import linear_form, normalise, velocities_of
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian
from dofkit.relations.normal.zero_set import never_vanishes

#: The most alternatives into which nonlinear relations are split, and rounds of reduction.
MAX_ALTERNATIVES, MAX_ROUNDS = 16, 6


def rate(g: Expr) -> Expr:
    """dg/dt along a motion, for a geometric equation."""
    moving = sorted((s for s in g.symbols if s.args[0] == "coordinate"), key=repr)
    terms = [diff(g, s) * ex.velocity(str(s.args[1])) for s in moving]
    return ex.add(*terms, diff(g, ex.TIME))


def with_boundaries(rows: Sequence[Row]) -> list[Row]:
    """The rows with u = 0 in place of the conditions u >= 0 and -u >= 0, as the later one's."""
    kept: dict[int, Row] = {}
    sides: dict[frozenset[tuple[Expr, Fraction]], int] = {}
    for place, row in enumerate(rows):
        kept[place] = row
        if not isinstance(row.piece, DomainCondition) or row.piece.sense != ">=":
            continue
        form, terms = linear_form(row.piece.expr), linear_terms(row.piece.expr).items()
        pair = sides.pop(frozenset((term, -c) for term, c in terms), None)
        if pair is None or form is None:
            sides[frozenset(terms)] = place
            continue
        del kept[pair]
        kept[place] = Row(row.constraint, form if form.coefficients else Finite(row.piece.expr))
    return list(kept.values())


@dataclass(frozen=True)
class RewrittenRow:
    """A row as it was written and what it says together with the others: no row where it says nothing new."""

    written: Row
    rows: tuple[Row, ...]

    @property
    def unchanged(self) -> bool:
        return self.rows == (self.written,)


class Alternative(NamedTuple):
    """All rows on one choice of branches, in the order in which they were written.

    ``slots``: what became of each row, where a relation nonlinear in the velocities is among them; ``reduced``: of
    those that were nonlinear and are so no more; ``divided``: to rewrite one, what may vanish somewhere was divided by.
    """

    rows: list[Row]
    slots: tuple[RewrittenRow, ...] = ()
    reduced: tuple[RewrittenRow, ...] = ()
    divided: bool = False

    @classmethod
    def of(cls, slots: tuple[RewrittenRow, ...], divided: bool) -> Alternative:
        """Return the alternative with these rows."""
        linear = (s for s in slots if not s.unchanged and not any(isinstance(r.piece, Nonlinear) for r in s.rows))
        return cls([row for slot in slots for row in slot.rows], slots, tuple(linear), divided)


def alternatives_of(rows: Sequence[Row], positive: frozenset[Expr]) -> list[Alternative]:
    """Return the rows with nonlinear ones reduced by the linear ones that share coordinates with them.

    Velocities that the linear rows give are put into the nonlinear ones, which may then split into linear ones:
    xdot^2 + ydot^2 = zdot^2 with y = 2 x is zdot = +-sqrt(5) xdot. What is new is used in the next round.
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
    """The alternatives that one more reduction leaves; None where nothing is left to do."""
    rows = alternative.rows
    if not any(isinstance(r.piece, Nonlinear) for r in rows):
        return None
    answer = {id(r): _ways(r, rows, positive) for r in rows if isinstance(r.piece, Nonlinear)}
    by_linear, divided = (
        {i: rewriting.alternatives for i, rewriting in answer.items()},
        any(rewriting.divided for rewriting in answer.values()),
    )
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
    """The branches of a row; was there a division by what may vanish?"""

    alternatives: list[tuple[Row, ...]]
    divided: bool = False


def _ways(row: Row, rows: Sequence[Row], positive: frozenset[Expr]) -> _Rewriting:
    """A nonlinear row with coordinates put in that the finite rows give, and then velocities that linear ones do.

    What was divided by may vanish where the rows hold: what is left says all only where it is linear, which is checked.
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
        alternatives = [b for b in result if not b] or result  # the branch that says nothing holds the others
        if not (divided and any(isinstance(r.piece, Nonlinear) for w in alternatives for r in w)):
            return _Rewriting(alternatives, divided)
    return _Rewriting([(row,)] if there == row.piece.expr else _branches(row, there, (), positive))


def _without_divisors(
    written: Expr, changed: Expr, divisors: Sequence[Expr], positive: frozenset[Expr]
) -> tuple[Expr, tuple[DomainCondition, ...]]:
    """What a row reads as without what an elimination divided by, and where the row as it was written has a value."""
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
    """What a row says that now reads ``changed`` = 0."""
    normal = normalise(changed, positive, True)
    alternatives = [tuple(Row(row.constraint, p) for p in (*b, *within)) for b in normal.branches]
    return alternatives or [(Row(row.constraint, Finite(ex.ONE)),)]


def _rows_near(row: Row, rows: Sequence[Row]) -> list[Row]:
    """The finite and linear rows that are joined to a row through coordinates."""
    others = [r for r in rows if not isinstance(r.piece, Nonlinear)]
    blocks, _ = split(sorted({name for r in others for name in coordinates_of(r.piece)}), others)
    return [r for b in blocks if not coordinates_of(row.piece).isdisjoint(b.coordinates) for r in b.rows]


def _rates_of(rows: Sequence[Row]) -> list[Expr]:
    """What finite and linear rows say of velocities."""
    rates = []
    for r in rows:
        if isinstance(r.piece, Finite):
            rates.append(rate(r.piece.expr))
        elif isinstance(r.piece, Pfaffian):
            rates.append(r.piece.rate)
    return rates


def eliminated(e: Expr, linear: Sequence[Expr]) -> tuple[Expr, list[Expr]]:
    """``e`` with the velocities that the linear relations give put in, and what was divided by."""
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
    """A velocity of a linear relation with a coefficient that is not identically 0; numbers first."""
    result = [(v, diff(relation, v)) for v in velocities_of(relation)]
    for v, c in result:
        if c.op == "num" and not c.is_zero:
            return v, c
    return next(((v, c) for v, c in result if not is_zero(c, frozenset())), None)
