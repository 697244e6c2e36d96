"""Forms whose coefficients vanish where other relations hold: those relations belong to the circuit."""

from __future__ import annotations

import random

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import names, positive


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


FAMILY = {"followed": followed, "on-a-curve": on_a_curve, "halved": halved}
