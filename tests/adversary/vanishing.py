"""What a relation or a form is divided by vanishes on the set, or what is asked to be >= 0 ends: what is said there."""

from __future__ import annotations

import random

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import at, names, positive

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


def followed(rng: random.Random, size: int) -> KnownScene:
    """x = 0, y_i = 0 and dx = sum y_i w_i dz_i, w_i never 0: the form says nothing new, and it takes all of the
    relations, since without one a dz_i is left, or dx. The z_i are free: nothing integrates."""
    k = 1 + rng.randint(0, size)
    y, z = names("y", k), names("z", k)
    weights = [positive(rng, [*z, "x"]) for _ in range(k)]
    form = "dx = " + " + ".join(
        f"{a}{rng.choice(('', '', '^2', '^3'))}*{w}*d{b}" for a, w, b in zip(y, weights, z, strict=True)
    )
    relations = ["x = 0", *(f"{a} = 0" for a in y)]
    last = f"c{k + 2}"
    known = truths(k, redundant=[last], redundant_equations=1, holonomic=True)
    more = {f"{last}.circuit": [f"c{i + 1}" for i in range(k + 1)], f"{last}.integral": None, f"{last}.holonomic": True}
    chart = {"x": "0"} | dict.fromkeys(y, "0") | {name: f"p{i}" for i, name in enumerate(z)}
    return KnownScene(scene_of(["x", *y, *z], *relations, form), {**known, **more}, chart=chart)


def on_a_curve(rng: random.Random, size: int) -> KnownScene:
    """The same where x = P(u) and s = Q(u): dx - P' du = (s - Q)^m w dz; the circuit is both relations."""
    m = rng.randint(1, 1 + size)
    p, slope = rng.choice((("u^2", "2*u"), ("sin(u)", "cos(u)"), ("exp(u)", "exp(u)"), ("u^3 + u", "(3*u^2 + 1)")))
    q = rng.choice(("u", "u^2", "cos(u)", "1/(1 + u^2)"))
    form = f"xdot - {slope}*udot = (s - {q})^{m}*{positive(rng, ['z', 'u'])}*zdot"
    known = truths(2, redundant=["c3"], redundant_equations=1, holonomic=True)
    more = {"c3.circuit": ["c1", "c2"], "c3.integral": None}
    chart = {"u": "p0", "z": "p1", "x": p, "s": q}
    return KnownScene(scene_of("u x s z", f"x = {p}", f"s = {q}", form), {**known, **more}, chart=chart)


def halved(rng: random.Random, size: int) -> KnownScene:
    """y = 0 and dx = y w dz + dv: the form is d(x - v) on the set, new and holonomic."""
    w = positive(rng, ["z", "v"])
    y, m = (
        rng.choice((("y", "0"), ("(y - v^2)", "v^2"), ("(y - sin(v))", "sin(v)"), ("(y*(y^2 + 1))", "0"))),
        rng.randint(1, 1 + size),
    )
    scene = scene_of("x y z v", f"{y[0]} = 0", f"dx = {y[0]}^{m}*{w}*dz + dv")
    known = truths(2, redundant=[], redundant_equations=0, holonomic=True, **{"c2.holonomic": True})
    chart = {"v": "p0", "z": "p1", "x": "v + 3", "y": y[1]}
    return KnownScene(scene, known, chart=chart)
