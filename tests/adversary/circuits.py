"""Exact drawings at special positions: what is redundant, and on what it depends."""

from __future__ import annotations

import random
from fractions import Fraction

from dofkit.benchmark.trials.construction import KnownScene, truths

from .frameworks import apart, cranks, crossed_lines, drawn, first_order, octahedron


def parallel_cranks(rng: random.Random, size: int) -> KnownScene:
    """Three equal parallel cranks A_i D_i on fixed pivots and D_0, D_1, D_2 linked each to each. To first order a
    D_i moves by m_i across its crank, and the links make the m_i equal: 1, and the parallel motion is that. The
    last link follows from all the others together: without a crank, a pivot or a link its two ends turn by
    themselves."""
    places, links, fixed = cranks(rng, 3)
    links = [*links, ("D0", "D2")]
    last = len(fixed) + len(links)
    first = first_order(places, links, fixed)
    known = truths(1, instantaneous_dof=first, singular=first != 1, redundant=[f"c{last}"], redundant_equations=1)
    known |= {f"c{last}.circuit": [f"c{k}" for k in range(1, last)]}
    return KnownScene(drawn(places, links, fixed), known)


def in_line(rng: random.Random, size: int) -> KnownScene:
    """k points on a line, each linked to each, in the plane or in space: since each length between is the sum of
    its parts they stay on a line, a rigid segment of 2 d - 1 freedoms; to first order they leave it."""
    k, d = 3 + min(size, 2), rng.choice((2, 3))
    direction = [rng.randint(-2, 2) for _ in range(d - 1)] + [1]
    steps = sorted(rng.sample(range(-5, 6), k))
    places = {f"P{i}": tuple(Fraction(s * c) for c in direction) for i, s in enumerate(steps)}
    links = [(f"P{i}", f"P{j}") for i in range(k) for j in range(i + 1, k)]
    dof = 2 * d - 1
    first = first_order(places, links)
    extra = max(0, len(links) - (k * d - dof))
    known = truths(dof, instantaneous_dof=first, singular=first != dof, redundant_equations=extra)
    return KnownScene(drawn(places, links), known)


def dixon(rng: random.Random, size: int) -> KnownScene:
    """K(m, n) on two perpendicular lines: the places on the lines move with 1 freedom at least, and with the 3
    motions of the plane that is 4; where the first-order freedom is 4 it is no more."""
    m, n = rng.choice(((3, 3), (3, 4), (4, 4), (3, 5))[: 1 + size])
    places, links = crossed_lines(rng, m, n)
    first = first_order(places, links)
    known = {"consistent": True, "instantaneous_dof": first}
    if first == 4:
        known |= {"dof": 4, "velocity_dof": 4, "singular": False, "redundant_equations": len(links) - (2 * (m + n) - 4)}
    return KnownScene(drawn(places, links), known)


def bricard(rng: random.Random, size: int) -> KnownScene:
    """Flexible octahedra: 7 at least by their symmetry, and no more where the first-order freedom is 7."""
    places, links = octahedron(rng, rng.random() < 0.5)
    while not apart(places):
        places, links = octahedron(rng, rng.random() < 0.5)
    first = first_order(places, links)
    known = {"consistent": True, "instantaneous_dof": first}
    if first == 7:
        known |= {"dof": 7, "velocity_dof": 7, "singular": False, "redundant_equations": 1}
    return KnownScene(drawn(places, links), known)


FAMILY = {"parallel-cranks": parallel_cranks, "in-line": in_line, "dixon": dixon, "bricard": bricard}
