"""Equal arguments in different writings within functions, known and unknown; and pairs that are nearly so."""

from __future__ import annotations

import random

from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

from .draws import INJECTIVE, applied, nonzero, polynomial

UNKNOWN = {"h": ["s"]}

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
    ("(1 + a)^12", "(1 + 2*a + a^2)^6"),
    ("(a + b)^30", "(a^2 + 2*a*b + b^2)^15"),
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
    ("(a + b)^30", "(a^2 + 2*a*b + b^2)^15 + (b/16)^30"),
    ("sqrt(a^2 + b^2 + 1)", "sqrt(a^2 + b^2 + 1 + 10^(-40))"),
    ("cos(pi/5)*a", "(80901699437494742410229341718/10^29)*a"),
)
OUTER = (
    *INJECTIVE,
    "sin(#)",
    "cos(#)",
    "1/(1 + (#)^2)",
    "log(1 + (#)^2)",
    "sqrt(1 + (#)^2)",
    "h(#)",
    "h(#)",
    "h(#)",
    "#",
)
#: Different wherever the arguments are.
STRICT = (*INJECTIVE, "h(#)", "#")


def wrapped(rng: random.Random, pair: tuple[str, str], size: int, outer: tuple[str, ...]) -> tuple[str, str]:
    """Both of a pair within the same functions."""
    first, second = pair
    for _ in range(1 + rng.randint(0, size // 2)):
        pattern = rng.choice(outer)
        first, second = applied(pattern, first), applied(pattern, second)
    return first, second


def vanishing(rng: random.Random, size: int) -> KnownScene:
    """dx + y (F - G) dz = 0 with F = G: it says dx = 0."""
    first, second = wrapped(rng, rng.choice(EQUAL), size, OUTER)
    more = f"*({polynomial(rng, ['a', 'z'])} + 7)" if rng.random() < 0.4 else ""
    scene = scene_of("a b x y z", f"xdot + y*({first} - ({second})){more}*zdot = 0", functions=UNKNOWN)
    known = truths(4, holonomic=True, scleronomic=True, **{"c1.holonomic": True})
    return KnownScene(scene, known, chart={"a": "p0", "b": "p1", "y": "p2", "z": "p3", "x": "1"})


def remaining(rng: random.Random, size: int) -> KnownScene:
    """The same with F other than G: w = dx + y (F - G) dz has w ^ dw = (F - G) dx ^ dy ^ dz + ..., other than 0. An
    unknown function differs at arguments that do, since it is any function."""
    first, second = wrapped(rng, rng.choice(DIFFERENT), size // 2, STRICT)
    scene = scene_of("a b x y z", f"xdot + y*({first} - ({second}))*zdot = 0", functions=UNKNOWN)
    chart = {name: f"p{k}" for k, name in enumerate("abxyz")}
    return KnownScene(scene, truths(5, 4, holonomic=False, scleronomic=True), chart=chart)


def repeated(rng: random.Random, size: int) -> KnownScene:
    """z = F y and z = G y with F = G: the second says nothing new."""
    first, second = wrapped(rng, rng.choice(EQUAL), size, OUTER)
    k = nonzero(rng)
    scene = scene_of("a b y z", f"z = ({first})*y + {k}", f"z = ({second})*y + {k}", functions=UNKNOWN)
    known = truths(3, redundant=["c2"], redundant_equations=1)
    return KnownScene(scene, known, chart={"a": "p0", "b": "p1", "y": "p2", "z": f"({first})*y + {k}"})


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


FAMILY = {"vanishing": vanishing, "remaining": remaining, "repeated": repeated, "closed": closed}
