"""Where what a relation is divided by vanishes, or what is asked to be >= 0: what the relations say at that edge."""

from __future__ import annotations

import random

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import at

#: Functions of z that are nowhere negative, and where they vanish.
WEAK = (("(1 - cos(z))", "0"), ("z^2", "0"), ("(z - 1)^2", "1"), ("(1 + sin(z))", "-pi/2"), ("(z^4 + z^2)", "0"))
#: Relations that say u = 0.
ROOTS = ("exp({u}) = 1", "atan({u}) = 0", "log(1 + {u}) = 0", "asin({u}) = 0", "sqrt(1 + {u}) = 1", "(1 + {u})^3 = 1")


def powers(rng: random.Random, size: int) -> KnownScene:
    """xdot^k = +-p(z) ydot^k for an even k, where the weak p vanishes: x is constant, and y is free."""
    p, zero = rng.choice(WEAK)
    k, sign = 2 * rng.randint(1, 2 + size), rng.choice(("", "-"))
    scene = scene_of("x y z", f"xdot^{k} = {sign}{p}*ydot^{k}", f"z = {zero}")
    return KnownScene(scene, truths(1, redundant_equations=0, holonomic=True), chart={"x": "3", "y": "p0", "z": zero})


def rates(rng: random.Random, size: int) -> KnownScene:
    """A function of w^m (xdot + s ydot), where w = 0: it says nothing there."""
    u = f"w^{rng.randint(1, 1 + size)}*(xdot + s*ydot)"
    scene = scene_of("x y s w", rng.choice(ROOTS).format(u=f"({u})"), "w = 0")
    chart = {"x": "p0", "y": "p1", "s": "p2", "w": "0"}
    return KnownScene(scene, truths(3, redundant=["c1"], redundant_equations=1), chart=chart)


def ended(rng: random.Random, size: int) -> KnownScene:
    """abs(x) = z and z = -q for a definite form q in u and v, at the origin: the set is the origin and what is free."""
    a, b = rng.randint(1, 3 + size), rng.choice(("u^2 + v^2", "u^2 + (u + v)^2", "u^2 + u*v + v^2", "u^4 + v^2"))
    scene = scene_of("x z u v w", f"abs({a}*x) = z", f"z = -({b})", configuration=at(dict.fromkeys("xzuvw", 0)))
    chart = dict.fromkeys("xzuv", "0") | {"w": "p0"}
    return KnownScene(scene, truths(1), chart=chart)


def inside(rng: random.Random, size: int) -> KnownScene:
    """abs(u) = z for a form u in x and y, at the origin, and a line on which u changes: half of it, twice."""
    a, b = rng.randint(1, 3 + size), rng.randint(1, 3 + size)
    c, d = rng.randint(1, 3), rng.choice((-7, 7))
    scene = scene_of("x y z", f"abs({a}*x + {b}*y) = z", f"y = {d * c}*x", configuration=at(dict.fromkeys("xyz", 0)))
    slope = abs(a + b * d * c)
    return KnownScene(scene, truths(1), chart={"x": "p0^2", "y": f"{d * c}*x", "z": f"{slope}*x"})


FAMILY = {"powers": powers, "rates": rates, "ended": ended, "inside": inside}
