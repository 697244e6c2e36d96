"""What holds over the reals only: factors without real zeros, sums of squares, odd powers, parts with no neighbours."""

from __future__ import annotations

import random

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import at, names, nonzero, polynomial, positive, smaller, smooth, substituted

#: Equations that say a = b over the reals, and no more.
SAME = (
    "a^3 = b^3",
    "a^5 + a = b^5 + b",
    "a^2 + b^2 = 2*a*b",
    "exp(a) = exp(b)",
    "(a - b)^2*(a^2 + b^2 + 1) = 0",
    "(a - b)*(a^2 + a*b + b^2 + 1) = 0",
    "a^4 + b^4 + 6*a^2*b^2 = 4*a^3*b + 4*a*b^3",
    "atan(a) = atan(b)",
    "(a - b)^4 + (a - b)^2 = 0",
    "exp(a - b) = 1",
    "(a - b)*(exp(a) + exp(b)) = 0",
    "abs(a - b) = 0",
    "sinh(a) = sinh(b)",
    "a^7 - b^7 + a - b = 0",
    "cosh(a - b) = 1",
    "(a - b)^2 + (a^3 - b^3)^2 = 0",
)


def _said(rng: random.Random, first: str, second: str) -> str:
    """One of them with other sides."""
    return substituted(rng.choice(SAME), {"a": f"({first})", "b": f"({second})"})


def disguised(rng: random.Random, size: int) -> KnownScene:
    """x = P(w) in a writing that says so over the reals only, and dz = (x - P) u dw, which is then dz = 0."""
    w = names("w", 1 + size // 2)
    p = smooth(rng, w) if size > 1 else polynomial(rng, w)
    formed = rng.random() < 0.5
    relations = [_said(rng, "x", p), *([f"zdot = (x - ({p}))*u*{w[0]}dot"] if formed else [])]
    free = [*w, *(["u"] if formed else [])]
    chart = {name: f"p{k}" for k, name in enumerate(free)} | {"x": p} | ({"z": "1"} if formed else {})
    scene = scene_of([*w, "x", *(["u", "z"] if formed else [])], *relations)
    return KnownScene(scene, truths(len(free), holonomic=True), chart=chart)


def squared_forms(rng: random.Random, size: int) -> KnownScene:
    """A sum of squares of forms is 0: all of them. dx - y dz and dw - c dz: the first is non-holonomic, the second not.
    On dw = c dz the freedom is 3 of 4 coordinates, with 2 velocities."""
    c = nonzero(rng)
    weight = positive(rng, ["x", "y"])
    text = f"{weight}*(xdot - y*zdot)^2 + {rng.randint(1, 5)}*(wdot - ({c})*zdot)^2 = 0"
    return KnownScene(scene_of("x y z w", text), truths(3, 2, scleronomic=True))


def isolated_points(rng: random.Random, size: int) -> KnownScene:
    """y^2 = x^2 (x - a) with a > 0: a curve for x >= a, and the point (0, 0) by itself. With no reference the curve
    counts; with the reference at the origin nothing moves."""
    a, k = rng.randint(1, 5), rng.choice((2, 4))
    there = rng.random() < 0.5
    scene = scene_of("x y", f"y^2 = x^{k}*(x - {a})", configuration=at({"x": 0, "y": 0}) if there else None)
    return KnownScene(scene, truths(0 if there else 1), {} if there else smaller(0))


def handles(rng: random.Random, size: int) -> KnownScene:
    """Whitney's umbrella x^2 = y^2 z: a surface, and for z < 0 the line x = y = 0 alone. Where the reference is there,
    the freedom is 1; dw = x du is dw = 0 there."""
    k, formed = rng.choice((2, 4, 6)), rng.random() < 0.5
    values = {"x": 0, "y": 0, "z": -rng.randint(1, 3)}
    relations = [f"x^{k} = y^{k}*z^{rng.choice((1, 3))}", *(["wdot = x*udot"] if formed else [])]
    values |= {"w": 0, "u": 0} if formed else {}
    chart = {"x": "0", "y": "0", "z": "-1 - p0", **({"w": "0", "u": "p1"} if formed else {})}
    known = truths(1 + formed, holonomic=True)
    return KnownScene(scene_of([*values], *relations, configuration=at(values)), known, chart=chart)
