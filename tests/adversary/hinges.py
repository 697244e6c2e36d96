"""Closed loops of bodies in space at special positions: a joint of which some equations follow is not redundant."""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations, pairwise
from typing import Any

from flint import fmpq, fmpq_mat

from dofkit.benchmark.trials.construction import KnownScene, truths
from dofkit.benchmark.trials.frameworks import exact_rank

from .draws import names, nonzero


def revolute(first: str, second: str, at: Sequence[Any], axis: Sequence[Any]) -> dict[str, Any]:
    return {"type": "revolute", "between": [first, second], "at": [*map(str, at)], "axis": [*map(str, axis)]}


def _loop(bodies: Sequence[str], joints: Sequence[tuple[Sequence[Any], Sequence[Any]]]) -> dict[str, Any]:
    """The ground, the bodies in order, and the ground again, joined by hinges at places along axes."""
    ring = ["ground", *bodies, "ground"]
    made = [revolute(a, b, *joint) for a, b, joint in zip(ring, ring[1:], joints, strict=False)]
    return {"bodies": [*bodies], "constraints": made}


def _signs(form: Sequence[Sequence[Fraction]]) -> tuple[int, int]:
    """Return how many eigenvalues of a symmetric matrix are positive and negative: all are real, so Descartes' rule
    of signs is exact for the characteristic polynomial."""
    characteristic = list(fmpq_mat([[fmpq(v.numerator, v.denominator) for v in row] for row in form]).charpoly())
    return _changes(characteristic), _changes([c * (-1) ** k for k, c in enumerate(characteristic)])


def _changes(coefficients: Sequence[fmpq]) -> int:
    signs = [c > 0 for c in coefficients if c != 0]
    return sum(a != b for a, b in pairwise(signs))


def _kernel(first: Sequence[Fraction], second: Sequence[Fraction]) -> list[list[Fraction]]:
    """Return a basis of the vectors across both of two independent ones."""
    n = len(first)
    i, j = next((i, j) for i, j in combinations(range(n), 2) if first[i] * second[j] != first[j] * second[i])
    det = first[i] * second[j] - first[j] * second[i]
    rows = []
    for k in set(range(n)) - {i, j}:
        row = [Fraction(c == k) for c in range(n)]
        row[i] = (first[j] * second[k] - first[k] * second[j]) / det
        row[j] = (first[k] * second[i] - first[i] * second[k]) / det
        rows.append(row)
    return rows


def flat_vertex(rng: random.Random, size: int) -> KnownScene:
    """k hinges through a point with axes a_i in one plane, in this order round the loop: to first order sum r_i a_i
    = 0, k - 2 freedoms; to second order the component across the plane is sum over i < j of r_i r_j det(a_i, a_j) =
    0. Where that form is not degenerate there and has both signs, the set is a cone of dimension k - 3 (the third
    equation is regular off the point); where it has one sign nothing moves. No hinge is redundant as a whole: an
    open chain of k - 1 hinges has k - 1 freedoms."""
    while True:
        k = 3 + rng.randint(0, 1 + size // 2)
        plane = [(Fraction(nonzero(rng, 3)), Fraction(rng.randint(-3, 3))) for _ in range(k)]
        if exact_rank(plane) < 2:
            continue
        kernel = _kernel([a[0] for a in plane], [a[1] for a in plane])
        cross = [[Fraction(0)] * k for _ in range(k)]
        for i, j in combinations(range(k), 2):
            cross[i][j] = cross[j][i] = plane[i][0] * plane[j][1] - plane[i][1] * plane[j][0]
        form = [
            [sum((u[a] * cross[a][b] * v[b] for a in range(k) for b in range(k)), Fraction(0)) for v in kernel]
            for u in kernel
        ]
        plus, minus = _signs(form)
        if plus + minus == len(kernel):
            break
    dof = k - 3 if plus and minus else 0
    bodies = names("b", k - 1)
    tilt = rng.choice(((1, 0, 0), (0, 1, 1), (1, 2, 2)))
    axes = [(a[0], a[1], 0) if tilt[1] == 0 else (a[0], a[1], a[1]) for a in plane]
    at = rng.choice(([0, 0, 0], [rng.randint(-2, 2) for _ in range(3)]))
    scene = {"dimension": 3, **_loop(bodies, [(at, axis) for axis in axes])}
    known = truths(dof, instantaneous_dof=k - 2, singular=dof != k - 2, redundant=[])
    return KnownScene(scene, known | {"redundant_equations": 5 * k - (6 * (k - 1) - dof)})


def planar_loop(rng: random.Random, size: int) -> KnownScene:
    """k parallel hinges at the corners of a polygon: k - 3 freedoms, regular where the corners are not on one line.
    On one line, to first order sum r_i = sum r_i x_i = 0, k - 2 freedoms, and to second order sum over i < j of r_i
    r_j (x_j - x_i) = 0 across: one sign where a bar is as long as the others together, and then nothing moves."""
    k, line = 4 + rng.randint(0, size // 2), rng.random() < 0.5
    xs = sorted(rng.sample(range(0, 12), k)) if line else rng.sample(range(-5, 6), k)
    places = [(x, 0 if line else x * x, 0) for x in xs]
    dof = 0 if line else k - 3
    scene = {"dimension": 3, **_loop(names("b", k - 1), [(place, (0, 0, 1)) for place in places])}
    first = k - 2 if line else k - 3
    known = truths(dof, instantaneous_dof=first, singular=line, redundant_equations=5 * k - (6 * (k - 1) - dof))
    return KnownScene(scene, known)
