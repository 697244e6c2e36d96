"""Frameworks that move though a count says that they do not, at exact positions; rounded to some digits with a
tolerance; and with other relations attached. Their first-order freedom is the exact rank."""

from __future__ import annotations

import random
from collections.abc import Mapping
from fractions import Fraction
from itertools import combinations
from typing import Any, NamedTuple

from dofkit.benchmark.trials.construction import KnownScene, truths
from dofkit.benchmark.trials.frameworks import End, Framework, Position
from dofkit.benchmark.trials.poses import rounded

from .draws import at

#: Rational points of the unit circle.
TURNS = tuple(
    (Fraction(a, c), Fraction(b, c)) for a, b, c in ((3, 4, 5), (4, 3, 5), (5, 12, 13), (8, 15, 17), (20, 21, 29))
)


class Special(NamedTuple):
    """A framework at a special position, and what is true of it."""

    framework: Framework
    truth: Mapping[str, Any]

    def known(self) -> KnownScene:
        """The scene with its truth, and the first-order freedom."""
        return KnownScene(self.framework.scene(), {**self.truth, "instantaneous_dof": self.framework.by_rank()})


def _parallel_cranks(rng: random.Random, size: int) -> Special:
    """Three equal parallel cranks on the ground, their ends D_0, D_1, D_2 linked each to each. To first order a D_i
    moves by m_i across its crank, and the links make the m_i equal: 1, and the parallel motion is that. The last link
    is implied by all the others together: without a crank or a link its two ends turn on their own."""
    r = rng.randint(1, 3)
    c, s = rng.choice(TURNS)
    line = rng.random() < 0.5
    ground = tuple((Fraction(x), Fraction(0 if line else x * x)) for x in rng.sample(range(-6, 7), 3))
    ends = {f"D{i}": (x + r * c, y + r * s) for i, (x, y) in enumerate(ground)}
    bars: list[tuple[End, End]] = [(i, f"D{i}") for i in range(3)]
    framework = Framework(ends, ground, (*bars, ("D0", "D1"), ("D1", "D2"), ("D0", "D2")))
    known = truths(1, singular=framework.by_rank() != 1, redundant=["bar5"], redundant_equations=1)
    return Special(framework, known | {"bar5.circuit": [f"bar{k}" for k in range(5)]})


def _in_line(rng: random.Random, size: int) -> Special:
    """k points on a line, each linked to each, in the plane or in space: since each length between is the sum of
    its parts they stay on a line, a rigid segment of 2 d - 1 freedoms; to first order they leave it."""
    k, d = 3 + min(size, 2), rng.choice((2, 3))
    direction = [rng.randint(-2, 2) for _ in range(d - 1)] + [1]
    steps = sorted(rng.sample(range(-5, 6), k))
    joints = {f"P{i}": tuple(Fraction(s * c) for c in direction) for i, s in enumerate(steps)}
    framework = Framework(joints, (), tuple(combinations(joints, 2)))
    dof = 2 * d - 1
    extra = max(0, len(framework.bars) - (k * d - dof))
    return Special(framework, truths(dof, singular=framework.by_rank() != dof, redundant_equations=extra))


def _dixon(rng: random.Random, size: int) -> Special:
    """K(m, n) on two perpendicular lines, away from where they cross: a -> sqrt(a^2 + c), b -> sqrt(b^2 - c) keeps all
    lengths a^2 + b^2, and with the 3 motions of the plane that is 4; where the first-order freedom is 4 it is no
    more."""
    m, n = rng.choice(((3, 3), (3, 4), (4, 4), (3, 5))[: 1 + size])
    a, b = ([Fraction(rng.choice((-1, 1)) * k) for k in rng.sample(range(1, 9), many)] for many in (m, n))
    joints = {f"A{i}": (x, Fraction(0)) for i, x in enumerate(a)} | {f"B{i}": (Fraction(0), y) for i, y in enumerate(b)}
    return _at_least(Framework(joints, (), tuple((f"A{i}", f"B{j}") for i in range(m) for j in range(n))), 4)


def _bricard(rng: random.Random, size: int) -> Special:
    """Bricard's octahedra, A X, B Y, C Z not linked. Symmetric about a line: 9 numbers for A, B, C, 6 lengths, and
    the 2 motions along the line leave 1. Symmetric about a plane that holds C and Z: 3 + 3 + 2 + 2 numbers, 6
    lengths, and 3 motions of the plane leave 1. With the 6 motions of space the freedom is 7 at least, and no more
    where the first-order freedom is 7."""
    a, b, c = (_place(rng) for _ in range(3))
    if rng.random() < 0.5:
        joints = {"A": a, "B": b, "C": c}
        joints |= {n: (-x, -y, z) for n, (x, y, z) in zip("XYZ", (a, b, c), strict=True)}
    else:
        joints = {"A": a, "X": (-a[0], *a[1:]), "B": b, "Y": (-b[0], *b[1:])}
        joints |= {"C": (Fraction(0), *c[1:]), "Z": (Fraction(0), *_place(rng)[1:])}
    if len(set(joints.values())) < len(joints):
        return _bricard(rng, size)
    apart = {("A", "X"), ("B", "Y"), ("C", "Z")}
    bars = tuple((p, q) for p, q in combinations("ABCXYZ", 2) if (p, q) not in apart)
    return _at_least(Framework(joints, (), bars), 7)


def _place(rng: random.Random) -> Position:
    return tuple(Fraction(rng.randint(-12, 12), rng.choice((1, 2, 3))) for _ in range(3))


def _at_least(framework: Framework, dof: int) -> Special:
    """What is true of a framework that moves with so many freedoms at least."""
    if framework.by_rank() != dof:
        return Special(framework, {"consistent": True})
    extra = len(framework.bars) - (framework.coordinates - dof)
    return Special(framework, truths(dof, singular=False, redundant_equations=extra))


# -- measured positions --------------------------------------------------------------------------------------------

COUNTED = ("consistent", "dof", "velocity_dof", "redundant_equations")


def special(rng: random.Random, size: int) -> KnownScene:
    """One of them as it is drawn."""
    return rng.choice((_parallel_cranks, _in_line, _dixon, _bricard))(rng, size).known()


def _moving(rng: random.Random, size: int) -> Special:
    """One whose freedom is known."""
    special = rng.choice((_parallel_cranks, _dixon, _bricard))(rng, size)
    return special if "dof" in special.truth else _moving(rng, size)


def _measured(framework: Framework, digits: int) -> dict[str, Any]:
    return framework.moved(rounded(digits)).scene(tolerance=10.0 ** (1 - digits))


def _with(scene: Mapping[str, Any], coordinates: list[str], text: str) -> dict[str, Any]:
    return {**scene, "coordinates": coordinates, "constraints": [*scene["constraints"], text]}


def measured(rng: random.Random, size: int) -> KnownScene:
    """The positions rounded, and somewhere else: the exact ones are within the tolerance, and what moves there is
    what was meant."""
    special, digits, shift = _moving(rng, size), rng.randint(5, 9), rng.choice((0, 0, 5))
    framework = special.framework.moved(lambda p: tuple(x + shift for x in p))
    return KnownScene(_measured(framework, digits), {k: v for k, v in special.truth.items() if k in COUNTED})


def attached(rng: random.Random, size: int) -> KnownScene:
    """The same with a form dr = x_P dq on two more coordinates, or r = x_P + q^2: the first adds 2 freedoms and 1
    velocity, and is non-holonomic where x_P moves; the second adds 1 and 1. Without a reference for q and r the
    positions are none for all: other assemblies of the same lengths, which are rigid, are components of the set
    too."""
    special, digits = _moving(rng, size), rng.randint(5, 9)
    scene = _measured(special.framework, digits) if rng.random() < 0.8 else special.framework.scene()
    point, formed = scene["particles"][-1], rng.random() < 0.6
    text = f"rdot = x_{point['name']}*qdot" if formed else f"r = x_{point['name']} + q^2"
    scene = _with(scene, ["q", "r"], text)
    counted = {key: special.truth[key] for key in COUNTED}
    known = counted | _freedoms(special.truth["dof"], formed)
    if rng.random() < 0.5:
        return KnownScene({**scene, "configuration": at({"q": 0, "r": point["at"][0]})}, known)
    rigid = _freedoms(special.truth["dof"] - 1, formed) | {"redundant_equations": 0}
    return KnownScene(scene, known, {key: [value] for key, value in rigid.items()})


def _freedoms(moving: int, formed: bool) -> dict[str, Any]:
    """With the form, or the relation, together with a framework of so many freedoms."""
    if formed and moving:
        return {"dof": moving + 2, "velocity_dof": moving + 1, "holonomic": False}
    return {"dof": moving + 1, "velocity_dof": moving + 1, "holonomic": True}
