"""Products of many branches of which one is larger: finite, hidden behind a form, and of forms."""

from __future__ import annotations

import random

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import at, nonzero, smaller


def _points(rng: random.Random, many: int) -> list[str]:
    """Factors that are 0 at one point of the y-z-plane each, or nowhere."""
    chosen = rng.sample(range(-12, 13), many)
    table = (
        "((y - {0})^2 + (z - {1})^2)",
        "((y - {0})^4 + (z + {1})^2)",
        "(y^2 + (z - {1})^2 + 1)",
        "(exp(y) + {1}^2)",
    )
    return [rng.choice(table[:2] if rng.random() < 0.8 else table).format(k, k * k) for k in chosen]


#: Curves of the y-z-plane.
CURVES = (
    ("(y^5 + z^3 + 5)", None),
    ("(z - y^3 - 1)", {"y": "p0", "z": "y^3 + 1"}),
    ("(y*z - 7)", {"y": "p0", "z": "7/y"}),
    ("(y^2 + z^2 - 50)", None),
    ("(exp(y) - z)", {"y": "p0", "z": "exp(y)"}),
    ("(sin(y) - z)", {"y": "p0", "z": "sin(y)"}),
)


def hidden(rng: random.Random, size: int) -> KnownScene:
    """x = 0 and dx = P dt with P a product: P = 0 is hidden. One factor is 0 on a curve, the others at points: dof
    1."""
    curve, chart = rng.choice(CURVES)
    factors = [curve, *_points(rng, rng.randint(1, 2 + 4 * size))]
    rng.shuffle(factors)
    scene = scene_of("x y z", "x = 0", f"xdot = {'*'.join(factors)}")
    return KnownScene(scene, truths(1, holonomic=True), smaller(0), chart and {"x": "0", **chart})


def of_forms(rng: random.Random, size: int) -> KnownScene:
    """A product of forms, of which one is non-holonomic (dof 3) and the others d(a x + b y + c z) (dof 2)."""
    flat = {f"(xdot + ({nonzero(rng)})*ydot + ({nonzero(rng)})*zdot)" for _ in range(rng.randint(1, 2 + 3 * size))}
    factors = [*sorted(flat), rng.choice(("(zdot - y*xdot)", "(xdot + z*ydot)", "(cos(z)*ydot - sin(z)*xdot)"))]
    rng.shuffle(factors)
    scene = scene_of("x y z", f"{'*'.join(factors)} = 0")
    return KnownScene(scene, truths(3, 2), smaller(2))


def spaces(rng: random.Random, size: int) -> KnownScene:
    """A product of linear spaces of different dimension, each a sum of squares, disjoint where it matters: the
    largest."""
    letters = ["u", "v", "w", "y", "z"][: 3 + min(size, 2)]
    drawn = [rng.sample(letters, rng.randint(2, len(letters))) for _ in range(2 + size)]
    factors = ["(" + " + ".join(f"({c} - {rng.randint(-9, 9)})^2" for c in some) + ")" for some in drawn]
    least = min(map(len, drawn))
    n = len(letters)
    elsewhere = {key: sorted({n - len(some) for some in drawn}) for key in ("dof", "velocity_dof")}
    return KnownScene(scene_of(letters, f"{'*'.join(factors)} = 0"), truths(n - least, holonomic=True), elsewhere)


def at_reference(rng: random.Random, size: int) -> KnownScene:
    """A product of linear spaces with the reference on one only: its dimension."""
    letters = ["u", "v", "w", "y"]
    some = rng.sample(letters, rng.randint(1, 3))
    place = {c: rng.randint(-9, 9) for c in letters}
    own = " + ".join(f"({c} - ({place[c]}))^2" for c in some)
    others = [f"({rng.choice(letters)} - {10 + k})" for k in range(1 + size)]
    factors = [f"({own})" if len(some) > 1 else f"({some[0]} - ({place[some[0]]}))", *others]
    rng.shuffle(factors)
    scene = scene_of(letters, f"{'*'.join(factors)} = 0", configuration=at(place))
    return KnownScene(scene, truths(4 - len(some), holonomic=True))
