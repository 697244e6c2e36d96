"""The manifold N on which the gradients of dependent relations vanish as far as their second order makes them.

On M let f_1, ..., f_k be the dependent relations, with Hessians H_i at the point. Rows of the H_i that are independent
give equations df_i/dx_j = 0 that can be solved for as many of M's coordinates: N, tangent to the common kernel. Where
all f_i vanish on N, it is a branch of the set on which every pose is singular. For one relation N is the critical
set of the splitting lemma [GromollMeyer1969]: f = Q(y) + g Q the second-order part and g the relation's values on N.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import nmod_mat

from dofkit.configuration.local.manifold import Form, Manifold, inverse, product
from dofkit.exact.points.frames import pivots
from dofkit.exact.points.series import Series, monomial
from dofkit.exact.ring.program import Scalar


@dataclass(frozen=True)
class Split:
    """``equations`` (function, column) whose linear parts are independent; M's coordinates ``solved`` and ``free``."""

    equations: tuple[tuple[int, int], ...]
    solved: tuple[int, ...]
    free: tuple[int, ...]


def split(forms: Sequence[Form]) -> Split:
    """A choice of equations and of coordinates that they determine, from forms over GF(p)."""
    m = len(forms[0])
    p = forms[0][0][0].modulus()
    rows = [(i, j) for i in range(len(forms)) for j in range(m)]
    columns = [[int(forms[i][j][c]) for i, j in rows] for c in range(m)]
    kept = pivots(nmod_mat(columns, p))
    chosen = [[int(forms[rows[a][0]][rows[a][1]][c]) for c in range(m)] for a in kept]
    solved = pivots(nmod_mat(chosen, p)) if chosen else []
    return Split(tuple(rows[a] for a in kept), tuple(solved), tuple(c for c in range(m) if c not in set(solved)))


def series_on_critical(
    manifold: Manifold, forms: Sequence[Form], parts: Split, direction: Sequence[Scalar], order: int
) -> list[Series]:
    """The dependent relations along the curve of N whose free coordinates are start + s direction."""
    frame = manifold.frame
    path = [Series(manifold.like + manifold.start[c], order) for c in frame.free]
    step = monomial(manifold.like)
    for value, c in zip(direction, parts.free, strict=True):
        path[c] = path[c] + Series(step * value, order)
    hessian = [[forms[i][j][c] * 2 for c in parts.solved] for i, j in parts.equations]
    back = inverse(hessian)
    used = sorted({i for i, _ in parts.equations})
    place = {i: a for a, i in enumerate(used)}
    for k in range(1, order if parts.solved else 1):
        curve = manifold.curve([s.truncated(k + 1) for s in path], k + 1)
        slopes = manifold.slopes(curve, [manifold.others[i] for i in used])
        wrong = [slopes[place[i]][j].coefficient(k) for i, j in parts.equations]
        for value, c in zip(product(back, wrong), parts.solved, strict=True):
            path[c] = path[c] - Series(step**k * value, order)
    curve = manifold.curve(path, order)
    return [curve.at[n] for n in manifold.others]
