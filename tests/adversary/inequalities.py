"""Inequalities by themselves, possible or not; and together, and with equations, feasible or not."""

from __future__ import annotations

import random
from fractions import Fraction

from dofkit.benchmark.trials.construction import IMPOSSIBLE, KnownScene, scene_of, truths

#: A function, its supremum, and whether it is attained.
HIGHEST: tuple[tuple[str, str, bool], ...] = (
    ("sin(x)", "1", True),
    ("cos(x)*sin(y)", "1", True),
    ("x/(1 + x^2)", "1/2", True),
    ("1/(1 + x^2)", "1", True),
    ("tanh(x)", "1", False),
    ("-exp(x)", "0", False),
    ("-abs(x)", "0", True),
    ("-(x^2 + y^2)", "0", True),
    ("-sqrt(x)", "0", True),
    ("x - x^2", "1/4", True),
    ("x^2/(1 + x^2)", "1", False),
    ("-(x^4*y^2 + x^2*y^4 - 3*x^2*y^2)", "1", True),
    ("2*x*y - x^2 - y^2", "0", True),
    ("-(exp(x) + exp(-x))", "-2", True),
    ("-(x^2 + 1/x^2)", "-2", True),
    ("sin(x)^2 + sin(y)^2", "2", True),
    ("x^3 - x^6", "1/4", True),
)


def alone(rng: random.Random, size: int) -> KnownScene:
    """f >= c, or f > c: possible below the supremum, at it where it is attained and the sign is not strict."""
    f, text, attained = rng.choice(HIGHEST)
    top, step = Fraction(text), Fraction(1, 10 ** rng.randint(0, 2 + 5 * size))
    where, strict = rng.choice((-1, 0, 1)), rng.random() < 0.5
    c = top + where * step
    possible = where < 0 or (where == 0 and attained and not strict)
    relation = (
        f"{f} {'>' if strict else '>='} {c}" if rng.random() < 0.5 else f"{c} - ({f}) {'<' if strict else '<='} 0"
    )
    coordinates = ["x", *(["y"] if "y" in f else [])]
    known = truths(len(coordinates), holonomic=False, scleronomic=True)
    known |= {"c1.form": "inequality", "c1.bilateral": False}
    return KnownScene(scene_of(coordinates, relation), known if possible else IMPOSSIBLE)


#: Inequalities with relations; whether all can be met; a freedom of the relations.
TOGETHER: tuple[tuple[str, tuple[str, ...], bool, int], ...] = (
    ("x", ("x > 1", "x < 0"), False, 1),
    ("x", ("x > 1", "x < 1 + 1/10^12"), True, 1),
    ("x", ("x >= 1", "x <= 1"), True, 1),
    ("x", ("x > 1", "x <= 1"), False, 1),
    ("x y", ("x^2 + y^2 = 1", "x >= 2"), False, 1),
    ("x y", ("x^2 + y^2 = 1", "x >= 1"), True, 1),
    ("x y", ("x^2 + y^2 = 1", "x > 1"), False, 1),
    ("x y", ("x^2 + y^2 = 1", "x >= 3/5", "y >= 4/5"), True, 1),
    ("x y", ("x^2 + y^2 = 1", "x >= 3/5", "y > 4/5"), False, 1),
    ("x y", ("x + y = 1", "x >= 0", "y >= 0"), True, 1),
    ("x y", ("x + y = -1", "x >= 0", "y >= 0"), False, 1),
    ("x y", ("x*y = 1", "x > 0", "y < 0"), False, 1),
    ("x y", ("y = x^2", "y < 0"), False, 1),
    ("x y", ("y = exp(x)", "y <= 0"), False, 1),
    ("x y", ("y = exp(x)", "y <= 1/10^6"), True, 1),
    ("x y z", ("x^2 + y^2 + z^2 = 1", "x + y + z >= 7/4"), False, 2),
    ("x y z", ("x^2 + y^2 + z^2 = 1", "x + y + z >= 1.7"), True, 2),
    ("x y z", ("dz = y*dx", "z >= 0"), True, 3),
)


def together(rng: random.Random, size: int) -> KnownScene:
    """Each inequality by itself can be met, so `consistent` is true; `feasible` says whether all can, with the
    relations. sqrt(3) lies between 1.7 and 7/4; 4/5 is the largest y on the circle with x >= 3/5."""
    coordinates, relations, feasible, dof = rng.choice(TOGETHER)
    velocities = dof - any(relation.startswith("dz") for relation in relations)
    return KnownScene(scene_of(coordinates, *relations), truths(dof, velocities, feasible=feasible, holonomic=False))
