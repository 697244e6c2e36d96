"""Dependent relations that begin at some higher order, where two motions are in question: their initial forms.

On a plane across the motions of the whole let f_i begin with the binary form h_i of degree k_i. A curve of the set
[CurveSelection] leaves along a common zero of the h_i, so there is none where they have no common zero: over the
complex numbers a gcd of 1 says so, over the reals one h_i that is definite.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import reduce
from typing import NamedTuple

from flint import arb, arb_mat, arb_poly, nmod, nmod_mat, nmod_poly

from dofkit.base.deadline import check
from dofkit.configuration.local.manifold import Manifold
from dofkit.exact.points.series import Series

#: The order to which the relations are followed, and halvings of an interval on which a form's sign is looked for.
ORDER, HALVINGS = 12, 10


class InitialForms(NamedTuple):
    """On a plane spanned by two directions: the order at which each f_i begins, and the h_i known as polynomials.

    ``forms`` maps the number i of a relation to h_i(1, b) over GF(p), where f_i begins below the order followed.
    """

    plane: list[list[int]]
    orders: list[int]
    forms: dict[int, nmod_poly]


def initial_forms(field: Manifold) -> InitialForms:
    """The initial forms of the dependent relations on a random plane."""
    rng = random.Random("dofkit initial forms")
    plane = [[rng.choice((-1, 1)) * rng.randint(1, 9) for _ in range(field.dimension)] for _ in range(2)]
    along = _rows(field, plane)
    orders = [min(_order(row[i]) for row in along) for i in range(len(field.others))]
    known = [i for i, k in enumerate(orders) if k < ORDER]
    forms = {i: _interpolated([row[i].coefficient(orders[i]) for row in along[: orders[i] + 1]]) for i in known}
    return InitialForms(plane, orders, forms)


def have_no_common_zero(found: InitialForms) -> bool:
    """Have the h_i no common zero over the complex numbers but (0, 0)? Their gcd is 1, and not all vanish at (0, 1)."""
    if not found.forms:
        return False
    first, *others = found.forms.values()
    common = reduce(lambda a, b: a.gcd(b), others, first)
    return common.degree() == 0 and any(form.degree() == found.orders[i] for i, form in found.forms.items())


def definite_degree(ball: Manifold, found: InitialForms) -> int | None:
    """The degree of an h_i of even degree that has no real zero but (0, 0)."""
    definite = (k for i in found.forms if (k := found.orders[i]) % 2 == 0 and _definite(ball, found.plane, i, k))
    return next(definite, None)


def _rows(manifold: Manifold, plane: Sequence[Sequence[int]]) -> list[list[Series]]:
    """The dependent relations along d_1 + b d_2 for b = 0, 1, ..."""
    found = []
    for b in range(ORDER):
        check()
        direction = [manifold.sample + v + b * w for v, w in zip(*plane, strict=True)]
        found.append(manifold.follow(direction, ORDER))
    return found


def _order(series: Series) -> int:
    return next((k for k in range(ORDER) if series.coefficient(k) != 0), ORDER)


def _interpolated(values: Sequence[nmod]) -> nmod_poly:
    """The polynomial with the given values at 0, 1, ..."""
    p = values[0].modulus()
    nodes = nmod_mat([[pow(b, j, p) for j in range(len(values))] for b in range(len(values))], p)
    solved = nodes.solve(nmod_mat([[int(v)] for v in values], p))
    return nmod_poly([int(solved[j, 0]) for j in range(len(values))], p)


def _definite(ball: Manifold, plane: Sequence[Sequence[int]], number: int, k: int) -> bool:
    """Has the initial form of degree k of a dependent relation no real zero? True is certified."""
    values = []
    for b in range(k + 1):
        direction = [ball.sample + v + b * w for v, w in zip(*plane, strict=True)]
        values.append([ball.follow(direction, k + 1)[number].coefficient(k)])
    nodes = arb_mat([[arb(b) ** j for j in range(k + 1)] for b in range(k + 1)])
    solved = nodes.solve(arb_mat(values))
    form = [solved[j, 0] for j in range(k + 1)]
    return _without_zero(form) and _without_zero(form[::-1])


def _without_zero(form: Sequence[arb]) -> bool:
    """Does a polynomial not vanish on [-1, 1]? Intervals are halved until its Taylor series there excludes 0."""
    whole = arb_poly(form)
    pending = [(arb(0), arb(1), 0)]
    while pending:
        middle, radius, depth = pending.pop()
        first, *others = (abs(c) for c in whole(arb_poly([middle, radius])).coeffs() or [arb(0)])
        if first > sum(others, arb(0)):
            continue
        if depth == HALVINGS:
            return False
        half = radius / 2
        pending += [(middle - half, half, depth + 1), (middle + half, half, depth + 1)]
    return True
