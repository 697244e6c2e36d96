"""Quadratic forms, and sums of two powers, in the velocities that split into linear forms over the reals.

Q(v) = v^T S v with v = (velocities, 1). Of rank 1 it is a square: one linear form. Of rank 2, with S_ii not 0 and
D = S_ii S - S_i^T S_i (then of rank 1, D_jj not 0): S_ii Q = (S_i v)^2 + (D_j v)^2 / D_jj, so Q = 0 means both forms
vanish where D_jj > 0, and S_i v = +- D_j v / sqrt(-D_jj) where D_jj < 0. Of higher rank it stays nonlinear, or
is a sum of squares where it is semidefinite (seen before, for constant coefficients).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.elimination import by_velocities
from dofkit.relations.normal.semidefinite import Signs, weak_sign

Matrix = list[list[Expr]]


def split_quadratic(e: Expr, velocities: Sequence[Expr], positive: frozenset[Expr]) -> list[tuple[Expr, ...]] | None:
    """Branches of linear forms whose zeros are those of ``e``; None where it is not quadratic or does not split."""
    try:
        form = _matrix(e, velocities)
    except NoValueError:
        return None
    if form is None:
        return None
    vector = [*velocities, ex.ONE]
    pivot = next((i for i in range(len(vector)) if not _zero(form[i][i])), None)
    if pivot is None:
        return None
    row = form[pivot]
    rest = [[row[pivot] * b - row[i] * row[j] for j, b in enumerate(line)] for i, line in enumerate(form)]
    second = next((j for j in range(len(vector)) if not _zero(rest[j][j])), None)
    first = _dot(row, vector)
    if second is None:
        return [(first,)] if all(_zero(v) for line in rest for v in line) else None
    if not _rank_one(rest):
        return None
    other, square = _dot(rest[second], vector), rest[second][second]
    if _sign(square, positive) == 1:
        return [(first, other)]
    root = ex.sqrt(-square)
    return [(first * root - other,), (first * root + other,)]


def split_power(e: Expr, positive: frozenset[Expr]) -> list[tuple[Expr, ...]] | None:
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
        return [(v - root * w,)]
    return [(v, w)] if _sign(ratio, positive) == -1 else [(v - root * w,), (v + root * w,)]


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


def _rank_one(rest: Matrix) -> bool:
    n = len(rest)
    pairs = list(combinations(range(n), 2))
    return all(_zero(rest[i][k] * rest[j][m] - rest[i][m] * rest[j][k]) for i, j in pairs for k, m in pairs)


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
