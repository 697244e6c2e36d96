"""Relations nonlinear in the velocities, in the presence of linear ones."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from itertools import product as cartesian

from dofkit.exact.errors import NoValueError
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Row, coordinates_of
from dofkit.relations.normal.normal_form import normalise, velocities_of
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian
from dofkit.relations.normal.zero_set import never_vanishes

#: Ways to split the nonlinear relations that are looked at, and rounds of reduction.
MAX_WAYS, MAX_ROUNDS = 16, 6


def rate(g: Expr) -> Expr:
    """dg/dt along a motion, for a finite relation."""
    moving = sorted((s for s in g.symbols if s.args[0] == "coordinate"), key=repr)
    parts = [diff(g, s) * ex.velocity(str(s.args[1])) for s in moving]
    return ex.add(*parts, diff(g, ex.TIME))


def form_rate(form: Pfaffian) -> Expr:
    """The form with velocities in place of differentials."""
    return ex.add(*(e * ex.velocity(name) for name, e in form.coefficients.items()), form.dt)


@dataclass(frozen=True)
class RewrittenRow:
    """A row as it was written and what it says beside the others: no row where it says nothing new."""

    written: Row
    rows: tuple[Row, ...]

    @property
    def unchanged(self) -> bool:
        return self.rows == (self.written,)


@dataclass(frozen=True)
class Way:
    """All rows on one choice of branches, in the order in which they were written."""

    slots: tuple[RewrittenRow, ...]

    @property
    def rows(self) -> list[Row]:
        return [row for slot in self.slots for row in slot.rows]

    @property
    def reduced(self) -> tuple[RewrittenRow, ...]:
        """Return the rows that were written nonlinear in the velocities and are not so any more."""
        changed = (s for s in self.slots if not s.unchanged)
        return tuple(s for s in changed if not any(isinstance(r.piece, Nonlinear) for r in s.rows))


def ways_of(rows: Sequence[Row], positive: frozenset[Expr]) -> list[Way]:
    """Return the rows with nonlinear ones reduced by the linear ones that share coordinates with them.

    Velocities that the linear rows give are put into the nonlinear ones, which may then split into linear ones:
    xdot^2 + ydot^2 = zdot^2 with y = 2 x is zdot = +-sqrt(5) xdot. What is new is used in the next round.
    """
    ways, done = [Way(tuple(RewrittenRow(r, (r,)) for r in rows))], list[Way]()
    for _ in range(MAX_ROUNDS):
        following: list[Way] = []
        for way in ways:
            changed = _step(way, positive)
            if changed is None:
                done.append(way)
            else:
                following += changed
        ways = following[:MAX_WAYS]
        if not ways:
            break
    return [*done, *ways][:MAX_WAYS]


def _step(way: Way, positive: frozenset[Expr]) -> list[Way] | None:
    """Return the ways that one more reduction leaves; None where nothing is left to do."""
    rows = way.rows
    branches = {id(r): _branches(r, rows, positive) for r in rows if isinstance(r.piece, Nonlinear)}
    if all(len(some) == 1 and len(some[0]) == 1 and id(some[0][0]) in branches for some in branches.values()):
        return None
    options: list[list[RewrittenRow]] = []
    for slot in way.slots:
        choices = cartesian(*(branches.get(id(r), [(r,)]) for r in slot.rows))
        options.append([RewrittenRow(slot.written, tuple(r for part in choice for r in part)) for choice in choices])
    return [Way(choice) for choice in islice(cartesian(*options), MAX_WAYS)]


def _branches(row: Row, rows: Sequence[Row], positive: frozenset[Expr]) -> list[tuple[Row, ...]]:
    """Return the branches of a nonlinear row after elimination of coordinates and velocities that other rows determine.

    Only what vanishes nowhere is divided by, so that the row says the same beside the others. A branch that says
    nothing holds all others.
    """
    if not isinstance(row.piece, Nonlinear):
        return [(row,)]
    near = _rows_near(row, rows)
    try:
        explicit = given_by([r.piece.expr for r in near if isinstance(r.piece, Finite)])
        linear = [substitute(e, explicit) for e in _rates_of(near)]
        reduced = eliminated(substitute(row.piece.expr, explicit), linear, positive)
    except NoValueError:
        return [(row,)]
    if reduced == row.piece.expr:
        return [(row,)]
    branches = [tuple(Row(row.constraint, p) for p in b) for b in normalise(reduced, positive, True).branches]
    return [()] if () in branches else branches or [(Row(row.constraint, Finite(ex.ONE)),)]


def _rows_near(row: Row, rows: Sequence[Row]) -> list[Row]:
    """The finite and linear rows that are joined to a row through coordinates."""
    names = set(coordinates_of(row.piece))
    found: list[Row] = []
    growing = True
    while growing:
        new = [
            r for r in rows if r not in found and not isinstance(r.piece, Nonlinear) and coordinates_of(r.piece) & names
        ]
        growing = bool(new)
        found += new
        names |= {n for r in new for n in coordinates_of(r.piece)}
    return found


def _rates_of(rows: Sequence[Row]) -> list[Expr]:
    """What finite and linear rows say of velocities."""
    rates = []
    for r in rows:
        if isinstance(r.piece, Finite):
            rates.append(rate(r.piece.expr))
        elif isinstance(r.piece, Pfaffian):
            rates.append(form_rate(r.piece))
    return rates


def eliminated(e: Expr, linear: Sequence[Expr], positive: frozenset[Expr]) -> Expr:
    """Return ``e`` with the velocities substituted that linear relations determine by coefficients without zeros."""
    remaining = list(linear)
    while remaining:
        relation = remaining.pop(0)
        pivot = _pivot(relation, positive)
        if pivot is not None:
            v, coefficient = pivot
            value = {v: -(substitute(relation, {v: ex.ZERO}) / coefficient)}
            remaining = [substitute(other, value) for other in remaining]
            e = substitute(e, value)
    return e


def given_by(relations: Iterable[Expr]) -> Mapping[Expr, Expr]:
    """Return the coordinates that relations determine, as functions of others, each free of those solved for."""
    found: dict[Expr, Expr] = {}
    for g in relations:
        own = substitute(g, found)
        pivot = next(_coordinate_pivots(own), None)
        if pivot is not None:
            s, value = pivot
            found = {k: substitute(v, {s: value}) for k, v in found.items()} | {s: value}
    return found


def _coordinate_pivots(g: Expr) -> Iterator[tuple[Expr, Expr]]:
    """Yield the coordinates that stand in a relation once, with a number as coefficient, and their values."""
    terms = linear_terms(g)
    for s, c in terms.items():
        if s.op == "sym" and s.args[0] == "coordinate" and not any(s in u.symbols for u in terms if u != s):
            rest = ex.add(*(ex.mul(ex.num(-k / c), u) for u, k in terms.items() if u != s))
            yield s, rest


def _pivot(relation: Expr, positive: frozenset[Expr]) -> tuple[Expr, Expr] | None:
    """Return a velocity of a linear relation with a coefficient that vanishes nowhere; numbers first."""
    slopes = [(v, c) for v in velocities_of(relation) if not (c := diff(relation, v)).is_zero]
    number = next(((v, c) for v, c in slopes if c.op == "num"), None)
    return number or next(((v, c) for v, c in slopes if never_vanishes(c, positive)), None)
