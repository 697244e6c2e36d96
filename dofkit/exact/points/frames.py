"""Codistributions at a point: rows of one-forms, the pivots by which they are solved, ranks and kernels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, arb_mat

from dofkit.base.deadline import check
from dofkit.base.errors import PoleError
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import Pivots, rank_of, sparse, sparse_frame
from dofkit.exact.points.series import Series
from dofkit.exact.residues import Residue, modulus, residue_matrix
from dofkit.exact.ring.program import Scalar, raising_no_value
from dofkit.exact.ring.ring import Ring


@dataclass(frozen=True)
class FormRows:
    """One-forms over a ring: ``entries[a]`` maps the columns of the a-th form to the nodes of its coefficients.

    ``columns`` are the generator indices of the symbols (coordinates, then time if it occurs), -1 for a symbol that
    occurs in no coefficient.
    """

    ring: Ring
    entries: tuple[dict[int, int], ...]
    columns: tuple[int, ...]

    def matrix(self, at: Sequence[Scalar], zero: Scalar) -> list[list[Scalar]]:
        """Return the matrix (forms x columns) of the coefficients' values, given the nodes' values ``at`` a point."""
        n = len(self.columns)
        return [[at[row[c]] if c in row else zero for c in range(n)] for row in self.entries]


def field_frame(matrix: list[list[Residue]], n: int, p: int) -> Pivots:
    """Return the first independent rows of a dense matrix, and the columns to solve them for (later ones preferred)."""
    return sparse_frame(sparse(matrix), n, p)


def kernel(matrix: list[list[Scalar]], frame: Pivots, zero: Scalar) -> list[list[Scalar]]:
    """Return a basis of the kernel of the frame's rows: one vector for each free column."""
    n, r = len(frame.dependent) + len(frame.free), len(frame.rows)
    solved = solve([[matrix[a][c] for c in frame.dependent] for a in frame.rows],
                   [[-matrix[a][c] for c in frame.free] for a in frame.rows])  # fmt: skip
    vectors = []
    for j, f in enumerate(frame.free):
        vector = [zero] * n
        vector[f] = zero + 1
        for i in range(r):
            vector[frame.dependent[i]] = solved[i][j]
        vectors.append(vector)
    return vectors


@raising_no_value
def solve(a: list[list[Scalar]], b: list[list[Scalar]]) -> list[list[Scalar]]:
    """Return a^-1 b for matrices of scalars or series; raises PoleError if no invertible pivot is found."""
    n = len(a)
    if n and isinstance(a[0][0], Residue) and b[0]:
        p = modulus(a[0][0])
        matrix, right = (residue_matrix([[int(v) for v in row] for row in side], p) for side in (a, b))
        solution = matrix.solve(right)
        return [[solution[i, j] for j in range(len(b[0]))] for i in range(n)]
    if n and isinstance(a[0][0], arb) and b[0]:
        balls = arb_mat(a).solve(arb_mat(b))
        return [[balls[i, j] for j in range(len(b[0]))] for i in range(n)]
    return _eliminate([list(row) + list(right) for row, right in zip(a, b, strict=True)], n)


def _eliminate(work: list[list[Any]], n: int) -> list[list[Any]]:
    """Return a^-1 b from the rows of (a, b), which are overwritten; n is the size of a."""
    for c in range(n):
        check()
        entries = ((r, work[r][c]) for r in range(c, n))
        pivot = next((r for r, v in entries if (v.invertible if isinstance(v, Series) else v != 0)), None)
        if pivot is None:
            raise PoleError("no pivot")
        work[c], work[pivot] = work[pivot], work[c]
        inverse = 1 / work[c][c]
        work[c] = [*work[c][: c + 1], *(v * inverse for v in work[c][c + 1 :])]
        for r in range(n):
            if r != c:
                factor = work[r][c]
                if not (isinstance(factor, Series) and factor.poly.degree() < 0):
                    work[r][c + 1 :] = [v - factor * w for v, w in zip(work[r][c + 1 :], work[c][c + 1 :], strict=True)]
    return [row[n:] for row in work]


def rank_over(vectors: Sequence[Sequence[Scalar]], sample: Scalar) -> int:
    """Return the rank over GF(p), or a certified lower bound for balls; ``sample`` is any number of that type."""
    return rank_of(vectors, modulus(sample)) if isinstance(sample, Residue) else ball_part(vectors).rank


def vanishes(value: Scalar) -> bool:
    """Return whether a value is 0 over GF(p), or is a ball that contains 0."""
    return bool(value.contains(0)) if isinstance(value, arb) else bool(value == 0)


def pairing(row: Sequence[Scalar], vectors: Sequence[Sequence[Scalar]]) -> list[Scalar]:
    """Return the values of a one-form ``row`` on each of the vectors."""
    return [sum(a * v for a, v in zip(row, vector, strict=True)) for vector in vectors]
