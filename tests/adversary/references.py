"""References on each part of a set, and forms that say different things there: the answer is that of the reference."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import at, names, nonzero, positive, simple_zero

Point = tuple[Fraction, Fraction]


def _ladder(rng: random.Random, k: int, rational: bool) -> tuple[int, str, list[str], list[int]]:
    """y = s(x) u, s v_i = y c_i v_i-1 (v_0 = u): a zero of s, s, the relations, and the c_i."""
    a, c = rng.randint(-3, 9), [nonzero(rng, 3) for _ in range(k)]
    s, v = simple_zero(rng, "x", a, rational=rational), ["u", *names("v", k)]
    return a, s, [f"y = {s}*u", *(f"{s}*{v[i + 1]} = y*({c[i]})*{v[i]}" for i in range(k))], c


def on_the_larger(rng: random.Random, size: int) -> KnownScene:
    """The reference has s(x) = y = 0 and v_1 other than c_1 u^2, so it is not on the closure of the graph off s = 0:
    dy - s' u dx and s' v_1 dx - c_1 u dy are independent there, and all other rows lie in their span. x and y are
    fixed, u, v_1, ..., v_k free. A form dz = s(x) w dq says dz = 0 there: holonomic, with q and w free."""
    k, formed = rng.randint(1, 2 + 2 * size), rng.random() < 0.6
    a, s, relations, c = _ladder(rng, k, rational=False)
    v, u = names("v", k), nonzero(rng, 3)
    values = {"x": a, "y": 0, "u": u, "v1": c[0] * u * u + nonzero(rng, 4)}
    values |= {name: rng.randint(-4, 4) for name in v[1:]}
    forms = [f"zdot = {s}*w*qdot"] if formed else []
    values |= {"z": nonzero(rng), "w": nonzero(rng), "q": nonzero(rng)} if formed else {}
    dof = 1 + k + 2 * formed
    known = truths(dof, instantaneous_dof=dof, singular=False, holonomic=True)
    chart = {"x": str(a), "y": "0", **({"z": "2"} if formed else {})}
    chart |= {name: f"p{i}" for i, name in enumerate(["u", *v, *(["w", "q"] if formed else [])])}
    return KnownScene(scene_of([*values], *relations, *forms, configuration=at(values)), known, chart=chart)


def on_the_smaller(rng: random.Random, size: int) -> KnownScene:
    """The reference has s(x) not 0: there v_i = c_1 ... c_i u^(i+1), the graph over (x, u), of dimension 2,
    whatever the part s = 0 is like. A form dz = s(x) dq is non-holonomic there: 4 coordinates, 3 velocities."""
    k, formed = rng.randint(2, 2 + 2 * size), rng.random() < 0.6
    a, s, relations, c = _ladder(rng, k, rational=True)
    x, u = a + rng.choice((-2, -1, 1, 2)), nonzero(rng, 2)
    values = {"x": Fraction(x), "y": _value(s, x) * u, "u": Fraction(u)}
    for i in range(k):
        values[f"v{i + 1}"] = c[i] * u * (values[f"v{i}"] if i else Fraction(u))
    forms = [f"zdot = {s}*qdot"] if formed else []
    values |= {"z": Fraction(1), "q": Fraction(2)} if formed else {}
    dof, velocities = (4, 3) if formed else (2, 2)
    known = truths(dof, velocities, instantaneous_dof=velocities, singular=False, holonomic=not formed)
    chart = {"x": "p0", "u": "p1", "y": f"{s}*u"}
    chart |= {f"v{i + 1}": f"({c[i]})*u*{f'v{i}' if i else 'u'}" for i in range(k)}
    chart |= {"z": "p2", "q": "p3"} if formed else {}
    return KnownScene(scene_of([*values], *relations, *forms, configuration=at(values)), known, chart=chart)


def _value(s: str, x: int) -> Fraction:
    """The value of one of the rational functions of `simple_zero`, whose zero is written in it."""
    shift = Fraction(x) - Fraction(s.split(" - (", 1)[1].split(")", 1)[0])
    table: list[tuple[bool, Callable[[], Fraction]]] = [
        ("^3" in s, lambda: shift**3 + shift),
        ("*(" in s, lambda: shift * (x * x + 1)),
        ("/(" in s, lambda: shift / (1 + x * x)),
        (True, lambda: shift),
    ]
    return next(value for fits, value in table if fits)()


#: A relation of x and y that holds on two branches: y = x, and y as it is written. The second for x = 2, 3, ...
CROSSED = (
    ("cos(x) = cos(y)", "-x"),
    ("x^2 = y^2", "-x"),
    ("exp(x^2) = exp(y^2)", "-x"),
    ("x + 1/x = y + 1/y", "1/x"),
    ("x^3 + x*y + x = y*x^2 + y^2 + y", "-(x^2) - 1"),
    ("(x - y)*(x^3 - 5 - y) = 0", "x^3 - 5"),
    ("x^4 + 2*x^2 = y^4 + 2*y^2", "-x"),
    ("cosh(x) = cosh(y)", "-x"),
    ("x/(1 + x^2) = y/(1 + y^2)", "1/x"),
    ("(x - y)*(x^2 + y^2 + 1)*(x + y - 7) = 0", "7 - x"),
)


def crossed(rng: random.Random, size: int) -> KnownScene:
    """On the branch y = x the form dz = (x - y)^m w dx says dz = 0: holonomic, dof 2. On the other, which y = x meets
    elsewhere, x - y is not constant: with w a coordinate it is non-holonomic, 3 coordinates and 2 velocities."""
    relation, other = rng.choice(CROSSED)
    m, x, first = rng.randint(1, 1 + size), Fraction(rng.randint(2, 5)), rng.random() < 0.5
    y = x if first else _branch(other, x)
    values = {"x": x, "y": y, "z": Fraction(0), "w": Fraction(nonzero(rng, 3))}
    form = f"dz = (x - y)^{m}*w*{positive(rng, ['w', 'z'])}*dx"
    known = truths(2, holonomic=True) if first else truths(3, 2, holonomic=False)
    chart = {"x": "p0", "y": "x" if first else other, "w": "p1", "z": "5" if first else "p2"}
    more = {"instantaneous_dof": 2, "singular": False}
    return KnownScene(scene_of("x y z w", relation, form, configuration=at(values)), {**known, **more}, chart=chart)


def _branch(text: str, x: Fraction) -> Fraction:
    return {"-x": -x, "1/x": 1 / x, "-(x^2) - 1": -x * x - 1, "x^3 - 5": x**3 - 5, "7 - x": 7 - x}[text]


def _reflected(p: Point, a: Point, b: Point) -> Point:
    """p reflected in the line through a and b."""
    ux, uy = b[0] - a[0], b[1] - a[1]
    s = 2 * ((p[0] - a[0]) * ux + (p[1] - a[1]) * uy) / (ux * ux + uy * uy)
    return a[0] * 2 + s * ux - p[0], a[1] * 2 + s * uy - p[1]


def parallelogram(rng: random.Random, size: int) -> KnownScene:
    """A four-bar with opposite sides equal, A = (0, 0), B = (g, 0), D on a circle of radius r about A, C on one
    about B, |CD| = g. On the parallelogram's branch C - D = B - A; on the antiparallelogram's C is that C reflected
    in BD, so AC and BD are parallel. The form dz = W du, W = (C - D - B + A)_x or the cross product of C and D - B,
    is dz = 0 on the branch where W is 0 (dof 2, holonomic), and non-holonomic on the other (3 and 2), where W is
    not constant."""
    r, g = (Fraction(k) for k in rng.choice(((1, 2), (2, 3), (5, 7), (3, 5), (2, 1))))
    m = Fraction(rng.randint(2, 5), rng.choice((3, 7)))
    d = (r * (1 - m * m) / (1 + m * m), r * 2 * m / (1 + m * m))
    b = (g, Fraction(0))
    straight = rng.random() < 0.5
    c = (d[0] + g, d[1]) if straight else _reflected((d[0] + g, d[1]), b, d)
    wanted = rng.random() < 0.5
    w = f"(cx - px - {g})" if straight == wanted else f"(cx*py - cy*(px - {g}))"
    relations = [
        f"px^2 + py^2 = {r * r}",
        f"(cx - {g})^2 + cy^2 = {r * r}",
        f"(cx - px)^2 + (cy - py)^2 = {g * g}",
        f"zdot = {w}{'*' + positive(rng, ['z', 'u']) if size else ''}*udot",
    ]
    values = {"px": d[0], "py": d[1], "cx": c[0], "cy": c[1], "z": Fraction(0), "u": Fraction(0)}
    known = truths(2, holonomic=True) if wanted else truths(3, 2, holonomic=False)
    more = {"instantaneous_dof": 2, "singular": False}
    return KnownScene(scene_of([*values], *relations, configuration=at(values)), {**known, **more})


def turned_cranks(rng: random.Random, size: int) -> KnownScene:
    """The same with the cranks' angles: at a = b, away from a = b = 0 or pi, the set is a = b, and sin(a - b) and the
    like are 0 on it: dz = 0, dof 2, holonomic."""
    r, g = rng.choice(((1, 2), (2, 3), (3, 1), (5, 7)))
    vanishing = rng.choice(
        ("sin(a - b)", "(cos(a) - cos(b))", "(a - b)", "(sin(a) - sin(b))", "sin(a - b)^3", "(1 - cos(a - b))")
    )
    angle = Fraction(rng.choice((1, 2, -1, 4)), rng.choice((1, 2)))
    relation = f"({g} + {r}*cos(b) - {r}*cos(a))^2 + ({r}*sin(b) - {r}*sin(a))^2 = {g * g}"
    form = f"zdot = {vanishing}*{positive(rng, ['z', 'u']) if size else '1'}*udot"
    values = {"a": angle, "b": angle, "z": Fraction(0), "u": Fraction(1)}
    known = truths(2, holonomic=True, instantaneous_dof=2, singular=False)
    chart = {"a": "p0", "b": "p0", "z": "1", "u": "p1"}
    return KnownScene(scene_of("a b z u", relation, form, configuration=at(values)), known, chart=chart)
