"""Relations nonlinear in the velocities, in the presence of linear ones."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product as cartesian

from dofkit import expr as ex
from dofkit.blocks import Row, coordinates_of
from dofkit.exact.identity import is_zero
from dofkit.expr import Expr
from dofkit.normal import Finite, Inequality, Nonlinear, Pfaffian, normalise, velocities_of

#: Ways to split the nonlinear relations that are looked at.
MAX_WAYS = 16


def rate(g: Expr) -> Expr:
    """dg/dt along a motion, for a finite relation."""
    moving = sorted((s for s in g.symbols if s.args[0] == "coordinate"), key=repr)
    parts = [ex.diff(g, s) * ex.velocity(str(s.args[1])) for s in moving]
    return ex.add(*parts, ex.diff(g, ex.TIME))


def form_rate(form: Pfaffian) -> Expr:
    """The form with velocities in place of differentials."""
    return ex.add(*(e * ex.velocity(name) for name, e in form.coefficients.items()), form.dt)


def reduced(rows: Sequence[Row], positive: frozenset[Expr]) -> list[list[Row]]:
    """The rows with nonlinear ones reduced by the linear ones that share coordinates with them.

    Velocities that the linear rows give are put into the nonlinear ones, which may then split into linear ones:
    xdot^2 + ydot^2 = zdot^2 with y = 2 x is zdot = +-sqrt(5) xdot. A list of ways, each a list of rows.
    """
    if not any(isinstance(r.piece, Nonlinear) for r in rows):
        return [list(rows)]
    options: list[list[tuple[Row, ...]]] = []
    for row in rows:
        options.append(_ways(row, rows, positive) if isinstance(row.piece, Nonlinear) else [(row,)])
    ways = []
    for choice in cartesian(*options):
        ways.append([r for part in choice for r in part])
        if len(ways) == MAX_WAYS:
            break
    return ways


def _ways(row: Row, rows: Sequence[Row], positive: frozenset[Expr]) -> list[tuple[Row, ...]]:
    if not isinstance(row.piece, Nonlinear):
        return [(row,)]
    linear = _linear_near(row, rows)
    if not linear:
        return [(row,)]
    changed = eliminated(row.piece.expr, linear)
    if changed == row.piece.expr:
        return [(row,)]
    normal = normalise(changed, positive, True)
    ways = [tuple(Row(row.constraint, p) for p in b if not isinstance(p, Inequality)) for b in normal.branches]
    return ways or [(Row(row.constraint, Finite(ex.ONE)),)]


def _linear_near(row: Row, rows: Sequence[Row]) -> list[Expr]:
    """Rates of the finite and linear rows that are joined to a row through coordinates."""
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
    rates = []
    for r in found:
        if isinstance(r.piece, Finite):
            rates.append(rate(r.piece.expr))
        elif isinstance(r.piece, Pfaffian):
            rates.append(form_rate(r.piece))
    return rates


def eliminated(e: Expr, linear: Sequence[Expr]) -> Expr:
    """``e`` with the velocities that the linear relations give put in."""
    left = list(linear)
    while left:
        relation = left.pop(0)
        choice = _pivot(relation)
        if choice is None:
            continue
        v, coefficient = choice
        value = -(ex.substitute(relation, {v: ex.ZERO}) / coefficient)
        left = [ex.substitute(other, {v: value}) for other in left]
        e = ex.substitute(e, {v: value})
    return e


def _pivot(relation: Expr) -> tuple[Expr, Expr] | None:
    """A velocity of a linear relation with a coefficient that is not identically 0; numbers first."""
    found = [(v, ex.diff(relation, v)) for v in velocities_of(relation)]
    for v, c in found:
        if c.op == "num" and not c.is_zero:
            return v, c
    return next(((v, c) for v, c in found if not is_zero(c, frozenset())), None)
