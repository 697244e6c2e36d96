"""The cone of second-order flexes {v: Q_1(v) = ... = Q_k(v) = 0} of quadratic forms.

The tangent cone of a set is contained in it, so that its dimension bounds that of the set [TangentCone]. Over the
complex numbers the bound is computed by ranks; over the reals the cone is {0} if a combination of forms is definite.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations_with_replacement
from typing import Any

from flint import arb

from dofkit.base.deadline import check
from dofkit.exact.matrices.dense import Matrix, dot, largest, least_eigenvector, length, pivoted, plus, times
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.residues import modulus, residue_matrix
from dofkit.exact.ring.program import Scalar

Form = Sequence[Sequence[Scalar]]
#: Bound on the dimension c of subspaces that meet the complex cone: the Macaulay matrix has comb(2 c, c + 1) columns.
MAX_CUTS = 6
#: Bound on the steps towards a definite combination, and the relative size of an eigenvalue that counts as positive.
STEPS, POSITIVE = 300, 1e-7
#: Denominators with which the weights of a definite combination are rounded.
DENOMINATORS = (1, 12, 840, 1 << 16)


def bound(forms: Sequence[Form], rigid: int) -> int:
    """Return an upper bound on the cone's dimension over the complex numbers, from forms over GF(p).

    The cone has at most dimension d if a linear subspace of codimension d meets it in 0 only. With c = m - d variables
    this is so if and only if the forms' multiples span all polynomials of degree c + 1 [Macaulay1902]; full rank modulo
    p is full rank. ``rigid`` is a lower bound.
    """
    m = len(forms[0])
    p = modulus(forms[0][0][0])
    independent = rank_of([[v for row in f for v in row] for f in forms], p)
    for cuts in range(min(m - rigid, independent, MAX_CUTS), 0, -1):
        if _only_zero(forms, cuts, p):
            return m - cuts
    return m


def _only_zero(forms: Sequence[Form], c: int, p: int) -> bool:
    """Return whether the forms have no common zero but 0 on a random subspace of dimension c."""
    rng = random.Random("dofkit cone")
    m = len(forms[0])
    basis = residue_matrix([[rng.randrange(p) for _ in range(c)] for _ in range(m)], p)
    cuts = []
    for form in forms:
        check()
        cut = basis.transpose() * residue_matrix([[int(v) for v in row] for row in form], p) * basis
        cuts.append([[int(cut[i, j]) for j in range(c)] for i in range(c)])
    rows = [[v % p for v in row] for row in macaulay_matrix(cuts, c)]
    return bool(residue_matrix(rows, p).rank() == len(rows[0]))


def macaulay_matrix(forms: Sequence[Sequence[Sequence[Any]]], c: int) -> list[list[Any]]:
    """Return the coefficients of all multiples of degree c + 1 of quadratic forms in c variables [Macaulay1902]."""
    monomials = {exponents: i for i, exponents in enumerate(combinations_with_replacement(range(c), c + 1))}
    rows = []
    for form in forms:
        terms = [((i, j), form[i][j] * (1 + (i != j))) for i in range(c) for j in range(i, c)]
        for factor in combinations_with_replacement(range(c), c - 1):
            row: list[Any] = [0] * len(monomials)
            for pair, value in terms:
                row[monomials[tuple(sorted((*factor, *pair)))]] += value
            rows.append(row)
    return rows


def definite_combination(forms: Sequence[Form], rank_wanted: int) -> bool:
    """Return whether it is proved that a combination of forms in balls is semidefinite with rank ``rank_wanted``.

    In linkages: a stress whose form is definite on the flexes (prestress stability [ConnellyWhiteley1996]).
    """
    m = len(forms[0])
    for weights in _candidates(forms, rank_wanted):
        weighted = list(zip(weights, forms, strict=True))
        total = [[sum((f[i][j] * w for w, f in weighted), arb(0)) for j in range(m)] for i in range(m)]
        positive, negative = signature_of(total)
        if not (positive and negative) and positive + negative == rank_wanted:
            return True
    return False


def _candidates(forms: Sequence[Form], rank_wanted: int) -> list[list[arb]]:
    """Return weights whose combination may be definite: each form on its own, and rounded results of `_search`."""
    k = len(forms)
    weightings = [[arb(int(i == j)) for i in range(k)] for j in range(k)]
    weights = _search(forms, rank_wanted)
    if weights is not None:
        size = largest(weights)
        for d in DENOMINATORS:
            rounded = [Fraction(round(w / size * d), d) for w in weights]
            weightings.append([arb(r.numerator) / r.denominator for r in rounded])
    return weightings


def floats_of(form: Form) -> list[list[float]]:
    """Return a form of balls in floats, with 0 for a ball that contains 0."""
    return [[0.0 if v.contains(0) else float(v.mid()) for v in row] for row in form]


def scaled(form: Matrix, scales: Sequence[float]) -> list[list[float]]:
    """Return a form in scaled coordinates, divided by its largest entry."""
    rows = [[v * s * t for v, t in zip(row, scales, strict=True)] for row, s in zip(form, scales, strict=True)]
    size = max(map(largest, rows), default=0.0) or 1.0
    return [[v / size for v in row] for row in rows]


def _search(forms: Sequence[Form], rank_wanted: int) -> list[float] | None:
    """Return weights w whose combination B(w) is positive definite modulo the common kernel; None if none is found.

    w is the point nearest to 0 of the convex hull of the vectors (v.B_i v); if it is not 0, B(w) is positive on every v
    (Gilbert's algorithm, with the eigenvector of the least eigenvalue as the next v).
    """
    floats = [floats_of(form) for form in forms]
    sizes = [max(map(largest, form)) or 1.0 for form in floats]
    floats = [scaled(form, [1.0] * len(form)) for form in floats]
    steps = pivoted([row for form in floats for row in form])
    quotient = [v for v, size in zip(steps.basis, steps.sizes, strict=True) if size > POSITIVE * steps.sizes[0]]
    if len(quotient) != rank_wanted or not quotient:
        return None
    cut = [[times(quotient, times(form, v)) for v in quotient] for form in floats]
    w = [sum(form[i][i] for i in range(rank_wanted)) / rank_wanted for form in cut]
    for _ in range(STEPS):
        rows = [[dot(w, entries) for entries in zip(*row, strict=True)] for row in zip(*cut, strict=True)]
        least, vector = least_eigenvector(rows)
        if least > POSITIVE * max(1.0, length(w)):
            return [v / size for v, size in zip(w, sizes, strict=True)]
        difference = plus(w, -1.0, [dot(times(form, vector), vector) for form in cut])
        square = dot(difference, difference)
        if square == 0:
            return None
        w = plus(w, -min(1.0, max(0.0, dot(w, difference) / square)), difference)
        if length(w) < POSITIVE:
            return None
    return None


def signature_of(form: Form) -> tuple[int, int]:
    """Return certified numbers (positive, negative) of squares in Lagrange's reduction [Sylvester1852]."""
    n = len(form)
    work = [list(row) for row in form]
    remaining = set(range(n))
    positive = negative = 0
    while remaining:
        pivot = _pivot(work, remaining)
        if pivot is None:
            break
        i, j = pivot
        if i != j:
            for k in range(n):
                work[i][k] = work[i][k] + work[j][k]
            for k in range(n):
                work[k][i] = work[k][i] + work[k][j]
        value = work[i][i]
        if value.contains(0):
            break
        positive, negative = (positive + 1, negative) if value > 0 else (positive, negative + 1)
        remaining.discard(i)
        for a in remaining:
            factor = work[a][i] / value
            for b in remaining:
                work[a][b] = work[a][b] - factor * work[i][b]
    return positive, negative


def _pivot(work: list[list[arb]], remaining: set[int]) -> tuple[int, int] | None:
    """Return (row, column) of the largest diagonal entry that is not 0, else of such an off-diagonal one, or None."""
    best, size = None, arb(0)
    for i in remaining:
        if not work[i][i].contains(0) and work[i][i].abs_lower() > size:
            best, size = (i, i), work[i][i].abs_lower()
    if best is not None:
        return best
    return next(((i, j) for i in remaining for j in remaining if i != j and not work[i][j].contains(0)), None)
