"""Integrals of Pfaffian forms: hand-derived tables, what has no integral, and a law for all results.

Whatever comes back is read again as text and differentiated numerically, to 40 digits, by code of this file alone.
"""

from __future__ import annotations

import subprocess
import sys
from functools import partial
from itertools import combinations
from random import Random
from typing import Any

import mpmath
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shared.known_scenes import spread
from shared.work import calls_of, counted

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.text import parse_expression, parse_relations
from dofkit.expressions.text.names import Names
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.search import Integral, integrate
from dofkit.relations.normal.normal_form import cleared, in_velocities, linear_form
from dofkit.relations.normal.pieces import Pfaffian

COORDINATES = ("x", "y", "z", "s", "r", "phi", "theta")
PARAMETERS = ("R", "a", "b", "k", "v", "l", "C")
NAMES = Names(
    frozenset(COORDINATES),
    {name: ex.parameter(name) for name in PARAMETERS},
    {"h": 1, "f": 1},
    {"h": ("s",), "f": ("t",)},
)
TOLERANCE = mpmath.mpf(10) ** -12


def pfaffian(text: str) -> Pfaffian:
    form = linear_form(cleared(in_velocities(parse_expression(text, NAMES))[0]))
    assert form is not None
    return form


# -- an independent reading of expressions ---------------------------------------------------------


def value(e: Expr, point: dict[str, Any]) -> Any:
    """The number ``e`` is at a point; unknown functions are u^3 + exp(u/2)."""
    if e.op == "num":
        return mpmath.mpf(e.args[0].numerator) / e.args[0].denominator
    if e.op == "const":
        return mpmath.pi if e.args[0] == "pi" else mpmath.e
    if e.op == "sym":
        return point[e.args[1]]
    if e.op == "call":
        (order,), (inside,) = e.args[1:]
        return mpmath.diff(lambda u: u**3 + mpmath.exp(u / 2), value(inside, point), order)
    parts = [value(child, point) for child in ex.children(e)]
    if e.op == "add":
        return mpmath.fsum(parts)
    if e.op == "mul":
        return mpmath.fprod(parts)
    if e.op == "pow":
        return mpmath.power(*parts)
    name = {"log": "ln", "abs": "fabs"}.get(e.args[0], e.args[0])
    return getattr(mpmath, name)(*parts)


def gradient(e: Expr, point: dict[str, Any]) -> dict[str, Any]:
    return {
        name: mpmath.diff(lambda u, name=name: value(e, point | {name: u}), point[name]) for name in (*COORDINATES, "t")
    }


def points(count: int = 3) -> list[dict[str, Any]]:
    """Positive, so that roots and logarithms are real as far as they can be."""
    rng = Random("integrals")
    names = (*COORDINATES, *PARAMETERS, "t")
    drawn = [{name: mpmath.mpf(rng.randrange(20, 90)) / 97 for name in names} for _ in range(count)]
    return [point | {"R": point["R"] + 1} for point in drawn]


def at(form: Pfaffian, point: dict[str, Any]) -> dict[str, Any]:
    omega = dict.fromkeys((*COORDINATES, "t"), mpmath.mpf(0))
    return omega | {s.args[1]: value(a, point) for s, a in form.items()}


def left_side(text: str) -> Expr:
    """f of ``f = C``, read back as a person's text would be."""
    assert text.endswith(" = C")
    (relation,) = parse_relations(text, NAMES)
    assert ex.parameter("C") in relation.left.symbols | relation.right.symbols
    return parse_expression(text.removesuffix(" = C"), NAMES)


def check(form: Pfaffian, found: Integral) -> None:
    """df = mu omega at every point, and mu is not 0."""
    integral = left_side(found.integral)
    mu = parse_expression(found.factor or "1", NAMES)
    with mpmath.workdps(40):
        for point in points():
            scale = value(mu, point)
            assert abs(scale) > TOLERANCE
            slopes, omega = gradient(integral, point), at(form, point)
            for name, slope in slopes.items():
                assert abs(slope - scale * omega[name]) < TOLERANCE * (1 + abs(slope))


def proportional(form: Pfaffian, text: str) -> bool:
    """d(text) ^ omega = 0 at every point."""
    with mpmath.workdps(40):
        for point in points():
            slopes, omega = gradient(parse_expression(text, NAMES), point), at(form, point)
            pairs = combinations(omega, 2)
            if any(abs(slopes[i] * omega[j] - slopes[j] * omega[i]) > TOLERANCE for i, j in pairs):
                return False
    return True


# -- tables ----------------------------------------------------------------------------------------

#: form -> (integral, factor), to the letter.
EXACT_TEXT = {
    "x dy + y dx": ("x*y = C", None),
    "x xdot + y ydot": ("x^2/2 + y^2/2 = C", None),
    "dx - R dphi": ("x - R*phi = C", None),
    "sin(x) dx + t dy + y dt": ("y*t - cos(x) = C", None),
    "xdot - v": ("x - v*t = C", None),
    "x dy - y dx": ("y/x = C", "1/x^2"),
    "y dx": ("x = C", "1/y"),
    "y dx + 2 x dy": ("x*y^2 = C", "y"),
    "dy - h'(s) ds": ("y - h(s) = C", None),
    "dx - f'(t) dt": ("x - f(t) = C", None),
    "sin(theta) dphi": ("phi = C", "1/sin(theta)"),
    "R sin(theta) dphi - sin(theta) dx": ("R*phi - x = C", "1/sin(theta)"),
    "exp(x^2) dx": ("x = C", "exp(-x^2)"),
    "y z dx + x z dy + x y dz": ("x*y*z = C", None),
    "(x dy - y dx)/(x^2 + y^2)": ("atan(y/x) = C", None),
    "exp(t) (x dx + y dy)": ("x^2 + y^2 = C", "2*exp(-t)"),
    "x h'(s) sdot + h(s) xdot": ("x*h(s) = C", None),
    "ydot - a y": ("y*exp(-a*t) = C", "exp(-a*t)"),
}

#: form -> an integral derived by hand.
BY_HAND = {
    "dy - 2^x dx": "y - 2^x/log(2)",
    "dx - dt/cos(t)": "x - log((1 + sin(t))/cos(t))",
    "dy - dx/sqrt(x^2 + a^2)": "y - log(x + sqrt(x^2 + a^2))",
    "dy - tanh(x) dx": "y - log(cosh(x))",
    "dx + dy/sin(y)^2": "x - cos(y)/sin(y)",
    "dx + dy/sin(2 y)": "x + log((1 - cos(2*y))/sin(2*y))/2",
    "dx + dy/cos(y)^2": "x + sin(y)/cos(y)",
    "2 y dx + 3 x dy": "x^2*y^3",
    "xdot + 2 x t": "x*exp(t^2)",
    "xdot - x/t": "x/t",
    "dy + (y/x - x) dx": "x*y - x^3/3",
    "dy + (2 x y - x) dx": "(y - 1/2)*exp(x^2)",
    "dy - (y - y^2) dx": "(1/y - 1)*exp(x)",
    "dy + (y/x + x y^2) dx": "1/(x*y) - x",
    "(x^2 + y^2) dx - 2 x y dy": "(x^2 - y^2)/x",
    "(x + y) dx + (y - x) dy": "log(x^2 + y^2) - 2*atan(y/x)",
    "(x^2 + y^2 + x) dx + x y dy": "x^4/4 + x^2*y^2/2 + x^3/3",
    "y (1 + x y) dx - x dy": "x/y + x^2/2",
    "y dx - x dy + (x^2 + y^2) dx": "x - atan(y/x)",
    "x dx + y dy + (x^2 + y^2) dy": "log(x^2 + y^2)/2 + y",
    "tan(x) dx + cot(y) dy": "sin(y)/cos(x)",
    "sin(x) cos(y) dx + cos(x) sin(y) dy": "cos(x)*cos(y)",
    "exp(x) sin(y) dx + exp(x) cos(y) dy": "exp(x)*sin(y)",
    "cos(y) dx + x sin(y) dy": "x/cos(y)",
    "(1 + x^2) dy - (1 + y^2) dx": "atan(y) - atan(x)",
    "x sqrt(1 - y^2) dx + y sqrt(1 - x^2) dy": "sqrt(1 - x^2) + sqrt(1 - y^2)",
    "(2 x y + 3) dx + (x^2 - 1) dy": "x^2*y + 3*x - y",
    "(3 x^2 y + 2 x y + y^3) dx + (x^2 + y^2) dy": "exp(3*x)*(x^2*y + y^3/3)",
    "y dx + (2 x y - exp(-2 y)) dy": "x*exp(2*y) - log(y)",
    "(4 x y + 3 y^4) dx + (2 x^2 + 5 x y^3) dy": "x^4*y^2 + x^3*y^5",
    "x^2 dy - (x y + y^2) dx": "x/y + log(x)",
    "xdot cos(t) + x sin(t) - 1": "x/cos(t) - tan(t)",
    "(x + 2 y - 3) dy - (2 x - y + 1) dx": "x*y + y^2 - 3*y - x^2 - x",
    "(x + y + 1) dx + (2 x + 2 y - 1) dy": "x + 2*y + 3*log(x + y - 2)",
    "dx + h'(s) x ds": "x*exp(h(s))",
    "r dr - R^2 dphi": "r^2/2 - R^2*phi",
    "r^2 dphi + 2 r phi dr": "r^2*phi",
    "l cos(theta) thetadot - xdot": "x - l*sin(theta)",
    "(x - v t) (xdot - v) + y ydot": "(x - v*t)^2 + y^2",
    "y z dx - x z dy + x y dz": "x*z/y",
    "(y + z) dx + (z + x) dy + (x + y) dz": "x*y + y*z + z*x",
    "(y^2 + y z) dx + (z^2 + z x) dy + (y^2 - x y) dz": "y*(x + z)/(y + z)",
    "(x dx + y dy + z dz)/(x^2 + y^2 + z^2)": "x^2 + y^2 + z^2",
    "x dz - z dx + x dy - y dx": "(y + z)/x",
    "2 x z dx + 2 y z dy - (x^2 + y^2) dz": "(x^2 + y^2)/z",
    "y dx + x dy + x y t dt": "x*y*exp(t^2/2)",
    "(1 + y z) dx + x (z - x) dy - (1 + x y) dz": "(1 + x*y)/(z - x)",
    "y z (y + z) dx + x z (x + z) dy + x y (x + y) dz": "x*y*z/(x + y + z)",
    "y z dx + 2 x z dy + 3 x y dz": "x*y^2*z^3",
    "dx/sqrt(R^2 - x^2) + dy": "atan(x/sqrt(R^2 - x^2)) + y",
    "log(x) dx + x^2 exp(k y) dy + t sin(t) x^2 dt": "-(log(x) + 1)/x + exp(k*y)/k + sin(t) - t*cos(t)",
    "sin(theta)^2 dtheta + dphi": "theta/2 - sin(theta)*cos(theta)/2 + phi",
    "(2 x^2 + 2 x y + 2 x z^2 + 1) dx + dy + 2 z dz": "(x + y + z^2)*exp(x^2)",
    "(y^2 exp(x y^2) + 4 x^3) dx + (2 x y exp(x y^2) - 3 y^2) dy": "exp(x*y^2) + x^4 - y^3",
    "z y dx - z x dy + (x^2 + y^2) dz": "log(z) - atan(y/x)",
    "dy - sqrt(1 - y^2) dx": "asin(y) - x",
    "sin(x)^2 cos(x) dx + dy": "sin(x)^3/3 + y",
    "dy - dx/(x^2 + a^2)": "y - atan(x/a)/a",
    "dy - dx/(x^2 - a^2)": "y - log((x - a)/(x + a))/(2*a)",
    "dy - (x^3 + 1) dx/(x^2 + 3 x + 2)": "y - x^2/2 + 3*x - 7*log(x + 2)",
}

#: Forms without an integral: d(omega) ^ omega is not 0, or none that the functions at hand can say.
NONE = (
    "sin(theta) dx - cos(theta) dy",
    "cos(t) dx + sin(t) dy",
    "dz - y dx",
    "z^2 dx + x dy",
    "dx - R cos(theta) dphi",
    "y dx - x dy + dz",
    "dx + (x/t) dt + (y/x) dy",
    "dy - (x^2 + y^2) dx",
    "dy - exp(x^2) dx",
    "dx - f(t) dt",
)


#: Forms with an integral that is found by none of the factors, or by no antiderivative.
BEYOND = (
    "dx + sin(a t) cos(b t) dt",
    "exp(-a t) sin(b t) dt + dx",
    "(log(x) cos(x) + sin(x)/x) dx + dy",
    "dy + (y cos(x) - sin(2x)) dx",
    "dy - (x + y)^2 dx",
    "cos(x) dx/(1 + sin(x)^2) + dy",
)


@pytest.mark.parametrize("text", EXACT_TEXT)
def test_simple_integrals_to_the_letter(text: str) -> None:
    form = pfaffian(text)
    integral, factor = EXACT_TEXT[text]
    assert integrate(form, frozenset()) == Integral(factor, integral)
    check(form, Integral(factor, integral))


@pytest.mark.parametrize("text", BY_HAND)
def test_integrals_derived_by_hand(text: str) -> None:
    form = pfaffian(text)
    assert proportional(form, BY_HAND[text]), "the table is wrong"
    integral = integrate(form, frozenset())
    assert integral is not None
    check(form, integral)


@pytest.mark.parametrize("text", spread(BEYOND))
def test_an_integral_beyond_the_rules_is_right_or_none(text: str) -> None:
    integral = integrate(pfaffian(text), frozenset())
    if integral is not None:
        check(pfaffian(text), integral)


@pytest.mark.parametrize("text", NONE)
def test_no_integral_is_an_answer_and_little_work(text: str) -> None:
    found, calls = counted(lambda: integrate(pfaffian(text), frozenset()))
    assert found is None
    assert calls < 1_500_000


def test_the_empty_form_has_no_integral() -> None:
    assert integrate(Pfaffian({}, ex.ZERO), frozenset()) is None
    hidden = parse_expression("sin(x)^2 + cos(x)^2 - 1", NAMES)
    assert integrate(Pfaffian({"x": hidden}, ex.ZERO), frozenset()) is None


def test_a_hidden_zero_is_no_coefficient() -> None:
    hidden = parse_expression("(x + y)^2 - x^2 - 2 x y - y^2", NAMES)
    assert integrate(Pfaffian({"x": ex.ONE, "y": hidden}, ex.ZERO), frozenset()) == Integral(None, "x = C")


def test_the_constant_takes_a_free_name() -> None:
    c, x = ex.parameter("C"), ex.coordinate("x")
    assert integrate(Pfaffian({"x": ex.ONE, "y": c}, ex.ZERO), frozenset()) == Integral(None, "x + C*y = C1")
    assert integrate(Pfaffian({"C1": c, "x": x}, ex.ZERO), frozenset()) == Integral(None, "C*C1 + x^2/2 = C2")


def test_positive_symbols_are_their_own_absolute_value() -> None:
    form = pfaffian("dy - dx/sqrt(x^2 R^2)")
    integral = integrate(form, frozenset((ex.parameter("R"), ex.coordinate("x"))))
    assert integral is not None
    check(form, integral)


def test_the_same_form_always_gives_the_same_integral() -> None:
    texts = ("(x + y) dx + (y - x) dy", "y z dx + 2 x z dy + 3 x y dz")
    for text in texts:
        assert len({integrate(pfaffian(text), frozenset()) for _ in range(3)}) == 1


@pytest.mark.sweep
def test_hard_and_large_forms_end() -> None:
    dense = " + ".join(f"{i} x^{i % 4} y^{i % 3} z^{i % 5} sin(theta + {i} x) exp(k y)" for i in range(1, 12))
    texts = (
        f"({dense}) dx + ({dense}) y dy + dz",
        "(a x^3 y + R x y^2 + k) dx + (b x^2 y^2 + l x y + v) dy",
        "(2 - a R^2 + y - 2 x - 2 y^2 + a y R^2) dy + (6 + 2 a) dx",
        "sqrt(x^2 + y^2) dx + atan(x y) dy + log(x + y) dz + abs(x) dtheta",
        "(x + y + z + s + r + phi)^5 dx + (x y z s r phi + 1)^3 dy",
    )
    for text in texts:
        found, calls = counted(partial(integrate, pfaffian(text), frozenset()))
        assert calls < 10_000_000
        if found is not None:
            check(pfaffian(text), found)


def test_a_common_factor_of_any_size_is_taken_out() -> None:
    dense = " + ".join(f"{i} x^{i % 4} y^{i % 3} z^{i % 5} sin(theta + {i} x) exp(k y)" for i in range(1, 12))
    found = integrate(pfaffian(f"({dense}) dx + ({dense}) y dy"), frozenset())
    assert found is not None
    assert found.integral == "2*x + y^2 = C"
    assert len(found.factor or "") < 600


@pytest.mark.parametrize("text", ["x dy + y dx", "dx - R dphi", "x xdot + y ydot", "x dy - y dx"])
def test_easy_forms_are_little_work(text: str) -> None:
    form = pfaffian(text)
    assert calls_of(lambda: integrate(form, frozenset())) < 80_000


def test_an_integral_does_without_sympy() -> None:
    code = (
        "import sys; from dofkit.expressions import tree as ex;"
        "from dofkit.integrability.integrals.search import integrate;"
        "from dofkit.relations.normal.normal_form import Pfaffian; x, y = map(ex.coordinate, 'xy');"
        "assert integrate(Pfaffian({'x': y, 'y': x}, ex.ZERO), frozenset()).integral == 'x*y = C';"
        "assert 'sympy' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


# -- a law -----------------------------------------------------------------------------------------

x, y, z, theta, R = (*map(ex.coordinate, ("x", "y", "z", "theta")), ex.parameter("R"))
LEAVES = st.sampled_from((x, y, z, theta, R, ex.TIME, ex.ONE, ex.num(2), ex.num(-3)))
FUNCTIONS = st.sampled_from(("sin", "cos", "exp"))


def _grow(inner: st.SearchStrategy[Expr]) -> st.SearchStrategy[Expr]:
    pairs = st.tuples(inner, inner)
    return st.one_of(
        pairs.map(lambda p: p[0] + p[1]),
        pairs.map(lambda p: p[0] * p[1]),
        inner.map(lambda e: e * e),
        st.tuples(FUNCTIONS, LEAVES).map(lambda p: ex.fn(*p)),
    )


SMALL = st.recursive(LEAVES, _grow, max_leaves=5)


@settings(max_examples=8)
@given(f=SMALL, mu=SMALL)
def test_the_law_for_any_potential_and_factor(f: Expr, mu: Expr) -> None:
    """Whatever is found of mu df is proportional to it; without a factor it is found."""
    coefficients = {s.args[1]: diff(f, s) for s in (x, y, z, theta)}
    moving = any(not a.is_zero for a in coefficients.values())
    closed = Pfaffian({n: a for n, a in coefficients.items() if not a.is_zero}, diff(f, ex.TIME))
    form = Pfaffian({n: mu * a for n, a in closed.coefficients.items() if not (mu * a).is_zero}, mu * closed.dt)
    for given_form in (closed, form):
        integral = integrate(given_form, frozenset())
        if integral is not None:
            check(given_form, integral)
    if moving and not any(n.op == "fn" for n in ex.nodes(f)):
        simple = integrate(closed, frozenset())
        assert simple is not None
