"""Contacts of high order at a reference, in many coordinates: what looks free to any low order is not, or is."""

from __future__ import annotations

import random

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import at, names, polynomial

#: A function whose only zero near 0 is 0, and the order of that zero.
FLAT = (
    ("#", 1),
    ("(sin(#) - #)", 3),
    ("(1 - cos(#))", 2),
    ("(exp(#) - 1 - #)", 2),
    ("(sin(#) - # + #^3/6 - #^5/120 + #^7/5040)", 9),
    ("(cos(#) - 1 + #^2/2 - #^4/24 + #^6/720 - #^8/40320)", 10),
    ("(tan(#) - #)", 3),
    ("(log(1 + #) - # + #^2/2)", 3),
    ("(sqrt(1 + #^2) - 1 - #^2/2)", 4),
    ("(atan(#) - # + #^3/3)", 5),
)


def _power(rng: random.Random, name: str, least: int, most: int) -> tuple[str, int]:
    """A flat function of one coordinate with an order in that range, or a little more."""
    pattern, order = rng.choice([row for row in FLAT if row[1] <= most])
    k = max(1, rng.randint(-(-least // order), max(1, -(-most // order))))
    return f"{pattern.replace('#', name)}^{k}", k * order


def _others(rng: random.Random, size: int) -> list[str]:
    return names("q", rng.choice((0, 1, 3, 5 + 18 * size)))


def _unit(rng: random.Random, q: list[str]) -> str:
    """1 and squares of some."""
    return "(1" + "".join(f" + {c}^2" for c in q) + ")"


def _case(coordinates: list[str], base: str, flat: str, dof: int, chart: dict[str, str]) -> KnownScene:
    """y = base and y = base + flat, both with the differential dy - d base at 0: one less than all is free at first."""
    relations = [f"y = {base}", f"y = {base} + {flat}"]
    scene = scene_of(["y", *coordinates], *relations, configuration=at(dict.fromkeys(["y", *coordinates], 0)))
    n = len(coordinates)
    known = truths(dof, instantaneous_dof=n, singular=True, holonomic=True)
    return KnownScene(scene, known, chart=chart | {"y": base})


def touching(rng: random.Random, size: int) -> KnownScene:
    """f(x)^a (1 + sum q^2) + g(x)^b q_1 = 0 with b's order the higher: near 0 it is x^m times what is not 0, so x =
    0."""
    q = _others(rng, size)
    f, order = _power(rng, "x", 2, 3 + 6 * size)
    flat = f"{f}*{_unit(rng, q)}"
    if q and rng.random() < 0.6:
        flat += f" + {_power(rng, 'x', order + 1, order + 6)[0]}*{q[0]}"
    chart = {name: f"p{k}" for k, name in enumerate(q)} | {"x": "0"}
    base = polynomial(rng, ["x", *q]) if rng.random() < 0.4 else "0"
    return _case(["x", *q], base, flat, len(q), chart)


def definite(rng: random.Random, size: int) -> KnownScene:
    """A sum of even powers of x_1, ..., x_k times what is positive: all of them are 0."""
    q, k = _others(rng, size // 2), 2 + rng.randint(0, size)
    x = names("x", k)
    flat = " + ".join(f"{rng.randint(1, 3)}*{c}^{2 * rng.randint(1, 1 + 2 * size)}*{_unit(rng, q[:2])}" for c in x)
    chart = {name: f"p{i}" for i, name in enumerate(q)} | dict.fromkeys(x, "0")
    base = polynomial(rng, [*x, *q]) if rng.random() < 0.4 else "0"
    return _case([*x, *q], base, f"({flat})", len(q), chart)


def passing(rng: random.Random, size: int) -> KnownScene:
    """u^a = w^b (1 + sum q^2) with a odd holds on a hypersurface through 0: one less than x, u and the q."""
    q, a = _others(rng, size // 2), 3 + 2 * rng.randint(0, 1 + size)
    b = rng.randint(2, 4 + 2 * size)
    flat = f"(u^{a} - w^{b}*{_unit(rng, q)})"
    base = polynomial(rng, ["u", "w", *q]) if rng.random() < 0.4 else "0"
    case = _case(["u", "w", *q], base, flat, 1 + len(q), {})
    return KnownScene(case.scene, case.truth)
