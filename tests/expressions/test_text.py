"""What people write -> the expression it means."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction

import pytest
from shared.work import calls_of

from dofkit.expressions.text import Names, parse_expression, parse_relations, to_text
from dofkit.expressions.tree import (
    DT,
    PI,
    TIME,
    ZERO,
    E,
    Expr,
    call,
    coordinate,
    differential,
    fn,
    num,
    parameter,
    sym,
    velocity,
)

NAMES = Names(
    frozenset({"x", "y", "z", "theta", "phi", "s", "x_A", "y_A", "phi_B", "x1"}),
    {name: parameter(name) for name in ("R", "L", "m", "g", "l", "omega", "v")} | {"a": num(Fraction(3, 2))},
    {"h": 1, "f": 1, "w": 2},
    {"h": ("s",), "f": ("t",), "w": ("x", "t")},
    allow_accelerations=True,
)
x, y, z, theta, phi, s, x1 = (coordinate(n) for n in ("x", "y", "z", "theta", "phi", "s", "x1"))
R, L, m, g, l_, omega, v = (parameter(n) for n in ("R", "L", "m", "g", "l", "omega", "v"))
dx, dy, dphi = differential("x"), differential("y"), differential("phi")
xdot, ydot, thetadot = velocity("x"), velocity("y"), velocity("theta")
xddot = sym("acceleration", "x")


def sin(u: Expr) -> Expr:
    return fn("sin", u)


def cos(u: Expr) -> Expr:
    return fn("cos", u)


READ: dict[str, Expr] = {
    # products side by side
    "2 x y": 2 * x * y,
    "2x": 2 * x,
    "xy": x * y,
    "mgl": m * g * l_,
    "x(y+1)": x * (y + 1),
    "(x+y)(x-y)": (x + y) * (x - y),
    "x (y)": x * y,
    "l^2 zdot^2": l_**2 * velocity("z") ** 2,
    "xy^2": x * y**2,
    "2πR": 2 * PI * R,
    "2piR": 2 * PI * R,
    "vt": v * TIME,
    "y dx": y * dx,
    "ydx": y * dx,
    "2(3)": num(6),
    # a space decides how a quotient reads
    "1/2 m v^2": m * v**2 / 2,
    "g/l sin(theta)": g / l_ * sin(theta),
    "-g/l sin θ": -(g / l_ * sin(theta)),
    "y^2/2 dx": y**2 / 2 * dx,
    "a/2 (x + y)": num(Fraction(3, 4)) * (x + y),
    "1/2 m R² (θ̇² + ω² sin²θ)": m * R**2 * (thetadot**2 + omega**2 * sin(theta) ** 2) / 2,
    "1 / 2 x y": x * y / 2,
    "1/2 |x|": fn("abs", x) / 2,
    "dy/dx x": differential("y") / dx * x,
    # virtual displacements, LaTeX around and within, backslashes that double quotes of YAML took away
    "δx": dx,
    "y δx": y * dx,
    "yδx": y * dx,
    "δ x": dx,
    r"y \delta x": y * dx,
    r"R \cos\theta \, \delta\varphi": R * cos(theta) * dphi,
    "$x y$": x * y,
    r"\(x y\)": x * y,
    r"$$\frac{x}{2}$$": x / 2,
    r"\mathbf{x} + \boldsymbol{\theta}": x + theta,
    "\theta + y": theta + y,
    "2 \frac{x}{2}": x,
    # degrees
    "60°": PI / 3,
    "60 °": PI / 3,
    "30 deg": PI / 6,
    "1.5deg": PI / 120,
    "sin 30°": num(Fraction(1, 2)),
    "90° - x": PI / 2 - x,
    "x + 45 degrees": x + PI / 4,
    r"60^\circ": PI / 3,
    r"60^{\circ}": PI / 3,
    # values of angles that are rational (all others stay as written)
    "sin(pi/6)": num(Fraction(1, 2)),
    "cos(-2pi/3)": num(Fraction(-1, 2)),
    "cos(7pi)": num(-1),
    "sin(7pi/6)": num(Fraction(-1, 2)),
    "tan(3pi/4)": num(-1),
    "tan(pi/2)": fn("tan", PI / 2),
    "cos(pi/5)": cos(PI / 5),
    # functions without parentheses
    "R sin(theta) dphi": R * sin(theta) * dphi,
    "R cos theta dphi": R * cos(theta) * dphi,
    "Rcosθdφ": R * cos(theta) * dphi,
    "sin theta": sin(theta),
    "sin 2x": sin(2 * x),
    "sin2x": sin(2 * x),
    "sin 2 x": sin(2 * x),
    "sinθ": sin(theta),
    "sin ωt": sin(omega * TIME),
    "sin theta cos phi": sin(theta) * cos(phi),
    "sin theta * x": sin(theta) * x,
    "sin theta*phidot": sin(theta) * velocity("phi"),
    "sin(theta)/2": sin(theta) / 2,
    "sin(x) y": sin(x) * y,
    "sin x^2": sin(x**2),
    "sin(x)^2": sin(x) ** 2,
    "log sin x": fn("log", sin(x)),
    "sin θ(t)": sin(theta),
    "sqrt3": fn("sqrt", num(3)),
    # powers of functions
    "sin^2(x)": sin(x) ** 2,
    "sin^2 x": sin(x) ** 2,
    "sin²θ": sin(theta) ** 2,
    "sin**2 x cos x": sin(x) ** 2 * cos(x),
    # signs of all kinds
    "−x·y×z²": -(x * y * z**2),
    "x**2": x**2,
    "x³": x**3,
    "x⁻¹": x**-1,
    "x^-1": x**-1,
    "½ x": x / 2,
    "⅓x": x / 3,
    "|x|": fn("abs", x),
    "||x|+y|": fn("abs", fn("abs", x) + y),
    "|x||y|": fn("abs", x) * fn("abs", y),
    "2|x|²": 2 * fn("abs", x) ** 2,
    "√x": fn("sqrt", x),
    "√(x²+y²)": fn("sqrt", x**2 + y**2),
    "[x+(y+1)]^2": (x + y + 1) ** 2,
    "x\u2009y\u00a0z": x * y * z,
    # Greek and subscripts
    "θ": theta,
    "ϑ+ϕ": theta + phi,
    "ω": omega,
    "x_{1}": x1,
    "x_1": x1,
    "x₁²": x1**2,
    "φ_B": coordinate("phi_B"),
    "𝑥²": x**2,
    # motions
    "dx": dx,
    "dt": DT,
    "xdot": xdot,
    "x_dot": xdot,
    "x'": xdot,
    "x’": xdot,
    "ẋ": xdot,
    "x\u0307": xdot,
    "θ̇": thetadot,
    "θdot": thetadot,
    "ẋ_A": velocity("x_A"),
    "xdot_A": velocity("x_A"),
    "xdot1": velocity("x1"),
    "x_Adot": velocity("x_A"),
    "dx_A": differential("x_A"),
    "phi_Bdot": velocity("phi_B"),
    "dphi_B": differential("phi_B"),
    "ẋẏ": xdot * ydot,
    "x'y'": xdot * ydot,
    "dx/dt": xdot,
    "dx / dt": xdot,
    "R dθ/dt": R * thetadot,
    "(x dy + y dx)/dt": x * ydot + y * xdot,
    "dx/dt y": xdot * y,
    "dtheta/dt sin(theta)": thetadot * sin(theta),
    "dy/dx": dy / dx,
    "dy/dx tan(x)": dy / dx * fn("tan", x),
    "xddot": xddot,
    "x''": xddot,
    "ẍ": xddot,
    "x\u0307\u0307": xddot,
    "d^2x/dt^2": xddot,
    "d²x/dt²": xddot,
    "diff(x, t)": xdot,
    "diff(x, t, 2)": xddot,
    "diff(x(t), t)": xdot,
    "x(t)": x,
    "x^2(t)": x**2,
    "x (t)": x,
    "x'(t)": xdot,
    "xdot(t)^2": xdot**2,
    # unknown functions
    "h": call("h", (s,)),
    "h(s)": call("h", (s,)),
    "h(x - f(t))": call("h", (x - call("f", (TIME,)),)),
    "h'": call("h", (s,), (1,)),
    "h'(s)": call("h", (s,), (1,)),
    "h''(s)": call("h", (s,), (2,)),
    "diff(h(s), s)": call("h", (s,), (1,)),
    "diff(h, s, 2)": call("h", (s,), (2,)),
    "dh/ds": call("h", (s,), (1,)),
    "fdot": call("f", (TIME,), (1,)),
    "df/dt": call("f", (TIME,), (1,)),
    "ḣ": call("h", (s,), (1,)) * velocity("s"),
    "dh": call("h", (s,), (1,)) * differential("s"),
    "h(2x) + diff(h(2x), x)": call("h", (2 * x,)) + 2 * call("h", (2 * x,), (1,)),
    "w": call("w", (x, TIME)),
    "diff(w(x, t), x)": call("w", (x, TIME), (1, 0)),
    "partial(w(x, t), t)": call("w", (x, TIME), (0, 1)),
    "diff(w(x, t), t)": call("w", (x, TIME), (1, 0)) * xdot + call("w", (x, TIME), (0, 1)),
    "partial(w(x, x), 1, 2)": call("w", (x, x), (1, 1)),
    # numbers and constants
    "1.5": num(Fraction(3, 2)),
    "0.1": num(Fraction(1, 10)),
    "2e3": num(2000),
    "1e-6": num(Fraction(1, 10**6)),
    ".5x": x / 2,
    "pi + π": 2 * PI,
    "E": E,
    "E^x": fn("exp", x),
    "a": num(Fraction(3, 2)),
    # order of operations
    "-x^2": -(x**2),
    "2^-1": num(Fraction(1, 2)),
    "x^y^z": x ** (y**z),
    "2^3^2": num(512),
    "R/2 * x": R / 2 * x,
    "(1/2)x": x / 2,
    "x/2": x / 2,
    "x - -y": x + y,
    "x*-y": -(x * y),
    "x/y/z": x / (y * z),
    "arcsin(x) + ln y": fn("asin", x) + fn("log", y),
    "atan2(y, x)": fn("atan2", y, x),
    # LaTeX
    r"\frac{1}{2} m \dot{x}^2": m * xdot**2 / 2,
    r"\frac12 m \dot{x}^2": m * xdot**2 / 2,
    r"\sqrt2 x": fn("sqrt", num(2)) * x,
    r"\dot\theta - \omega t": thetadot - omega * TIME,
    r"\ddot{x} + g": xddot + g,
    r"R\sin\theta\,d\phi": R * sin(theta) * dphi,
    r"R \cos\theta \, \mathrm{d}\phi": R * cos(theta) * dphi,
    r"x^{2}+y^{2}": x**2 + y**2,
    r"\left(x+y\right)\cdot z": (x + y) * z,
    r"\cos\theta \frac{\mathrm{d}x}{\mathrm{d}t}": cos(theta) * xdot,
    r"\dot{x}_{A} + \dot{x_A}": 2 * velocity("x_A"),
    r"\sqrt{x^2+y^2}": fn("sqrt", x**2 + y**2),
}


@pytest.mark.parametrize("text", READ)
def test_reading(text: str) -> None:
    assert parse_expression(text, NAMES) == READ[text]


@pytest.mark.parametrize("text", READ)
def test_a_value_alone_is_an_equation_with_zero(text: str) -> None:
    (relation,) = parse_relations(text, NAMES)
    assert (relation.left, relation.relation, relation.right) == (READ[text], "=", ZERO)


RELATIONS = {
    "x^2 + y^2 = L^2": ["x^2 + y^2 = L^2 @11"],
    "x==y": ["x = y @2"],
    "x ≤ 3": ["x <= 3 @3"],
    "0 <= x <= L": ["0 <= x @3", "x <= L @8"],
    "0≤x<L": ["0 <= x @2", "x < L @4"],
    "x = y = z": ["x = y @3", "y = z @7"],
    "ẋ cos θ ≥ 0": ["xdot*cos(theta) >= 0 @9"],
    r"\theta \ge 0": ["theta >= 0 @8"],
    "  x = y \n": ["x = y @5"],
    "  x": ["x = 0 @3"],
}


@pytest.mark.parametrize("text", RELATIONS)
def test_relations(text: str) -> None:
    found = parse_relations(text, NAMES)
    assert [f"{to_text(c.left)} {c.relation} {to_text(c.right)} @{c.column}" for c in found] == RELATIONS[text]


def test_declared_names_win_over_derived_ones() -> None:
    names = Names(frozenset({"x"}), {"dx": parameter("dx"), "xdot": parameter("xdot"), "E": parameter("E")})
    assert parse_expression("dx + xdot + E", names) == parameter("dx") + parameter("xdot") + parameter("E")
    assert parse_expression("x'", names) == velocity("x")


@pytest.mark.parametrize("declared", ["θ_1", "theta_1", "theta1", "θ1"])
@pytest.mark.parametrize("written", ["θ_1", "theta_1", r"\theta_{1}", "θ₁", "ϑ₁"])
def test_greek_letters_and_their_names_are_one_name(declared: str, written: str) -> None:
    names = Names(frozenset({declared}))
    assert parse_expression(written, names) == coordinate(declared)
    assert parse_expression(f"d{written}", names) == differential(declared)


def test_x1_and_x_1_stay_apart_where_both_are_declared() -> None:
    names = Names(frozenset({"x1", "x_1"}))
    assert parse_expression("x1 - x_1", names) == coordinate("x1") - coordinate("x_1")


def test_a_parameter_may_stand_for_a_coordinate() -> None:
    names = Names(frozenset({"x_A"}), {"x": coordinate("x_A")})
    assert parse_expression("x' + dx/dt + x(t)", names) == 2 * velocity("x_A") + coordinate("x_A")


def test_a_python_keyword_may_be_declared() -> None:
    names = Names(frozenset({"lambda", "in"}))
    assert parse_expression("λ in", names) == coordinate("lambda") * coordinate("in")


def test_nothing_depends_on_the_hash_seed() -> None:
    code = (
        "from dofkit.expressions.text import *;"
        "n = Names(frozenset('abcdefghijk'), {}, {'u': 3}, allow_accelerations=True);"
        "print(to_text(parse_expression('diff(u(a*b, c*k, j) , t, 2)', n)))"
    )
    runs = {
        subprocess.run(
            [sys.executable, "-c", code], env={"PYTHONHASHSEED": seed}, capture_output=True, check=True
        ).stdout
        for seed in ("1", "2")
    }
    assert len(runs) == 1


def test_importing_loads_no_heavy_package() -> None:
    code = "import sys, dofkit.expressions.text; print(sorted({'sympy', 'lark', 'numpy'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout.strip() == b"[]"


def test_a_typical_text_is_read_with_little_work() -> None:
    """A thousand calls of functions are some 0.2 ms."""
    text = "dx - R cos(theta) dphi = L*y"
    parse_relations(text, NAMES)
    assert calls_of(lambda: parse_relations(text, NAMES)) < 1500
