"""Quadratic forms, and sums of two powers, in the velocities that split into linear forms over the reals.

Q(v) = v^T S v with v = (velocities, 1). Of rank 1 it is a square: one linear form. Of rank 2, with S_ii not 0 and
D = S_ii S - S_i^T S_i (then of rank 1, D_jj not 0): S_ii Q = (S_i v)^2 + (D_j v)^2 / D_jj, so Q = 0 means both forms
vanish where D_jj > 0, and S_i v = +- D_j v / sqrt(-D_jj) where D_jj < 0; where D_jj = 0 it is a square. The sign of
D_jj may depend on the place: then each of these is a branch with its condition. Of higher rank Q = 0 means that all
forms vanish where every pivot like D_jj is positive (law of inertia [Sylvester1852]), else it stays nonlinear.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.elimination import by_velocities
from dofkit.relations.normal.half_lines import SidedLines
from dofkit.relations.normal.semidefinite import Signs, weak_sign
from dofkit.relations.normal.velocity_roots import rates
from dofkit.relations.normal.zero_set import never_vanishes, zero_set

Matrix = list[list[Expr]]
#: Squares that a form is written as a sum of.
MAX_RANK = 5


def split_quadratic(e: Expr, velocities: Sequence[Expr], positive: frozenset[Expr]) -> list[SidedLines] | None:
    """Branches of linear forms whose zeros are those of ``e``; None where it is not quadratic or does not split."""
    try:
        form = _matrix(e, velocities)
    except NoValueError:
        return None
    if form is None:
        return None
    pivots = _pivots(form, [*velocities, ex.ONE], positive)
    if pivots is None:
        return None
    if len(pivots) == 1:
        return [_off_edge(SidedLines((pivots[0].line,), ()), pivots[0])]
    if all(p.sign == 1 for p in pivots[1:]):
        return _all_vanish(pivots, velocities, positive)
    if len(pivots) > 2:
        return None
    return [_off_edge(one, pivots[0]) for one in _two_lines(pivots[0], pivots[1], velocities, positive)]


def _off_edge(one: SidedLines, pivot: _Pivot) -> SidedLines:
    """A line where the square is not 0: there S_ii Q = 0 says nothing, and the line may be 0 for all velocities.

    So is that of z xdot^2 + 2 xdot ydot = 0 at z = 0.
    """
    if pivot.firm:
        return one
    return SidedLines(one.relations, (*one.conditions, DomainCondition(pivot.square, "!=", True)))


class _Pivot(NamedTuple):
    """The form that is squared, the size of its square, and its sign (0: not known).

    ``firm``: it vanishes nowhere; ``single``: of what is left there is only the square of one velocity.
    """

    line: Expr
    square: Expr
    sign: int
    firm: bool
    single: bool

    def zeros(self, positive: frozenset[Expr]) -> list[tuple[Expr, ...]]:
        """Where the square vanishes, by branches."""
        return [] if self.firm else list(zero_set(self.square, positive, _moving(self.square))[0])


def _moving(e: Expr) -> frozenset[Expr]:
    return frozenset(s for s in e.symbols if s.args[0] in ("coordinate", "time"))


def _pivots(form: Matrix, vector: Sequence[Expr], positive: frozenset[Expr]) -> list[_Pivot] | None:
    """S_ii Q as squares, one after another, numbers first; None where one has no square, or more than two no sign."""
    found: list[_Pivot] = []
    rest = form
    while not all(_zero(v) for line in rest for v in line):
        places = [i for i in range(len(vector)) if not _zero(rest[i][i])]
        if not places or len(found) > MAX_RANK or (len(found) > 1 and any(p.sign != 1 for p in found[1:])):
            return None
        i = next((i for i in places if rest[i][i].op == "num"), places[0])
        row, square = rest[i], rest[i][i]
        firm = not _moving(square) or never_vanishes(square, positive)
        single = sum(not _zero(v) for line in rest for v in line) == 1
        found.append(_Pivot(_dot(row, vector), square, _sign(square, positive) if found else 1, firm, single))
        rest = [[square * b - row[m] * row[j] for j, b in enumerate(line)] for m, line in enumerate(rest)]
    return found or None


def _all_vanish(
    pivots: Sequence[_Pivot], velocities: Sequence[Expr], positive: frozenset[Expr]
) -> list[SidedLines] | None:
    """All forms vanish, or all but the last where its square does; None where another square may vanish as well."""
    last = pivots[-1]
    if not all(p.firm for p in pivots[:-1]) or not (last.firm or last.single):
        return None
    between = [SidedLines((*zero, *(p.line for p in pivots[:-1])), ()) for zero in last.zeros(positive)]
    moving = all(rates(p.line) for p in pivots)
    return [_point(pivots, velocities), *between] if moving or not between else between


def _point(pivots: Sequence[_Pivot], velocities: Sequence[Expr]) -> SidedLines:
    """All forms vanish; as many as there are velocities, without a term free of them, make every velocity 0."""
    rest = dict.fromkeys(velocities, ex.ZERO)
    whole = len(pivots) == len(velocities) and all(substitute(p.line, rest).is_zero for p in pivots)
    return SidedLines(tuple(velocities) if whole else tuple(p.line for p in pivots), ())


def _two_lines(
    first: _Pivot, second: _Pivot, velocities: Sequence[Expr], positive: frozenset[Expr]
) -> list[SidedLines]:
    """Two lines where the second square is negative; a point where it is positive, one line where it vanishes."""
    root = ex.sqrt(-second.square)
    if second.single and rates(second.line):
        other = second.line / second.square * root
        lines = [first.line + other, first.line - other]
        apart = [SidedLines((line,), ()) for line in lines]
    else:
        lines = [first.line * root - second.line, first.line * root + second.line]
        apart = [_off_edge(SidedLines((line,), ()), second) for line in lines]
    if second.sign == -1 or not _moving(second.square):
        return apart
    zeros = second.zeros(positive) if first.firm and second.single and rates(second.line) else []
    edge = DomainCondition(-second.square, ">" if zeros else ">=", bool(zeros))
    apart = [SidedLines(one.relations, (edge, *one.conditions)) for one in apart]
    if not rates(second.line):
        return apart
    point = SidedLines(_point((first, second), velocities).relations, (DomainCondition(second.square, ">"),))
    return [*apart, point, *(SidedLines((*zero, first.line), ()) for zero in zeros)]


def split_power(e: Expr, positive: frozenset[Expr]) -> list[SidedLines] | None:
    """Branches of linear forms of a v^k + b w^k = 0, v and w velocities, or of a v^k + b = 0, for k > 2; else None.

    For odd k that is v = (-b/a)^(1/k) w over the reals; for even k v = +-(-b/a)^(1/k) w, or v = w = 0 where b/a > 0.
    """
    ring = Ring([e], positive)
    node = ring.node(e)
    try:
        canon = Canon(ring)
        terms = by_velocities(canon, canon.quotient(node)[0])
    except NoValueError:
        return None
    if len(terms) != 2 or any(len(moving) > 1 for moving in terms):
        return None
    (first, b), (second, a) = sorted(terms.items(), key=lambda item: len(item[0]))
    degrees = {k for _, k in (*first, *second)}
    if len(degrees) > 1 or any(ring.vars[i].kind != "symbol" for i, _ in (*first, *second)):
        return None
    v, k = ring.var_expr[second[0][0]], second[0][1]
    w = ring.var_expr[first[0][0]] if first else ex.ONE
    if k < 3:
        return None
    ratio = -(canon.to_expr(b) / canon.to_expr(a))
    root = ex.power(ratio, ex.num(Fraction(1, k)))
    if k % 2:
        return [SidedLines((v - root * w,), ())]
    point = [SidedLines((v, w), ())] if first else []
    zeros = zero_set(ratio, positive, _moving(ratio))[0] if _moving(ratio) else ()
    edge = [SidedLines((*zero, v), ()) for zero in zeros]
    sign = _sign(ratio, positive)
    if sign == -1:
        return [*point, *edge]
    lines = [SidedLines((v - root * w,), ()), SidedLines((v + root * w,), ())]
    if not edge and (sign == 1 or not _moving(ratio)):
        return lines
    within = DomainCondition(ratio, ">", True)
    return [
        *(SidedLines(one.relations, (within,)) for one in lines),
        *(SidedLines(one.relations, (DomainCondition(-ratio, ">"),)) for one in point),
        *edge,
    ]


def _matrix(e: Expr, velocities: Sequence[Expr]) -> Matrix | None:
    """The symmetric matrix of the homogenised quadratic; None where ``e`` is not one."""
    zeros = dict.fromkeys(velocities, ex.ZERO)
    n = len(velocities)
    form: Matrix = [[ex.ZERO] * (n + 1) for _ in range(n + 1)]
    for i, v in enumerate(velocities):
        slope = diff(e, v)
        form[i][n] = form[n][i] = ex.HALF * substitute(slope, zeros)
        for j, w in enumerate(velocities):
            second = ex.HALF * diff(slope, w)
            if any(s.args[0] == "velocity" for s in second.symbols):
                return None
            form[i][j] = second
    form[n][n] = substitute(e, zeros)
    return form


def _dot(row: Sequence[Expr], vector: Sequence[Expr]) -> Expr:
    return ex.add(*(a * v for a, v in zip(row, vector, strict=True)))


def _zero(e: Expr) -> bool:
    if e.is_zero or e.op == "num":
        return e.is_zero
    ring = Ring([e])
    node = ring.node(e)
    try:
        return Canon(ring).is_zero(node)
    except NoValueError:
        return False


def _sign(e: Expr, positive: frozenset[Expr]) -> int:
    """1 for what is proved to be >= 0 everywhere, -1 for <= 0, else 0."""
    ring = Ring([e], positive)
    node = ring.node(e)
    try:
        canon = Canon(ring)
        top, bottom = canon.quotient(node)
        if not bottom.is_constant():
            return 0
        return weak_sign(canon, Signs(canon, positive), top) * (1 if bottom.leading_coefficient() > 0 else -1)
    except NoValueError:
        return 0
