"""Multipliers of a dependent relation along a curve of the manifold M of independent ones: which of these it needs.

Where f vanishes on M, df = sum l_k dg_k at every point of M. With A(s) the derivatives of the g_k by the dependent
columns along a curve of M and b(s) those of f, the row l(s) solves l A = b; its coefficients follow one after another
from A at the point. A relation whose multiplier is 0 at the point need not have it 0 along the curve.
"""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.configuration.local.germ import random_direction
from dofkit.configuration.local.manifold import Manifold
from dofkit.exact.matrices.sparse import FactoredMatrix, SparseRow, transposed
from dofkit.exact.points.series import Series

#: Orders of the multipliers that are looked at.
ORDER = 4


def needed_along(field: Manifold, other: int) -> list[int]:
    """The numbers of the manifold's relations whose multipliers for the dependent one, ``other``, are not 0.

    Over GF(p), along a random curve, to an order. Raises NoValueError.
    """
    curve = field.line(random_direction(field), ORDER)
    columns = [field.columns[c] for c in field.frame.dependent]
    slopes = curve.slopes([*field.rows, other], columns)
    p = int(field.sample.modulus())
    orders = [[_sparse(row, k) for row in slopes[:-1]] for k in range(ORDER)]
    turned = FactoredMatrix(transposed(orders[0], len(columns)), p)
    found: list[list[int]] = []
    for k in range(ORDER):
        right = [int(v.coefficient(k)) for v in slopes[-1]]
        for j in range(1, k + 1):
            for row, factor in zip(orders[j], found[k - j], strict=True):
                for c, v in row.items():
                    right[c] = (right[c] - factor * v) % p
        found.append([int(v) for v in turned.solve(right)])
    return [field.frame.rows[i] for i in range(len(field.rows)) if any(row[i] for row in found)]


def _sparse(row: Sequence[Series], k: int) -> SparseRow:
    """The coefficients of s^k without zeros."""
    return {c: v for c, series in enumerate(row) if (v := int(series.coefficient(k)))}
