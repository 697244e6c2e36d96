"""Arguments that are equal everywhere in another writing, or only where other relations hold: within unknown
functions, roots, sines, logarithms; and pairs that are nearly equal."""

from __future__ import annotations

import random
from typing import NamedTuple

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import INJECTIVE, applied

UNKNOWN = {"h": ["s"]}


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


#: Equal as functions of a and b where both are defined; what is defined on less comes first.
EQUAL = (
    ("(a + b)^5", "a^5 + 5*a^4*b + 10*a^3*b^2 + 10*a^2*b^3 + 5*a*b^4 + b^5"),
    ("cos(2*a)", "1 - 2*sin(a)^2"),
    ("sin(3*a)", "3*sin(a) - 4*sin(a)^3"),
    ("cos(4*a)", "8*cos(a)^4 - 8*cos(a)^2 + 1"),
    ("sin(a + b)", "sin(a)*cos(b) + cos(a)*sin(b)"),
    ("sin(a)*sin(b)", "(cos(a - b) - cos(a + b))/2"),
    ("tan(a)^2", "1/cos(a)^2 - 1"),
    ("(a^2 - b^2)/(a - b)", "a + b"),
    ("a/(1 + a^2) + 1/(1 + a^2)", "(1 + a)/(1 + a^2)"),
    ("1/(1/(1 + a^2) + 1/(1 + b^2))", "(1 + a^2)*(1 + b^2)/(2 + a^2 + b^2)"),
    ("exp(a + b)", "exp(a)*exp(b)"),
    ("exp(2*a)", "exp(a)^2"),
    ("log((1 + a^2)^3)", "3*log(1 + a^2)"),
    ("log((1 + a^2)*(1 + b^2))", "log(1 + a^2) + log(1 + b^2)"),
    ("exp(log(1 + a^2)/2)", "sqrt(1 + a^2)"),
    ("cosh(a)", "(exp(a) + exp(-a))/2"),
    ("sinh(2*a)", "2*sinh(a)*cosh(a)"),
    ("tanh(a)", "(exp(2*a) - 1)/(exp(2*a) + 1)"),
    ("sqrt(1 + 2*a^2 + a^4)", "1 + a^2"),
    ("sqrt(3 + 2*sqrt(2))*a", "(1 + sqrt(2))*a"),
    ("sqrt(8)*a + b", "2*sqrt(2)*a + b"),
    ("sqrt((1 + a^2)*(1 + b^2))", "sqrt(1 + a^2)*sqrt(1 + b^2)"),
    ("(1 + sqrt(1 + a^2))^2", "2 + a^2 + 2*sqrt(1 + a^2)"),
    ("abs(a)^2", "a^2"),
    ("abs(a*b)", "abs(a)*abs(b)"),
    ("(1 + a)^8", "(1 + 2*a + a^2)^4"),
    ("(a + b)^8", "(a^2 + 2*a*b + b^2)^4"),
    ("(1 + a^2)^(3/2)", "(1 + a^2)*sqrt(1 + a^2)"),
    ("sin(acos(a/(1 + a^2)))", "sqrt(1 - a^2/(1 + a^2)^2)"),
    ("cos(atan(a))", "1/sqrt(1 + a^2)"),
    ("cos(pi/5)*a", "(1 + sqrt(5))/4*a"),
    ("sin(a)^6 + cos(a)^6", "1 - 3*sin(a)^2*cos(a)^2"),
    ("(a - b)*(a^6 + a^5*b + a^4*b^2 + a^3*b^3 + a^2*b^4 + a*b^5 + b^6)", "a^7 - b^7"),
)
#: As functions of a and b they differ, though little, or only in one place.
DIFFERENT = (
    ("(a + b)^5", "a^5 + 5*a^4*b + 10*a^3*b^2 + 10*a^2*b^3 + 5*a*b^4 + b^5 + a/10^30"),
    ("cos(2*a)", "1 - 2*sin(a)^2 + b/10^25"),
    ("cos(2*a)", "1 - 3*sin(a)^2"),
    ("sin(a)", "a - a^3/6 + a^5/120 - a^7/5040"),
    ("exp(a)*10^20", "exp(a)*(10^20 + 1)"),
    ("log((1 + a^2)^3)", "2*log(1 + a^2)"),
    ("sqrt(1 + a^2 + a^4)", "1 + a^2"),
    ("1/(1 + a^2)", "1 - a^2 + a^4 - a^6 + a^8"),
    ("(a + b)^8", "(a^2 + 2*a*b + b^2)^4 + (b/10^4)^8"),
    ("sqrt(a^2 + b^2 + 1)", "sqrt(a^2 + b^2 + 1 + 10^(-40))"),
    ("cos(pi/5)*a", "(80901699437494742410229341718/10^29)*a"),
)
EVERYWHERE = tuple(Agreement((), first, second, {"a": "p0", "b": "p1"}) for first, second in EQUAL)
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
#: Different wherever the arguments are.
STRICT = (*INJECTIVE, "h(#)", "#")
ABOVE = (*STRICT, "h(#)", "sin(#)", "cos(#)", "sqrt(1 + (#)^2)", "1/(1 + (#)^2)", "log(2 + (#)^2)")


def _wrapped(rng: random.Random, pair: tuple[str, str], size: int, outer: tuple[str, ...] = ABOVE) -> tuple[str, str]:
    """Both of a pair within the same functions."""
    first, second = pair
    for _ in range(1 + (size > 2 and rng.random() < 0.5)):
        pattern = rng.choice(outer)
        first, second = applied(pattern, first), applied(pattern, second)
    return first, second


def _followed(rng: random.Random, agreement: Agreement, size: int) -> KnownScene:
    first, second = _wrapped(rng, (agreement.first, agreement.second), size)
    last = f"c{len(agreement.relations) + 1}"
    scene = scene_of([*agreement.chart], *agreement.relations, f"{first} = {second}", functions=UNKNOWN)
    known = truths(agreement.freedom, redundant=[last], redundant_equations=1, holonomic=True)
    return KnownScene(scene, known, chart=agreement.chart)


def _formed(rng: random.Random, agreement: Agreement, size: int) -> KnownScene:
    first, second = _wrapped(rng, (agreement.first, agreement.second), size)
    relations = [*agreement.relations, f"dz = ({first} - ({second}))*w*du"]
    scene = scene_of([*agreement.chart, "z", "w", "u"], *relations, functions=UNKNOWN)
    f = agreement.freedom
    chart = {**agreement.chart, "z": "2", "w": f"p{f}", "u": f"p{f + 1}"}
    return KnownScene(scene, truths(f + 2, holonomic=True), chart=chart)


def followed(rng: random.Random, size: int) -> KnownScene:
    """F(a) = F(b), with a = b where the relations hold: it says nothing new."""
    return _followed(rng, rng.choice(rng.choice((EVERYWHERE, ON_A_SET))), size)


def formed(rng: random.Random, size: int) -> KnownScene:
    """dz = (F(a) - F(b)) w du, with a = b on the set: dz = 0, holonomic; w and u are free."""
    return _formed(rng, rng.choice(rng.choice((EVERYWHERE, ON_A_SET))), size)


def added(rng: random.Random, size: int) -> KnownScene:
    """dw = z du and dw - z du + (F(a) - F(b)) dz = 0 are one form on the set, and that is non-holonomic."""
    agreement = rng.choice(rng.choice((EVERYWHERE, ON_A_SET)))
    first, second = _wrapped(rng, (agreement.first, agreement.second), size)
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


def remaining(rng: random.Random, size: int) -> KnownScene:
    """w = dx + y (F - G) dz = 0 with F other than G: w ^ dw = (F - G) dx ^ dy ^ dz + ... is not 0. An unknown function
    differs at arguments that do, since it is any function."""
    first, second = _wrapped(rng, rng.choice(DIFFERENT), size // 2, STRICT)
    scene = scene_of("a b x y z", f"xdot + y*({first} - ({second}))*zdot = 0", functions=UNKNOWN)
    chart = {name: f"p{k}" for k, name in enumerate("abxyz")}
    return KnownScene(scene, truths(5, 4, holonomic=False, scleronomic=True), chart=chart)


#: A function of y, the same in another writing, and its derivative.
INNER = (
    ("1/(1+y)", "2/(2+2*y)", "(-1)/(1+y)^2"),
    ("(1+y)^2", "1+2*y+y^2", "2*(1+y)"),
    ("cos(2*y)", "1-2*sin(y)^2", "(-2)*sin(2*y)"),
    ("(y^3-1)/(y-1)", "y^2+y+1", "(2*y+1)"),
    ("log((1+y^2)^3)", "3*log(1+y^2)", "6*y/(1+y^2)"),
    ("exp(2*y)", "exp(y)^2", "2*exp(2*y)"),
    ("(1+y)^12", "(1+2*y+y^2)^6", "12*(1+y)^11"),
    ("tan(y)^2", "1/cos(y)^2 - 1", "2*tan(y)/cos(y)^2"),
    ("sqrt(1+y^2)", "(1+y^2)/sqrt(1+y^2)", "y/sqrt(1+y^2)"),
    ("sinh(2*y)", "2*sinh(y)*cosh(y)", "2*cosh(2*y)"),
)
#: A function and its derivative.
DERIVED = (
    ("sin(#)", "cos(#)"),
    ("cos(#)", "(-1)*sin(#)"),
    ("exp(#)", "exp(#)"),
    ("h(#)", "h'(#)"),
    ("atan(#)", "1/(1+(#)^2)"),
    ("sqrt(1+(#)^2)", "(#)/sqrt(1+(#)^2)"),
    ("log(1+(#)^2)", "2*(#)/(1+(#)^2)"),
    ("(#)^9 + (#)", "(9*(#)^8 + 1)"),
)


def closed(rng: random.Random, size: int) -> KnownScene:
    """d(X(x) F(E(y))), the second term with E in another writing: exact."""
    one, other, slope = rng.choice(INNER)
    outer, derived = rng.choice(DERIVED)
    x, dx = rng.choice(
        (("x", "1"), ("x^2 + 1", "2*x"), ("sin(x)", "cos(x)"), ("exp(x)", "exp(x)"), ("(x + x^3)", "(1 + 3*x^2)"))
    )
    if rng.random() < 0.5:
        one, other = other, one
    text = f"{dx}*({applied(outer, one)})*xdot + ({x})*({applied(derived, other)})*{slope}*ydot = 0"
    known = truths(1, holonomic=True, scleronomic=True, **{"c1.exact": True, "c1.holonomic": True})
    return KnownScene(scene_of("x y", text, functions=UNKNOWN), known)
