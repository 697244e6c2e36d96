"""Sets on which what an elimination would divide by is 0 everywhere: they are not empty for that."""

from __future__ import annotations

import random

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .components import free
from .draws import names, nonzero, simple_zero, smaller


def bipartite(rng: random.Random, size: int) -> KnownScene:
    """Points A_i and B_j of the plane at the distances that (a_i, 0) and (0, b_j) have, the a_i and the b_j of
    different lengths. abs(A_i - B_j)^2 - abs(A_0 - B_j)^2 is one number for all j, so the B_j lie on a line across
    A_i - A_0, and the A_i on one across that; a_i -> sqrt(a_i^2 + c), b_j -> sqrt(b_j^2 - c) is all that moves with
    the 3 motions of the plane: 4."""
    m, n = 2, 3 + rng.randint(0, size // 2)
    if size and rng.random() < 0.5:
        m = 3
    a, b = (rng.sample(range(1, 12), many) for many in (m, n))
    coordinates = [f"{c}{k}" for k in range(m) for c in "xy"] + [f"{c}{k}" for k in range(n) for c in "uv"]
    relations = [f"(x{i} - u{j})^2 + (y{i} - v{j})^2 = {a[i] ** 2 + b[j] ** 2}" for i in range(m) for j in range(n)]
    rng.shuffle(relations)
    if rng.random() < 0.5:
        return KnownScene(scene_of([*coordinates, "r"], *relations, "r = x0*u1 + 1"), truths(4))
    return KnownScene(scene_of(coordinates, *relations), truths(4))


def across(rng: random.Random, size: int) -> KnownScene:
    """A vector of the plane, other than 0, and k vectors across it, each of a given length: all turn as one, by 1.
    Across two of them the determinant is 0."""
    k = 2 + rng.randint(0, size)
    r = rng.randint(1, 5)
    relations = [f"x^2 + y^2 = {r * r}"]
    relations += [f"u{j}^{p} + v{j}^{p} = {rng.randint(1, 9)}" for j, p in enumerate(rng.choices((2, 2, 4), k=k))]
    relations += [f"x*u{j} + y*v{j} = 0" for j in range(k)]
    coordinates = ["x", "y", *(f"{c}{j}" for j in range(k) for c in "uv")]
    rng.shuffle(relations)
    return KnownScene(scene_of(coordinates, *relations), truths(1))


def coinciding(rng: random.Random, size: int) -> KnownScene:
    """k points P_j of the plane, each at one distance r_j from A and from C. Where A = C: A, and an angle for each P_j:
    2 + k. Else the P_j lie on the line that halves AC across: 4, less for k >= 3."""
    k = 3 + rng.randint(0, 1 + size)
    r = rng.sample(range(1, 12), k)
    relations = [
        f"(u{j} - {x})^2 + (v{j} - {y})^2 = {d * d}" for j, d in enumerate(r) for x, y in (("a", "b"), ("x", "y"))
    ]
    chart = {"a": "p0", "b": "p1", "x": "p0", "y": "p1"}
    for j, d in enumerate(r):
        chart |= {
            f"u{j}": f"a + 2*{d}*p{j + 2}/(1 + p{j + 2}^2)",
            f"v{j}": f"b + {d}*(1 - p{j + 2}^2)/(1 + p{j + 2}^2)",
        }
    return KnownScene(scene_of([*chart], *relations), truths(2 + k), smaller(4), chart)


def forced(rng: random.Random, size: int) -> KnownScene:
    """s u = y v, s v = y w + e and y (y^2 + x^2 + 1) = e, where a sum of squares says x = a, s(a) = 0, and e = 0:
    so y = 0, and all u, v, w are free though each has an equation with a factor."""
    k, a = 1 + rng.randint(0, 1 + size), nonzero(rng)
    s = simple_zero(rng, "x", a)
    u, v, w = names("u", k), names("v", k), names("w", k)
    first = rng.choice((f"(x - ({a}))^2 + e^2 = 0", f"(x - ({a}))^4 + e^6 + (e - x + ({a}))^2 = 0"))
    relations = [
        first,
        *(f"{s}*{b} = y*{c}" for b, c in zip(u, v, strict=True)),
        *(f"{s}*{b} = y*{c} + e" for b, c in zip(v, w, strict=True)),
    ]
    relations.append("y*(y^2 + x^2 + 1) = e")
    rng.shuffle(relations)
    chart = {"x": str(a), "e": "0", "y": "0"} | free([*u, *v, *w])
    return KnownScene(scene_of([*chart], *relations), truths(3 * k), chart=chart)
