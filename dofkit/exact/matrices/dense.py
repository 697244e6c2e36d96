"""Dense matrices of floats, as lists of rows: Newton steps, pivots and singular values.

Searches use them; no proof does. FLINT computes with `BITS` bits for up to `SMALL` entries, and numpy, which is then
imported, for larger matrices; without numpy (as in a browser) FLINT computes all.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from operator import mul
from typing import NamedTuple

from flint import acb_mat, arb_mat, ctx

from dofkit.base.errors import NoValueError
from dofkit.base.libraries import HAS_NUMPY, np

Vector = Sequence[float]
Matrix = Sequence[Vector]

#: Bits of FLINT's numbers for small matrices, and the largest number of entries of a small matrix.
BITS, SMALL = 512, 400 if HAS_NUMPY else math.inf
#: Singular values up to `FLAT` count as 0 in a step; `LEAST` keeps a damped system regular where f = 0.
FLAT, LEAST = 1e-12, 1e-60
#: How often Gram-Schmidt is repeated for one direction, because the first pass leaves rounding errors.
GRAM_SCHMIDT_PASSES = 2


def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product."""
    product: float = sum(map(mul, a, b))
    return product


def length(v: Vector) -> float:
    """Return the Euclidean length."""
    return math.hypot(*v)


def largest(v: Vector) -> float:
    """Return the largest absolute value; 0 if ``v`` is empty, NaN if an entry is not finite."""
    return max(map(abs, v), default=0.0) + 0.0 * sum(v)


def times(matrix: Matrix, v: Vector) -> list[float]:
    """Return the product of a matrix and a vector."""
    return [dot(row, v) for row in matrix]


def plus(a: Vector, factor: float, b: Vector) -> list[float]:
    """Return a + factor b."""
    return [x + factor * y for x, y in zip(a, b, strict=True)]


def unit_rows(matrix: Matrix, least: float = 0.0) -> list[list[float]]:
    """Return the rows scaled to length 1 if longer than ``least``; raises NoValueError if an entry is not finite."""
    lengths = [length(row) for row in matrix]
    if not all(map(math.isfinite, lengths)):
        raise NoValueError("an entry of the matrix is not finite")
    return [[v / size for v in row] if size > least else list(row) for row, size in zip(matrix, lengths, strict=True)]


def step(j: Matrix, f: Vector) -> list[float]:
    """Return the shortest step u that minimises |J u + f|; singular values below `FLAT` count as 0.

    >>> step([[1.0, 1.0], [1.0, 1.0]], [2.0, 2.0])
    [-1.0, -1.0]
    """
    return _step(j, f, 3, FLAT**6)


def damped(j: Matrix, f: Vector, power: int = 1) -> list[float]:
    """Return the damped step -J^T (J J^T + |f|^power I)^-1 f, small in directions where J is smaller than |f|^power."""
    return _step(j, f, 1, length(f) ** power + LEAST)


def _step(j: Matrix, f: Vector, order: int, shift: float) -> list[float]:
    """Return -J^+ f with each singular value s of J replaced by s + shift / s^(2 order - 1)."""
    if not j or not j[0]:
        return [0.0] * len(j[0] if j else ())
    if len(j) * len(j[0]) > SMALL:
        return [float(v) for v in array_step(np.array(j), np.array(f), order, shift)]
    with ctx.workprec(BITS):
        matrix, right = arb_mat([list(map(float, row)) for row in j]), arb_mat([[float(v)] for v in f])
        transposed = matrix.transpose()
        gram = matrix * transposed
        product = gram
        for _ in range(order - 1):
            product, right = product * gram, gram * right
        for i in range(len(j)):
            product[i, i] = product[i, i] + shift
        change = transposed * product.solve(right, algorithm="approx")
        return [-float(change[i, 0].mid()) for i in range(len(j[0]))]


def array_step(j: np.ndarray, f: np.ndarray, order: int, shift: float) -> np.ndarray:
    """Return what `_step` returns, for numpy arrays."""
    u, singular, v = np.linalg.svd(j, full_matrices=False)
    factors = singular ** (2 * order - 1) / (singular ** (2 * order) + shift + 1e-300)
    return np.asarray(-(v.T @ (factors * (u.T @ f))))


class Pivoting(NamedTuple):
    """Row numbers in ``order`` of pivoting, ``sizes`` of the rows' remainders, an orthonormal ``basis`` of the rows."""

    order: list[int]
    sizes: list[float]
    basis: list[list[float]]


def pivoted(matrix: Matrix, least: float = 0.0, most: int | None = None) -> Pivoting:
    """Return pivoted Gram-Schmidt of the rows: each step takes the row with the largest remainder.

    It ends after ``most`` rows (by default the smaller dimension), or if no remainder is above ``least``.

    >>> pivoted([[0.0, 1.0], [3.0, 0.0], [6.0, 0.0]], 1e-9)
    Pivoting(order=[2, 0], sizes=[6.0, 1.0], basis=[[1.0, 0.0], [0.0, 1.0]])
    """
    residual, chosen = list(map(list, matrix)), Pivoting([], [], [])
    rank = min(len(residual), len(residual[0])) if residual else 0
    most = rank if most is None else min(rank, most)
    if rank and len(matrix) * len(matrix[0]) > SMALL:
        return _array_pivoted(np.array(matrix, float), least, most)
    for _ in range(most):
        sizes = [length(row) for row in residual]
        best = max(range(len(sizes)), key=sizes.__getitem__)
        if not sizes[best] > least:
            break
        direction = residual[best]
        for _ in range(GRAM_SCHMIDT_PASSES):
            for other in chosen.basis:
                direction = plus(direction, -dot(direction, other), other)
            size = length(direction)
            if not size:
                return chosen
            direction = [v / size for v in direction]
        chosen.order.append(best)
        chosen.sizes.append(sizes[best])
        chosen.basis.append(direction)
        residual = [plus(row, -dot(row, direction), direction) for row in residual]
        residual[best] = [0.0] * len(direction)
    return chosen


def _array_pivoted(residual: np.ndarray, least: float, most: int) -> Pivoting:
    """Return what `pivoted` returns, by numpy; ``residual`` is the matrix, and is overwritten."""
    order, sizes, basis = list[int](), list[float](), np.empty((most, residual.shape[1]))
    for k in range(most):
        lengths = np.linalg.norm(residual, axis=1)
        best = int(np.argmax(lengths))
        if not lengths[best] > least:
            break
        direction = residual[best].copy()
        for _ in range(GRAM_SCHMIDT_PASSES):
            direction -= basis[:k].T @ (basis[:k] @ direction)
            size = float(np.linalg.norm(direction))
            if not size:
                return Pivoting(order, sizes, basis[:k].tolist())
            direction /= size
        order.append(best)
        sizes.append(float(lengths[best]))
        basis[k] = direction
        residual -= np.outer(residual @ direction, direction)
        residual[best] = 0.0
    return Pivoting(order, sizes, basis[: len(order)].tolist())


def rank(matrix: Matrix, least: float) -> int:
    """Return the numerical rank: the number of pivots (`pivoted`) above ``least``."""
    return len(pivoted(matrix, least).order)


def complement(basis: Matrix, n: int) -> list[list[float]]:
    """Return an orthonormal basis of the orthogonal complement in R^n of the span of an orthonormal ``basis``."""
    if basis and n * n > SMALL:
        columns: list[list[float]] = np.linalg.qr(np.array(basis).T, mode="complete")[0].T.tolist()
        return columns[len(basis) :]
    rows = []
    for i in range(n):
        row = [float(i == c) for c in range(n)]
        for direction in basis:
            row = plus(row, -direction[i], direction)
        rows.append(row)
    return pivoted(rows, most=n - len(basis)).basis


def singular_values(matrix: Matrix) -> list[float]:
    """Return the singular values in descending order.

    >>> singular_values([[3.0, 0.0], [0.0, -4.0]])
    [4.0, 3.0]
    """
    if not matrix or not matrix[0]:
        return []
    if len(matrix) * len(matrix[0]) > SMALL:
        return [float(v) for v in np.linalg.svd(np.array(matrix), compute_uv=False)]
    with ctx.workprec(BITS):
        rows = arb_mat([list(map(float, row)) for row in matrix])
        gram = rows * rows.transpose() if len(matrix) <= len(matrix[0]) else rows.transpose() * rows
        squares = acb_mat(gram).eig(algorithm="approx")
        return sorted((math.sqrt(max(0.0, float(v.real.mid()))) for v in squares), reverse=True)


def least_eigenvector(form: Matrix) -> tuple[float, list[float]]:
    """Return the least eigenvalue of a symmetric matrix and a unit eigenvector."""
    if len(form) ** 2 > SMALL:
        eigenvalues, vectors = np.linalg.eigh(np.array(form))
        return float(eigenvalues[0]), [float(v) for v in vectors[:, 0]]
    with ctx.workprec(BITS):
        squares, columns = acb_mat(arb_mat([list(map(float, row)) for row in form])).eig(right=True, algorithm="approx")
        place = min(range(len(form)), key=lambda i: float(squares[i].real.mid()))
        vector = [float(columns[i, place].real.mid()) for i in range(len(form))]
    size = length(vector)
    return float(squares[place].real.mid()), [v / size for v in vector]
