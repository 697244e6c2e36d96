"""Arguments that are equal only where other relations hold: within unknown functions, roots, sines, logarithms."""

from __future__ import annotations

import random
from typing import NamedTuple

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import applied
from .identities import UNKNOWN


class Agreement(NamedTuple):
    """Relations on some coordinates, and two arguments that are equal where they hold."""

    relations: tuple[str, ...]
    first: str
    second: str
    #: The coordinates in order, as functions of p0, ...
    chart: dict[str, str]

    @property
    def freedom(self) -> int:
        return len({letter for text in self.chart.values() for letter in ("p0", "p1") if letter in text})


ON_A_SET = (
    Agreement(("x = y",), "x", "y", {"x": "p0", "y": "p0"}),
    Agreement(("x = y", "y = s"), "x", "s", {"x": "p0", "y": "p0", "s": "p0"}),
    Agreement(("x^2 + y^2 = 1",), "x^2", "1 - y^2", {"x": "2*p0/(1 + p0^2)", "y": "(1 - p0^2)/(1 + p0^2)"}),
    Agreement(("x*y = 1",), "1/x", "y", {"x": "p0", "y": "1/p0"}),
    Agreement(("y = x^3 + x",), "x^3 + 2*x", "y + x", {"x": "p0", "y": "p0^3 + p0"}),
    Agreement(("x - y = 2*s",), "(x - y)/2", "s", {"x": "p0", "s": "p1", "y": "x - 2*s"}),
    Agreement(("x = 3*t",), "x", "3*t", {"x": "3*t"}),
    Agreement(("x = y + t",), "x - t", "y", {"y": "p0", "x": "y + t"}),
    Agreement(("y = sin(x)",), "1 - y^2", "cos(x)^2", {"x": "p0", "y": "sin(p0)"}),
    Agreement(("x^3 = y^3",), "x", "y", {"x": "p0", "y": "p0"}),
    Agreement(("x + y = s", "x - y = s + 2"), "y", "0 - 1", {"x": "p0", "y": "0 - 1", "s": "p0 - 1"}),
    Agreement(("x = y^2", "s = x^2"), "s", "y^4", {"y": "p0", "x": "p0^2", "s": "p0^4"}),
    Agreement(("y = s^2 + 1", "x = y^2"), "sqrt(x)", "y", {"s": "p0", "y": "s^2 + 1", "x": "y^2"}),
)
#: Where the arguments agree only by an exponential or a logarithm.
BY_LOGARITHMS = (
    Agreement(("y = exp(x)",), "log(y)", "x", {"x": "p0", "y": "exp(p0)"}),
    Agreement(("x = log(y)",), "exp(x)", "y", {"y": "p0", "x": "log(p0)"}),
    Agreement(("y = exp(x)",), "log(y^2)", "2*x", {"x": "p0", "y": "exp(p0)"}),
    Agreement(("y = exp(x)", "s = y^3"), "log(s)/3", "x", {"x": "p0", "y": "exp(p0)", "s": "y^3"}),
    Agreement(("y = x*exp(x)", "x = exp(s)"), "log(y)", "s + x", {"s": "p0", "x": "exp(s)", "y": "x*exp(x)"}),
    Agreement(("y = exp(x + 2)",), "y", "exp(2)*exp(x)", {"x": "p0", "y": "exp(x + 2)"}),
)
ABOVE = ("sqrt(1 + (#)^2)", "h(#)", "h(#)", "sin(#)", "cos(#)", "exp(#)", "atan(#)", "log(2 + (#)^2)", "(#)^3", "#")


def _wrapped(rng: random.Random, agreement: Agreement, size: int) -> tuple[str, str]:
    first, second = agreement.first, agreement.second
    for _ in range(1 + (size > 2 and rng.random() < 0.5)):
        outer = rng.choice(ABOVE)
        first, second = applied(outer, first), applied(outer, second)
    return first, second


def _followed(rng: random.Random, agreement: Agreement, size: int) -> KnownScene:
    first, second = _wrapped(rng, agreement, size)
    last = f"c{len(agreement.relations) + 1}"
    scene = scene_of([*agreement.chart], *agreement.relations, f"{first} = {second}", functions=UNKNOWN)
    known = truths(agreement.freedom, redundant=[last], redundant_equations=1, holonomic=True)
    return KnownScene(scene, known, chart=agreement.chart)


def _formed(rng: random.Random, agreement: Agreement, size: int) -> KnownScene:
    first, second = _wrapped(rng, agreement, size)
    relations = [*agreement.relations, f"dz = ({first} - ({second}))*w*du"]
    scene = scene_of([*agreement.chart, "z", "w", "u"], *relations, functions=UNKNOWN)
    f = agreement.freedom
    chart = {**agreement.chart, "z": "2", "w": f"p{f}", "u": f"p{f + 1}"}
    return KnownScene(scene, truths(f + 2, holonomic=True), chart=chart)


def followed(rng: random.Random, size: int) -> KnownScene:
    """F(a) = F(b), with a = b where the relations hold: it says nothing new."""
    return _followed(rng, rng.choice(ON_A_SET), size)


def formed(rng: random.Random, size: int) -> KnownScene:
    """dz = (F(a) - F(b)) w du, with a = b on the set: dz = 0, holonomic; w and u are free."""
    return _formed(rng, rng.choice(ON_A_SET), size)


def added(rng: random.Random, size: int) -> KnownScene:
    """dw = z du and dw - z du + (F(a) - F(b)) dz = 0 are one form on the set, and that is non-holonomic."""
    agreement = rng.choice(ON_A_SET)
    first, second = _wrapped(rng, agreement, size)
    forms = ["dw = z*du", f"dw - z*du + ({first} - ({second}))*dz = 0"]
    scene = scene_of([*agreement.chart, "z", "w", "u"], *agreement.relations, *forms, functions=UNKNOWN)
    last, f = f"c{len(agreement.relations) + 2}", agreement.freedom
    known = truths(f + 3, f + 2, holonomic=False, redundant=[last], redundant_equations=1)
    chart = {**agreement.chart, "z": f"p{f}", "w": f"p{f + 1}", "u": f"p{f + 2}"}
    return KnownScene(scene, known, chart=chart)


def beads(rng: random.Random, size: int) -> KnownScene:
    """k beads on the wire y = h(x) (in space z = f(x) too) that stand at one place: of the places' equations those in
    x say all, those in y and z follow."""
    k, space = 2 + rng.randint(0, size), rng.random() < 0.5
    each = range(1, k + 1)
    wires = [f"{y}{i} = {f}(x{i})" for i in each for y, f in (("y", "h"), *([("z", "f")] if space else []))]
    letters = ["x", "y", *(["z"] if space else [])]
    meet = [f"{c}{i} = {c}{i + 1}" for i in each[:-1] for c in letters]
    scene = scene_of([f"{c}{i}" for i in each for c in letters], *wires, *meet, functions={"h": ["s"], "f": ["s"]})
    chart = {
        f"{c}{i}": text for i in each for c, text in zip("xyz", ("p0", "h(p0)", "f(p0)"), strict=True) if c in letters
    }
    follow = [f"c{len(wires) + 1 + i}" for i in range(len(meet)) if i % len(letters)]
    return KnownScene(scene, truths(1, redundant=follow, redundant_equations=len(follow)), chart=chart)


def cam(rng: random.Random, size: int) -> KnownScene:
    """y = h(x) and x is given in time: y = h of that follows."""
    motion = rng.choice(("v*t", "v*t + 1", "sin(v*t)", "t^2", "v*t^3 + t", "exp(t)"))
    scene = scene_of("x y", "y = h(x)", f"x = {motion}", f"y = h({motion})", functions=UNKNOWN, parameters=["v"])
    known = truths(0, redundant=["c3"], redundant_equations=1, scleronomic=False)
    return KnownScene(scene, known, chart={"x": motion, "y": "h(x)"})


def logarithms(rng: random.Random, size: int) -> KnownScene:
    """The relation that follows, and the form, where logarithms and exponentials make the arguments equal."""
    make = rng.choice((_followed, _formed, _integrated))
    return make(rng, rng.choice(BY_LOGARITHMS), size)


def _integrated(rng: random.Random, agreement: Agreement, size: int) -> KnownScene:
    """A relation c1 with its own differential plus (a - b) dq, which is the same on the set."""
    text = "y = exp(x)", f"(log(y) - x)*{rng.choice(('', 'y*', 'sin(x)*'))}dx + dy = y*dx"
    known = truths(1, redundant=["c2"], redundant_equations=1, holonomic=True)
    return KnownScene(scene_of("x y", *text), known, chart={"x": "p0", "y": "exp(p0)"})


FAMILY = {
    "followed": followed,
    "formed": formed,
    "added": added,
    "beads": beads,
    "cam": cam,
    "logarithms": logarithms,
}
