"""Roots, absolute values and inverse functions: what holds on a region takes nothing away there."""

from __future__ import annotations

import random
from fractions import Fraction

from dofkit.benchmark.trials.construction import IMPOSSIBLE, KnownScene, scene_of, truths

from .draws import at, nonzero, positive, smaller

#: Relations in x (and y) that hold on a region, or everywhere, with a point within it: none takes a freedom away.
WITHIN = (
    ("sqrt(x^6) = x^3", {"x": 2}),
    ("sqrt(x^2) = x", {"x": 1}),
    ("sqrt(x^4) = x^2", {"x": -1}),
    ("abs(x) = x", {"x": 3}),
    ("abs(x) = -x", {"x": -3}),
    ("abs(x)^3 = x^3", {"x": 1}),
    ("sqrt((x - y)^2) = x - y", {"x": 3, "y": 1}),
    ("abs(x)*abs(y) = x*y", {"x": -2, "y": -3}),
    ("abs(x + y) = abs(x) + abs(y)", {"x": 2, "y": 1}),
    ("(x + y + abs(x - y))/2 = x", {"x": 5, "y": 2}),
    ("log(x^2) = 2*log(x)", {"x": 2}),
    ("exp(log(x)) = x", {"x": 2}),
    ("log(exp(x)) = x", {"x": -2}),
    ("asin(sin(x)) = x", {"x": 1}),
    ("acos(cos(x)) = x", {"x": 1}),
    ("acos(cos(x)) = -x", {"x": -1}),
    ("atan(tan(x)) = x", {"x": 1}),
    ("sqrt(x^2 + 2*x*y + y^2) = x + y", {"x": 2, "y": -1}),
    ("sqrt(x)^2 = x", {"x": 2}),
    ("abs(x - 1) + abs(x + 1) = 2", {"x": 0}),
    ("abs(abs(x) - 1) = 1 - x", {"x": Fraction(1, 2)}),
    ("sqrt(x^2*y^2) = x*y", {"x": 2, "y": 1}),
    ("(abs(x) - x)*(y^2 + 1) = 0", {"x": 1, "y": 5}),
    ("log(x*y) = log(x) + log(y)", {"x": 2, "y": 3}),
)


def empty_words(rng: random.Random, size: int) -> KnownScene:
    """The relation holds on a region: dof is the number of coordinates, and none of its equations is independent."""
    text, place = rng.choice(WITHIN)
    known = truths(len(place), redundant_equations=1, **{"c1.independent": 0})
    reference = at(place) if rng.random() < 0.4 else None
    chart = {c: f"({value}) + p{k}/100" for k, (c, value) in enumerate(place.items())}
    return KnownScene(scene_of([*place], text, configuration=reference), known, smaller(0, 1), chart)


def kinks(rng: random.Random, size: int) -> KnownScene:
    """sum w_i abs(x - a_i) = c with all w_i > 0 is convex and piecewise linear in x: it holds on an interval where
    c is the least value and that is taken on one, at points where c is the least value or more, nowhere where it is
    less."""
    places = sorted(rng.sample(range(-6, 7), 2 + rng.randint(0, size)))
    weights = [rng.randint(1, 3) for _ in places]
    values = {a: sum(w * abs(a - b) for w, b in zip(weights, places, strict=True)) for a in places}
    least = min(values.values())
    flat = sum(value == least for value in values.values()) > 1
    c = least + rng.choice((0, 0, 0, -1, 1, Fraction(1, 10**6)))
    left = " + ".join(f"{w}*abs(x - ({a}))" for w, a in zip(weights, places, strict=True))
    known = IMPOSSIBLE if c < least else truths(1 + (c == least and flat))
    return KnownScene(scene_of("x y", f"{left} = {c}"), known, smaller(1))


def repeated(rng: random.Random, size: int) -> KnownScene:
    """y = abs(x), and what follows from it: the second relation is redundant."""
    first, follows = rng.choice(
        (
            ("y = abs(x)", ("abs(y) = y", "y = sqrt(x^2)", "y^2 = x^2", "y*abs(y) = x^2", "abs(y) = abs(x)")),
            ("y = x^2 + 1", ("abs(y) = y", "sqrt(y^2) = y", "y = abs(x^2 + 1)", "sqrt(y)^2 = y")),
            ("y = exp(x)", ("abs(y) = y", "sqrt(y^2) = y", "abs(y) = exp(x)")),
            ("x = sin(y)^2", ("abs(x) = x", "sqrt(x^2) = x", "sqrt(x) = abs(sin(y))")),
        )
    )
    known = truths(1, redundant=["c2"], redundant_equations=1)
    scene = scene_of("x y", first, rng.choice(follows))
    return KnownScene(scene, known)


def sided(rng: random.Random, size: int) -> KnownScene:
    """dz = (abs(x) - x) y dw with the reference at x > 0: dz = 0 near it, dof 3, holonomic. At x < 0 it is dz = -2
    x y dw: non-holonomic, 4 and 3."""
    kink = rng.choice(("(abs(x) - x)", "(sqrt(x^2) - x)", "(sqrt(x^6) - x^3)", "(abs(x)*x - x^2)"))
    right = rng.random() < 0.5
    x = rng.randint(1, 4) * (1 if right else -1)
    values = {"x": x, "y": nonzero(rng), "z": 0, "w": 1}
    text = f"zdot = {kink}*y*{positive(rng, ['w', 'z'])}*wdot"
    known = truths(3, holonomic=True) if right else truths(4, 3, holonomic=False)
    more = {"instantaneous_dof": 3, "singular": False}
    return KnownScene(scene_of("x y z w", text, configuration=at(values)), {**known, **more})


def forced(rng: random.Random, size: int) -> KnownScene:
    """x = P > 0, so abs(x) - x and its like are 0: dz = 0, holonomic, wherever one looks."""
    value = rng.choice(("1 + u^2", "exp(u)", "2 + sin(u)", "u^4 + u^2 + 1/10", "cosh(u)"))
    kink = rng.choice(("(abs(x) - x)", "(sqrt(x^2) - x)", "(log(x^2) - 2*log(x))", "(abs(x)^3 - x^3)"))
    chart = {"u": "p0", "x": value, "w": "p1", "y": "p2", "z": "1"}
    scene = scene_of("u x y z w", f"x = {value}", f"zdot = {kink}*y*wdot")
    return KnownScene(scene, truths(3, holonomic=True), chart=chart)
