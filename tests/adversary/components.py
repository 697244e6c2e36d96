"""Sets with parts of different dimension: the freedom is that of the largest, wherever a search happens to land."""

from __future__ import annotations

import random
from collections.abc import Sequence
from itertools import combinations, product
from math import comb

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import names, polynomial, simple_zero, smaller, smooth


def graph(names_: Sequence[str], values: Sequence[str]) -> dict[str, str]:
    return dict(zip(names_, values, strict=True))


def free(names_: Sequence[str]) -> dict[str, str]:
    """A parameter for each."""
    return {name: f"p{i}" for i, name in enumerate(names_)}


def factored(rng: random.Random, factors: int) -> tuple[int, str]:
    """The largest zero of a product of functions of x with simple zeros (all are defined there), and the product."""
    zeros = sorted(rng.sample(range(-4, 12), factors), reverse=True)
    return zeros[0], "*".join(simple_zero(rng, "x", a) for a in zeros)


def ladder(rng: random.Random, size: int) -> KnownScene:
    """y = s(x) P(u), s(x) v_i = y Q_i(u, v_1, ..., v_i-1): off s = 0 it is the graph v_i = P Q_i over (x, u), of
    dimension 2; on s = 0 it says y = 0, and u with all of the v are free: 1 + k, the larger for k >= 2."""
    k = rng.randint(2, 2 + 3 * size)
    v = names("v", k)
    a, s = factored(rng, 1 + size // 2)
    relations = [f"y = {s}*({smooth(rng, ['u'])})"]
    relations += [f"{s}*{v[i]} = y*({smooth(rng, ['u', *v[:i]])})" for i in range(k)]
    chart = {"x": str(a), "y": "0"} | free(["u", *v])
    return KnownScene(scene_of(["x", "y", "u", *v], *relations), truths(1 + k), smaller(2), chart)


def unions(rng: random.Random, size: int) -> KnownScene:
    """f_i g_j = 0 for all i, j says f = 0 or g = 0, with f_i = u_i - P_i(w), g_j = v_j - Q_j(w): two graphs, of
    codimensions m <= k; the smaller codimension counts."""
    m = rng.randint(1, 2 + size // 2)
    k = m + rng.randint(0, 2 + size // 2)
    u, v, w = names("u", m), names("v", k), names("w", 1 + size // 2)
    first, second = ([smooth(rng, w) for _ in some] for some in (u, v))
    relations = [
        f"({a} - ({f}))*({b} - ({g})) = 0"
        for (a, f), (b, g) in product(zip(u, first, strict=True), zip(v, second, strict=True))
    ]
    rng.shuffle(relations)
    n = m + k + len(w)
    elsewhere = smaller(n - k)
    return KnownScene(scene_of([*u, *v, *w], *relations), truths(n - m), elsewhere, free([*w, *v]) | graph(u, first))


def minors(rng: random.Random, size: int) -> KnownScene:
    """The 2 x m matrices of rank 1 or 0, b = c a: irreducible, of dimension m + 1, with m(m-1)/2 relations."""
    m = 3 + size
    a, b = names("a", m), names("b", m)
    relations = [f"{a[i]}*{b[j]} = {a[j]}*{b[i]}" for i, j in combinations(range(m), 2)]
    rng.shuffle(relations)
    chart = free(a) | {name: f"{other}*p{m}" for name, other in zip(b, a, strict=True)}
    return KnownScene(
        scene_of([*a, *b], *relations), truths(m + 1, redundant_equations=comb(m, 2) - (m - 1)), chart=chart
    )


def empty_part(rng: random.Random, size: int) -> KnownScene:
    """The ladder over a factor s without real zeros: what is left is the graph v_i = u Q_i over (x, u), of dimension 2.

    x^4 + x + 1 and x^6 - x + 1 are positive: each is at least 1 - 3/4^(4/3) > 0.
    """
    v = names("v", 2 + size)
    s = rng.choice(("(x^2 + 1)", "(x^4 + x + 1)", "exp(x)", "(2 + sin(x))", "(x^2 + u^2 + 1/100)", "(x^6 - x + 1)"))
    values = [polynomial(rng, ["u", *v[:i]]) for i in range(len(v))]
    relations = [f"y = {s}*u", *(f"{s}*{a} = y*({value})" for a, value in zip(v, values, strict=True))]
    chart = free(["x", "u"]) | {"y": f"{s}*u"} | graph(v, [f"u*({value})" for value in values])
    return KnownScene(scene_of(["x", "y", "u", *v], *relations), truths(2), chart=chart)


def form_on_the_larger(rng: random.Random, size: int) -> KnownScene:
    """The ladder, and dz = s(x) dq: on s = 0, of dimension 1 + k with z and q, it says dz = 0: k + 2, and k >= 3 makes
    it the larger; on the graph it is non-holonomic: 4 coordinates, 3 velocities."""
    k = 3 + rng.randint(0, 1 + size)
    v = names("v", k)
    a, s = factored(rng, 1)
    relations = [f"y = {s}*u", *(f"{s}*{v[i]} = y*({polynomial(rng, ['u', *v[:i]])})" for i in range(k))]
    chart = {"x": str(a), "y": "0", "z": "3"} | free(["u", *v, "q"])
    scene = scene_of(["x", "y", "u", *v, "z", "q"], *relations, f"zdot = {s}*qdot")
    return KnownScene(scene, truths(k + 2), {"dof": [4], "velocity_dof": [3]}, chart)
