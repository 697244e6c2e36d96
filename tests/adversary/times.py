"""Time: factors that never vanish, by little; homogeneous equations of any degree; time that cancels."""

from __future__ import annotations

import random
from fractions import Fraction

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

#: A function of x and t, minus its least value, and whether that is attained.
LOWEST: tuple[tuple[str, Fraction, bool], ...] = (
    ("x^4 - x*t + t^4", Fraction(1, 8), True),
    ("sin(x*t)", Fraction(1), True),
    ("sin(x + t)*cos(y)", Fraction(1), True),
    ("x^2 + t^2 - x*t", Fraction(0), True),
    ("exp(x*t)", Fraction(0), False),
    ("(x - t)/(1 + (x - t)^2)", Fraction(1, 2), True),
    ("x^2*t^2 - 2*x*t", Fraction(1), True),
    ("x^4*t^2 + x^2*t^4 - 3*x^2*t^2", Fraction(1), True),
    ("tanh(x - t)", Fraction(1), False),
    ("x^2 + x*t + t^2 + t", Fraction(1, 3), True),
    ("1/(1 + x^2*t^2)", Fraction(0), False),
)


def kept_factor(rng: random.Random, size: int) -> KnownScene:
    """(f(x, t) + c) (dx + y dz) = 0. Where f + c is positive it says dx + y dz = 0: scleronomic, non-holonomic.
    Where f + c has zeros, at which it changes its sign, time enters with them: rheonomic."""
    f, bound, attained = rng.choice(LOWEST)
    step = Fraction(1, 10 ** rng.randint(1, 1 + 3 * size))
    never = rng.random() < 0.7
    c = bound + (step if never else -step)
    if never and not attained and rng.random() < 0.3:
        c = bound
    text = f"({f} + {c})*(xdot + y*zdot) = 0" if rng.random() < 0.5 else f"({f} + {c})*dx + y*({f} + {c})*dz = 0"
    scene = scene_of("x y z", text)
    if never:
        known = truths(3, 2, holonomic=False, scleronomic=True)
        return KnownScene(scene, known, chart={"x": "p0", "y": "p1", "z": "p2"})
    return KnownScene(scene, {"scleronomic": False})


def homogeneous(rng: random.Random, size: int) -> KnownScene:
    """Homogeneous in the velocities, of any degree, and free of t: time does not enter. The cones a^k + b^k = c^k and
    sqrt(a^2 + b^2) = c, k odd or 2, have velocities of dimension 2 that span all three: non-holonomic."""
    k = rng.choice((3, 5, 7, 9, 11, 13))
    weight = rng.choice(("", "(1 + x^2)*", "exp(y)*"))
    text = rng.choice(
        (
            f"{weight}xdot^{k} + ydot^{k} = zdot^{k}",
            "sqrt(xdot^2 + ydot^2) = zdot",
            f"{weight}xdot^2 + ydot^2 = zdot^2",
            f"xdot^{k}/ydot^{k - 1} = {weight}zdot",
            f"(xdot^2 + ydot^2)^{k} = zdot^{2 * k}",
        )
    )
    return KnownScene(scene_of("x y z", text), truths(3, 2, holonomic=False, scleronomic=True))


def inhomogeneous(rng: random.Random, size: int) -> KnownScene:
    """Terms of different degrees in the velocities, without t: scleronomic. The velocities form a surface that is not
    flat: non-holonomic."""
    k = rng.choice((2, 3, 4, 5, 7))
    text = rng.choice(
        (
            f"xdot^{k} + ydot^{k} + zdot^{k} = 1",
            f"xdot^{k + 1} + ydot = zdot",
            f"zdot = xdot*ydot^{k}",
            "xdot^2 + ydot^2 = zdot",
        )
    )
    return KnownScene(scene_of("x y z", text), truths(3, 2, holonomic=False, scleronomic=True))


def cancelled(rng: random.Random, size: int) -> KnownScene:
    """Time that is written and does not enter."""
    one = rng.choice(
        (
            "(cos(t)^2 + sin(t)^2)",
            "((1 + t)^3 - t^3 - 3*t^2 - 3*t)",
            "(exp(t)*exp(-t))",
            "(cosh(t)^2 - sinh(t)^2)",
            "((1 + t^2)/(2 + 2*t^2)*2)",
            "(sqrt(1 + t^2)^2 - t^2)",
            "(log(exp(t)) - t + 1)",
        )
    )
    factor = rng.choice(("exp(t)", "(2 + sin(t))", "(1 + t^2)", "(x^2 + t^2 + 1/10^6)", "(x^4 - x*t + t^4 + 1/7)"))
    if rng.random() < 0.5:
        text, known = f"{factor}*({one}*xdot - y*zdot) = 0", truths(3, 2, holonomic=False, scleronomic=True)
        chart = {"x": "p0", "y": "p1", "z": "p2"}
    else:
        text, known = f"{factor}*(x^2*{one} - y) = 0", truths(2, holonomic=True, scleronomic=True)
        chart = {"x": "p0", "z": "p1", "y": "x^2"}
    return KnownScene(scene_of("x y z", text), known, chart=chart)
