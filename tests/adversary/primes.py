"""Numbers that vanish modulo primes in use: as integers they are not 0, and that is all that counts."""

from __future__ import annotations

import random

from dofkit.benchmark.trials.construction import IMPOSSIBLE, KnownScene, scene_of, truths
from dofkit.exact.points.field import prime_for


def primes(many: int) -> list[int]:
    """The first primes that a scene without angles or roots of numbers would be looked at with."""
    return [prime_for(1, (), seed) for seed in range(many)]


def number(rng: random.Random, size: int) -> str:
    """A product that holds every one of them, as text: each factor is short enough to be read."""
    factors = primes(rng.choice((1, 3, 3 + 3 * size)))
    powers = [f"{p}^{rng.choice((1, 1, 1 + size // 3))}".removesuffix("^1") for p in factors]
    return f"({'*'.join([*powers, *rng.choice(([], [], ['2'], ['30']))])})"


def growth(rng: random.Random, size: int) -> KnownScene:
    """dz = y dx, dw = (N u + z) dx: with X = d/dx + y d/dz + (N u + z) d/dw, [d/dy, X] = d/dz and [d/du, X] = N
    d/dw are independent of X, d/dy, d/du: growth 3, 5."""
    n = number(rng, size)
    scene = scene_of("x y u z w", "zdot = y*xdot", f"wdot = ({n}*u + z)*xdot")
    chart = {name: f"p{k}" for k, name in enumerate("xyuzw")}
    return KnownScene(scene, truths(5, 3, holonomic=False, growth_vector=[3, 5]), chart=chart)


def twisted(rng: random.Random, size: int) -> KnownScene:
    """dx + N y dz, and dz = (y/N) dx, and the like: non-holonomic for any N but 0."""
    n = number(rng, size)
    text = rng.choice(
        (
            f"xdot + {n}*y*zdot = 0",
            f"zdot = (y/{n})*xdot",
            f"xdot + (y^2 + {n}*y)*zdot = y^2*zdot",
            f"xdot = sin({n}*y)*zdot",
        )
    )
    chart = {name: f"p{k}" for k, name in enumerate("xyz")}
    return KnownScene(scene_of("x y z", text), truths(3, 2, holonomic=False, growth_vector=[2, 3]), chart=chart)


def closed(rng: random.Random, size: int) -> KnownScene:
    """d(x^2 y + N x) and its like, and what differs from it by a multiple of N: exact, or not."""
    n, exact = number(rng, size), rng.random() < 0.5
    slope = "x^2" if exact else f"(x^2 + {n}*x)"
    text = f"(2*x*y + {n})*xdot + {slope}*ydot = 0"
    return KnownScene(scene_of("x y", text), truths(1, holonomic=True, **{"c1.exact": exact}))


def solved(rng: random.Random, size: int) -> KnownScene:
    """Relations whose difference is a multiple of N: independent, or contradictory."""
    n = number(rng, size)
    circle = {"x": "10*p0/(1 + p0^2)", "y": "5*(1 - p0^2)/(1 + p0^2)", "z": "x"}
    rows: tuple[tuple[str, list[str], dict[str, str] | None], ...] = (
        ("x y z", ["x + y = z", f"x + {n}*y + y = z"], {"x": "p0", "y": "0", "z": "x"}),
        ("x y", ["x = y", f"x = y + {n}"], None),
        ("x", ["x = 1", f"x = {n} + 1"], None),
        ("x y z", ["x^2 + y^2 = 25", f"x^2 + y^2 + {n}*(z - x) = 25"], circle),
        ("x y z", [f"{n}*x = y", "y = z"], {"x": "p0", "y": f"{n}*x", "z": "y"}),
        ("x y z", ["x*y = 1", f"x*y + {n}*x*z = 1"], {"x": "p0", "y": "1/p0", "z": "0"}),
        ("x y z", [f"x = y/{n}", "x = z"], {"x": "p0", "y": f"{n}*x", "z": "x"}),
        ("x y", [f"x^2 + {n}*y^2 = {n}", f"2*{n}*y^2 + 2*x^2 = 2*{n} + 1"], None),
    )
    coordinates, relations, chart = rng.choice(rows)
    if chart is None:
        return KnownScene(scene_of(coordinates, *relations), IMPOSSIBLE)
    return KnownScene(scene_of(coordinates, *relations), truths(1, redundant=[], redundant_equations=0), chart=chart)
