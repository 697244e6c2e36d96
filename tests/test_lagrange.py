"""Equations of motion against accelerations derived by hand, at random exact points; energy along a run."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import pytest
import sympy

import dofkit
from dofkit import cli
from dofkit.errors import DofkitError, SceneError
from dofkit.exact.field import NoPointError, field_point
from dofkit.exact.program import values
from dofkit.exact.ring import Ring
from dofkit.expr import Expr, coordinate, parameter, substitute, sym, velocity
from dofkit.lagrange import MotionError, MotionReport
from dofkit.lagrange.rates import by_time
from dofkit.scene import Scene
from dofkit.survey import survey
from dofkit.text import Names, parse_expression, parse_relations

POINTS = 3
POSITIVE = ("m", "M", "m1", "m2", "l", "l1", "l2", "g", "k", "R", "J", "I1", "I3", "a", "b", "c", "w", "h")
PARAMETERS = dict.fromkeys(POSITIVE, "positive")


def names_of(scene: Scene, report: MotionReport) -> Names:
    """What the report's texts may mention."""
    known = survey(scene).world.names
    own = {name: parameter(name) for name in report.multipliers}
    return Names(known.coordinates, {**known.parameters, **own}, known.functions, known.arguments, True, True, True)


def zero(text: str, names: Names) -> Expr:
    """The expression that a text says is 0."""
    (found,) = parse_relations(text, names)
    assert found.relation == "="
    return found.left - found.right


def vanishes(e: Expr) -> bool:
    """Is an expression 0 at random points of GF(p), exactly?"""
    ring = Ring([e], frozenset())
    node = ring.node(e)
    tried = 0
    for seed in range(40):
        point = field_point([ring], 100 + seed)
        try:
            if values(ring, point)[node] != 0:
                return False
        except (ZeroDivisionError, NoPointError):
            continue
        tried += 1
        if tried == POINTS:
            return True
    raise AssertionError("no point was found")


def acceleration(name: str) -> Expr:
    return sym("acceleration", name)


def check(scene: Scene, expected: Mapping[str, str], multipliers: Mapping[str, str] | None = None) -> MotionReport:
    """The report's equations hold with the accelerations by hand, and fix them: there is one equation for each."""
    report = dofkit.lagrange(scene)
    names = names_of(scene, report)
    assert set(report.coordinates) == set(expected)
    assert len(report.equations) == len(report.coordinates)
    known = {acceleration(n): parse_expression(text, names) for n, text in expected.items()}
    known |= {parameter(n): parse_expression(text, names) for n, text in (multipliers or {}).items()}
    for text in report.equations:
        assert vanishes(substitute(zero(text, names), known)), text
    assert regular(report, names)
    return report


def regular(report: MotionReport, names: Names) -> bool:
    """Is the matrix of accelerations and multipliers regular? Then no others than those by hand satisfy it."""
    from dofkit.expr import diff

    equations = [zero(text, names) for text in report.equations]
    columns = [acceleration(n) for n in report.coordinates]
    forces = [parameter(n) for n in report.multipliers]
    velocities = [zero(text, names) for text in report.constraints]
    rows = [[diff(e, s) for s in (*columns, *forces)] for e in equations]
    for g in velocities:
        holds = any(s.args[0] == "velocity" for s in g.symbols)
        slopes = [diff(g, velocity(n) if holds else coordinate(n)) for n in report.coordinates]
        rows.append([*slopes, *(parameter("zero") - parameter("zero") for _ in forces)])
    flat = [e for row in rows for e in row]
    ring = Ring(flat, frozenset())
    nodes = [[ring.node(e) for e in row] for row in rows]
    from flint import nmod_mat

    for seed in range(40):
        point = field_point([ring], 7 + seed)
        try:
            found = values(ring, point)
        except (ZeroDivisionError, NoPointError):
            continue
        matrix = nmod_mat([[int(found[i]) for i in row] for row in nodes], point.p)
        return not rows or int(matrix.rank()) == len(rows)
    raise AssertionError("no point was found")


# The lectures' systems: accelerations by Newton's law, or known solutions.

ROD = "(m2 l sin(theta) thetadot^2/2 + 3 m2 g sin(theta) cos(theta)/4 - k x + F(t))/(m1 + m2 - 3 m2 cos(theta)^2/4)"
TROLLEY = "(m l sin(theta) thetadot^2 + m g sin(theta) cos(theta) - k x)/(M + m sin(theta)^2)"
#: a = -g e_z + s r with r.r = l^2, so r.a = -v^2 and s = (g z - v^2)/l^2; here below the point of suspension.
STRING = "((-g sqrt(l^2 - x^2 - y^2) - xdot^2 - ydot^2 - (x xdot + y ydot)^2/(l^2 - x^2 - y^2))/l^2)"
PLANE_STRING = "((-g sqrt(l^2 - x^2) - xdot^2 - x^2 xdot^2/(l^2 - x^2))/l^2)"
BELOW = "(l1 (2 m1 + m2 - m2 cos(2 theta1 - 2 theta2)))"
LECTURE: dict[str, dict[str, str]] = {
    "simple-pendulum-lagrangian": {"theta": "-g sin(theta)/l"},
    "damped-motion-exponential": {"x": "-(g xdot + k x)/m"},
    "damped-motion-free": {"x": "-g xdot/m"},
    "sliding-ladder-angle": {"theta": "-3 g cos(theta)/(2 l)"},
    "sliding-ladder-centre": {"theta": "-3 g cos(theta)/(2 l)"},
    "bead-on-wire-arc-length": {"s": "-g h'(s)"},
    "spring-pendulum": {
        "x": "(l + x) thetadot^2 + g cos(theta) - k x/m",
        "theta": "-(2 xdot thetadot + g sin(theta))/(l + x)",
    },
    "cart-spring-hinged-rod": {"x": ROD, "theta": f"-3 (cos(theta) {ROD} + g sin(theta))/(2 l)"},
    "mass-on-spring": {"x": "-k x/m"},
    "orbit-polar": {"r": "r thetadot^2 - G M/r^2", "theta": "-2 rdot thetadot/r"},
    "orbit-three-variables": {
        "x": "-G M x/(x^2 + y^2)^(3/2)",
        "y": "-G M y/(x^2 + y^2)^(3/2)",
    },
    "rigid-body-in-horizontal-plane": {"x": "0", "y": "0", "theta": "0"},
    "spherical-pendulum-angles": {
        "psi": "-2 psidot phidot cos(phi)/sin(phi)",
        "phi": "psidot^2 sin(phi) cos(phi) + g sin(phi)/l",
    },
    "spherical-pendulum-cartesian": {"x": f"x {STRING}", "y": f"y {STRING}"},
    "spherical-pendulum": {
        "phi": "-2 thetadot phidot cos(theta)/sin(theta)",
        "theta": "phidot^2 sin(theta) cos(theta) - g sin(theta)/l",
    },
    "trolley-pendulum": {"x": TROLLEY, "theta": f"-(cos(theta) {TROLLEY} + g sin(theta))/l"},
    "trolley-pendulum-linearized": {
        "x": "(m g theta - k x)/M",
        "theta": "-((m g theta - k x)/M + g theta)/l",
    },
    "damped-oscillator": {"x": "(F(t) - c xdot - k x)/m"},
    "disc-string-springs-mass": {
        "phi": "(k2 R (x - R phi) - k1 R^2 phi)/J",
        "x": "g - k2 (x - R phi)/m",
    },
    "free-particle-in-space": {"x": "0", "y": "0", "z": "-g"},
    "pendulum-cartesian": {"x": f"x {PLANE_STRING}"},
    "pendulum-angle": {"theta": "-g sin(theta)/l"},
    "pendulum-small-angles": {"theta": "-g theta/l"},
    "double-pendulum-lagrangian": {
        "theta1": "(-g (2 m1 + m2) sin(theta1) - m2 g sin(theta1 - 2 theta2) - 2 sin(theta1 - theta2) m2 "
        f"(theta2dot^2 l2 + theta1dot^2 l1 cos(theta1 - theta2)))/{BELOW}",
        "theta2": "2 sin(theta1 - theta2) (theta1dot^2 l1 (m1 + m2) + g (m1 + m2) cos(theta1) "
        f"+ theta2dot^2 l2 m2 cos(theta1 - theta2)) l1/(l2 {BELOW})",
    },
    "atwood-machine": {"x1": "g (m1 - m2)/(m1 + m2)"},
    "atwood-machine-one-coordinate": {"x": "g (m1 - m2)/(m1 + m2)"},
    "bead-on-parabola": {"x": "-(4 a^2 x xdot^2 + 2 a g x)/(1 + 4 a^2 x^2)"},
    "bead-on-parabola-one-coordinate": {"x": "-(4 a^2 x xdot^2 + 2 a g x)/(1 + 4 a^2 x^2)"},
}


def test_every_scene_with_energies_has_its_accelerations() -> None:
    given = {n for n in dofkit.catalog_names() if dofkit.load(n).energies is not None}
    assert given == set(LECTURE)


@pytest.mark.parametrize("name", sorted(LECTURE))
def test_lecture(name: str) -> None:
    check(dofkit.load(name), LECTURE[name])


def test_the_lectures_four_answers() -> None:
    report = dofkit.lagrange(dofkit.load("simple-pendulum-lagrangian"))
    assert report.momenta == {"theta": "l^2*m*thetadot"}
    assert report.forces == {"theta": "-g*l*m*sin(theta)"}
    assert report.equations == ["l^2*m*thetaddot + g*l*m*sin(theta) = 0"]
    assert "action" in report.action
    damped = dofkit.lagrange(dofkit.load("damped-oscillator"))
    assert damped.forces == {"x": "-c*xdot + F(t) - k*x"}
    orbit = dofkit.lagrange(dofkit.load("orbit-polar"))
    assert orbit.cyclic == ["theta"]
    assert [(c.name, c.quantity) for c in orbit.conserved][0] == ("p_theta", "m*r^2*thetadot")


def scene(*constraints: Any, coordinates: str = "", **more: Any) -> Scene:
    made = {"parameters": PARAMETERS, "coordinates": coordinates.split(), "constraints": list(constraints)}
    return dofkit.load({**made, **more})


PLANE = "m (xdot^2 + ydot^2)/2"


def energies(kinetic: str, potential: str = "0", **more: Any) -> dict[str, Any]:
    return {"energies": {"kinetic": kinetic, "potential": potential, **more}}


def test_a_bead_on_a_rotating_rod() -> None:
    """Along the rod r'' = w^2 r; x = r cos(w t) gives x'' = -2 w rdot sin(w t)."""
    rod = scene("x sin(w t) - y cos(w t) = 0", coordinates="x y", **energies(PLANE))
    report = check(rod, {"x": "-2 w sin(w t) (xdot + w x tan(w t))/cos(w t)"})
    assert not report.multipliers
    assert not report.conserved


def test_a_string_written_twice() -> None:
    report = check(
        scene(
            "y1 + y2 = l",
            "2 y1 = 2 l - 2 y2",
            coordinates="y1 y2",
            **energies("2 y1dot^2 + 3 y2dot^2/2", "-4 g y1 - 3 g y2"),
        ),
        {"y1": "g/7"},
    )
    assert report.left_out == ["c2"]
    assert report.momenta == {"y1": "7*y1dot"}
    assert report.forces == {"y1": "g"}


def test_a_disc_driven_by_a_torque() -> None:
    """With x' = R c phi', y' = R s phi' the torque moves J + m R^2; lam1 = -m x'', lam2 = -m y''."""
    turning = f"(h/(I3 + m R^2))"
    disc = scene(
        "dx = R cos(theta) dphi",
        "dy = R sin(theta) dphi",
        coordinates="x y theta phi",
        **energies(f"{PLANE} + I1 thetadot^2/2 + I3 phidot^2/2", forces={"phi": "h"}),
    )
    x = f"(R cos(theta) {turning} - R sin(theta) thetadot phidot)"
    y = f"(R sin(theta) {turning} + R cos(theta) thetadot phidot)"
    report = check(disc, {"x": x, "y": y, "theta": "0", "phi": turning}, {"lam1": f"-m {x}", "lam2": f"-m {y}"})
    assert [c.name for c in report.conserved] == ["p_theta"]


def test_rolling_that_integrates_is_eliminated() -> None:
    """s'' = g sin(a)/(1 + J/(m R^2)) down an incline; the constant does not enter."""
    rolling = scene("sdot = R phidot", coordinates="s phi", **energies("m sdot^2/2 + J phidot^2/2", "-m g s sin(a)"))
    report = check(rolling, {"s": "g sin(a)/(1 + J/(m R^2))"})
    assert report.multipliers == []


def test_rolling_whose_constant_enters_keeps_a_multiplier() -> None:
    both = energies("m sdot^2/2 + J phidot^2/2", "k s^2/2 + k phi^2/2")
    total = "(-(R k s + k phi)/(m R^2 + J))"
    report = check(
        scene("sdot = R phidot", coordinates="s phi", **both),
        {"s": f"R {total}", "phi": total},
        {"lam1": f"-m R {total} - k s"},
    )
    assert report.constraints == ["-R*phidot + sdot = 0"]


def test_a_block_on_a_movable_wedge() -> None:
    """The block's horizontal acceleration is g sin cos M/(M + m sin^2) down the slope, the wedge's m/M of it back."""
    wedge = scene(
        "y1 = h - (x1 - x2) tan(b)",
        coordinates="x1 y1 x2",
        **energies("m (x1dot^2 + y1dot^2)/2 + M x2dot^2/2", "m g y1"),
    )
    x1 = "(M g sin(b) cos(b)/(M + m sin(b)^2))"
    report = check(wedge, {"x1": x1, "y1": f"-tan(b) ({x1} + m {x1}/M)"})
    assert report.eliminated.keys() == {"x2"}


def test_a_sleigh_slides_on_its_edge() -> None:
    """A knife edge at the centre of mass: thetaddot = 0, and the force turns the velocity with the edge."""
    sleigh = scene("sin(theta) dx = cos(theta) dy", coordinates="x y theta", **energies(f"{PLANE} + J thetadot^2/2"))
    report = dofkit.lagrange(sleigh)
    assert report.coordinates == ["x", "y", "theta"]
    names = names_of(sleigh, report)
    along = parse_expression("a", names)
    on = {
        velocity("x"): parse_expression("a cos(theta)", names),
        velocity("y"): parse_expression("a sin(theta)", names),
    }
    moved = {acceleration("x"): parse_expression("-a sin(theta) thetadot", names)}
    moved |= {acceleration("y"): parse_expression("a cos(theta) thetadot", names)}
    moved |= {
        acceleration("theta"): parse_expression("0", names),
        parameter("lam1"): parse_expression("m a thetadot", names),
    }
    assert along is not None
    for text in report.equations:
        assert vanishes(substitute(substitute(zero(text, names), moved), on)), text
    assert {c.name for c in report.conserved} == {"p_theta", "energy"}


def test_a_driven_pivot() -> None:
    pivot = scene(
        "x = f(t) + l sin(theta)", "y = -l cos(theta)", coordinates="x y theta", functions={"f": ["t"]},
        **energies(PLANE, "m g y"),
    )  # fmt: skip
    report = check(pivot, {"theta": "-(g sin(theta) + cos(theta) diff(f(t), t, 2))/l"})
    assert not report.conserved


def test_an_unknown_profile_that_moves() -> None:
    """y = h(x - f(t)): with u = x - f, T = m (xdot^2 + h'^2 udot^2)/2."""
    hill = scene(
        "y = h(x - f(t))", coordinates="x y", functions={"h": ["s"], "f": ["t"]},
        parameters={"m": "positive", "g": "positive"}, **energies(PLANE, "m g y"),
    )  # fmt: skip
    slope, bend = "h'(x - f(t))", "h''(x - f(t))"
    rate = "(xdot - diff(f(t), t))"
    expected = f"-{slope} ({bend} {rate}^2 - {slope} diff(f(t), t, 2) + g)/(1 + {slope}^2)"
    check(hill, {"x": expected})


def test_inequalities_and_springs_are_no_constraints() -> None:
    fly = scene("x^2 + y^2 + z^2 <= R^2", coordinates="x y z", **energies(f"{PLANE} + m zdot^2/2", "m g z"))
    check(fly, {"x": "0", "y": "0", "z": "-g"})


def test_a_generalized_potential() -> None:
    """V = b (y xdot - x ydot): a charge in a magnetic field, m x'' = 2 b ydot."""
    charge = scene(coordinates="x y", **energies(PLANE, "b (y xdot - x ydot)"))
    report = check(charge, {"x": "2 b ydot/m", "y": "-2 b xdot/m"})
    assert report.conserved[-1].name == "h"


GRAVITY = {"type": "gravity", "acceleration": "g"}


def test_masses_gravity_and_a_link() -> None:
    bob = scene(
        {"type": "link", "between": [[0, 0], "A"], "length": "l"}, dimension=2, forces=[GRAVITY],
        particles=[{"name": "A", "mass": "m", "coordinates": ["x", "y"]}],
    )  # fmt: skip
    check(bob, {"x": f"x {PLANE_STRING}"})


def test_bodies_with_inertia_spring_damper_and_force() -> None:
    """A cart M on a spring and a damper with a rod hinged to it, its centre 2 below the hinge, pushed at its centre."""
    left, cart = [-3, 0], {"on": "C", "at": [-1, 0]}
    made = scene(
        {"type": "prismatic", "between": ["ground", "C"], "axis": [1, 0]},
        {"type": "revolute", "between": ["C", "B"], "at": [0, 0]},
        dimension=2,
        bodies=[{"name": "C", "mass": "M"}, {"name": "B", "mass": "m", "inertia": "J"}],
        configuration={"y_B": -2},
        forces=[
            GRAVITY,
            {"type": "spring", "between": [left, cart], "stiffness": "k", "rest_length": 0},
            {"type": "damper", "between": [left, cart], "damping": "c"},
            {"type": "force", "body": "B", "value": ["h", 0]},
        ],
    )
    push = "(h - c x_Cdot - k (x_C + 2) + 2 m sin(theta_B) theta_Bdot^2)"
    turn = "(2 h cos(theta_B) - 2 m g sin(theta_B))"
    below = "((M + m) (J + 4 m) - 4 m^2 cos(theta_B)^2)"
    check(
        made,
        {
            "x_C": f"((J + 4 m) {push} - 2 m cos(theta_B) {turn})/{below}",
            "theta_B": f"((M + m) {turn} - 2 m cos(theta_B) {push})/{below}",
        },
    )


def test_a_free_top_turns_by_eulers_equations() -> None:
    """With I1 = I2: the spin about the own axis is conserved, and theta'' by Euler's equation for the nutation."""
    top = scene(
        {"type": "fixed", "point": {"on": "B", "at": [0, 0, 0]}},
        bodies=[{"name": "B", "mass": "m", "inertia": ["I1", "I1", "I3"], "coordinates": ["x", "y", "z", "phi", "theta", "psi"]}],
    )  # fmt: skip
    spin = "(psidot + phidot cos(theta))"
    turning = f"((I3 {spin} thetadot - 2 I1 phidot thetadot cos(theta))/(I1 sin(theta)))"
    report = check(
        top,
        {
            "phi": turning,
            "theta": f"phidot^2 sin(theta) cos(theta) - I3 {spin} phidot sin(theta)/I1",
            "psi": f"phidot thetadot sin(theta) - cos(theta) {turning}",
        },
    )
    assert [c.name for c in report.conserved] == ["p_phi", "p_psi", "energy"]


def test_hidden_relations_hold_too() -> None:
    """x + y = t and xdot + ydot = z force z = 1: 2 (xddot + xddot) = -1 along what is left."""
    made = scene("x + y = t", "xdot + ydot = z", coordinates="x y z", **energies("xdot^2 + ydot^2 + zdot^2", "x"))
    report = check(made, {"x": "-1/4"})
    assert report.eliminated == {"y": "t - x", "z": "1"}


def test_the_branch_is_that_of_the_reference() -> None:
    above = scene("x^2 + y^2 = l^2", coordinates="x y", configuration={"x": 0, "y": "l"}, **energies(PLANE, "m g y"))
    report = check(above, {"x": "x (g sqrt(l^2 - x^2) - xdot^2 - x^2 xdot^2/(l^2 - x^2))/l^2"})
    assert report.eliminated == {"y": "sqrt(l^2 - x^2)"}
    assert "through the reference configuration" in report.notes[0]


def test_several_roots_are_no_elimination() -> None:
    two = scene(
        "x1^2 + y1^2 = a^2",
        "x2^2 + y2^2 = b^2",
        coordinates="x1 y1 x2 y2",
        **energies("x1dot^2 + y1dot^2 + x2dot^2 + y2dot^2"),
    )
    report = dofkit.lagrange(two)
    assert len(report.multipliers) == 2
    assert report.coordinates == ["x1", "y1", "x2", "y2"]


# Bad input


@pytest.mark.parametrize(
    ("made", "kind", "said"),
    [
        ({"coordinates": ["x"]}, SceneError, "neither `energies` nor masses"),
        ({"coordinates": ["x"], "energies": {"kinetic": "m xdot^2"}}, SceneError, "`m` is not declared"),
        ({"coordinates": ["x"], "energies": {"kinetic": "xddot^2"}}, SceneError, "acceleration of x cannot stand here"),
        ({"coordinates": ["x"], "energies": {"kinetic": "xdot^2", "forces": {"y": 1}}}, SceneError, "no coordinate 'y'"),
        ({"coordinates": ["x"], "constraints": ["x = 1", "x = 2"], "energies": {"kinetic": "xdot^2"}}, SceneError, "inconsistent"),
        ({"particles": [{"name": "A", "mass": 1}, "B"]}, SceneError, "the mass of B is missing"),
        ({"dimension": 2, "bodies": [{"name": "B", "mass": 1}]}, SceneError, "the inertia of B is missing"),
        ({"particles": [{"name": "A", "mass": 1}], "forces": [{"type": "gravity"}]}, SceneError, "`acceleration` of gravity is missing"),
        ({"particles": [{"name": "A", "mass": 1}], "forces": [{"type": "spring", "between": [[0, 0, 0], "A"]}]}, SceneError, "`stiffness` of a spring"),
        ({"particles": [{"name": "A", "mass": 1}], "forces": [{"type": "spring", "between": [[0, 0, 0], "A"], "stiffness": 1}]}, SceneError, "rest_length"),
        ({"particles": [{"name": "A", "mass": 1}], "forces": [{"type": "force", "value": [1, 0, 0]}]}, SceneError, "where the force acts"),
        ({"bodies": [{"name": "B", "mass": 1, "inertia": [1, 2]}]}, SceneError, "three principal moments"),
    ],
)  # fmt: skip
def test_what_cannot_be_derived_is_told(made: dict[str, Any], kind: type[DofkitError], said: str) -> None:
    with pytest.raises(kind, match=said.replace("(", r"\(")):
        dofkit.lagrange(dofkit.load(made))


# Energy along a run, and what is handed over

CONSERVATIVE = (
    "simple-pendulum-lagrangian", "sliding-ladder-angle", "sliding-ladder-centre", "spring-pendulum", "mass-on-spring",
    "orbit-polar", "orbit-three-variables", "spherical-pendulum-angles", "spherical-pendulum-cartesian",
    "spherical-pendulum", "trolley-pendulum", "trolley-pendulum-linearized", "disc-string-springs-mass",
    "free-particle-in-space", "pendulum-cartesian", "pendulum-angle", "pendulum-small-angles", "atwood-machine",
    "double-pendulum-lagrangian", "atwood-machine-one-coordinate", "bead-on-parabola", "rigid-body-in-horizontal-plane",
    "bead-on-parabola-one-coordinate",
)  # fmt: skip
SLEIGH = ("sin(theta) dx = cos(theta) dy",)


def drift(made: Scene) -> float:
    """The change of the reported energy along a run of SymPy's equations, for some parameters."""
    import numpy as np
    from scipy.integrate import solve_ivp

    report = dofkit.lagrange(made)
    (energy,) = (c.quantity for c in report.conserved if c.name == "energy")
    derived = report._derived
    assert derived is not None
    given = report.to_sympy()
    method = given.lagranges_method()
    method.form_lagranges_equations()
    n = len(given.coordinates)
    state = [*given.coordinates, *(q.diff() for q in given.coordinates)]
    flat = sympy.symbols(f"q:{2 * n}")
    from dofkit.lagrange.bridge import Bridge

    bridge = Bridge(report.coordinates, derived.model.positive)
    shown = bridge.sympy(parse_expression(energy, names_of(made, report)))
    constants = {s: sympy.Rational(8 + i, 7) for i, s in enumerate(sorted(shown.free_symbols, key=str))}
    constants |= {s: sympy.Rational(11, 7) for s in method.mass_matrix_full.free_symbols - set(constants)}
    swapped = dict(reversed(list(zip(state, flat, strict=True))))
    order = sorted(swapped, key=lambda s: -s.args[1][1] if s.is_Derivative else 0)

    def plain(e: Any) -> Any:
        for s in order:
            e = e.subs(s, swapped[s])
        return e.subs(constants)

    mass = sympy.lambdify(flat, plain(method.mass_matrix_full))
    forcing = sympy.lambdify(flat, plain(method.forcing_full))
    height = sympy.lambdify(flat, plain(shown))

    def rates(_: float, y: Any) -> Any:
        return np.linalg.solve(mass(*y), np.asarray(forcing(*y)).ravel())[: 2 * n]

    start = np.array([0.3 + 0.1 * i for i in range(n)] + [0.2 - 0.05 * i for i in range(n)])
    run = solve_ivp(rates, (0.0, 1.0), start, method="DOP853", rtol=1e-12, atol=1e-13)
    heights = [float(height(*y)) for y in run.y.T]
    return max(abs(h - heights[0]) for h in heights) / max(1.0, abs(heights[0]))


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_energy_is_conserved_along_a_run(name: str) -> None:
    pytest.importorskip("scipy")
    assert drift(dofkit.load(name)) < 1e-9


def test_what_is_handed_over_suits_both_methods() -> None:
    from sympy.physics.mechanics import KanesMethod, Particle, Point

    report = dofkit.lagrange(dofkit.load("trolley-pendulum"))
    given = report.to_sympy()
    assert len(given.coordinates) == len(given.speeds) == len(given.kinematics) == 2
    assert not given.configuration
    disc = dofkit.lagrange(
        scene("dx = R cos(theta) dphi", "dy = R sin(theta) dphi", coordinates="x y theta phi",
              **energies(f"{PLANE} + I1 thetadot^2/2 + I3 phidot^2/2"))
    ).to_sympy()  # fmt: skip
    assert len(disc.velocity) == 2
    frame = disc.frame
    origin = Point("O")
    origin.set_vel(frame, disc.speeds[0] * frame.x + disc.speeds[1] * frame.y)
    method = KanesMethod(frame, **disc.kanes_arguments())
    rest, star = method.kanes_equations([Particle("P", origin, sympy.Symbol("m", positive=True))], [])
    assert rest.shape == star.shape == (2, 1)


def test_a_report_read_back_is_not_handed_over() -> None:
    report = dofkit.lagrange(dofkit.load("pendulum-angle"))
    again = MotionReport.model_validate(report.model_dump(mode="json"))
    assert again.equations == report.equations
    with pytest.raises(ValueError, match="derive it again"):
        again.to_sympy()
    assert "thetaddot" not in report._repr_latex_()
    assert r"\ddot{\theta}" in report._repr_latex_()


# Small motions


def test_small_motions_of_the_trolley() -> None:
    report = dofkit.lagrange(dofkit.load("trolley-pendulum"), linearize=True)
    small = report.linearized
    assert small is not None
    assert small.mass == [["M + m", "l*m"], ["l*m", "l^2*m"]]
    assert small.damping == [["0", "0"], ["0", "0"]]
    assert small.stiffness == [["k", "0"], ["0", "g*l*m"]]
    assert len(small.frequencies) == 2


def test_a_pendulums_frequency() -> None:
    small = dofkit.lagrange(dofkit.load("pendulum-angle"), linearize=True).linearized
    assert small is not None
    assert small.frequencies == ["sqrt(g)/sqrt(l)"]
    with pytest.raises(MotionError, match="equilibrium"):
        dofkit.lagrange(dofkit.load("sliding-ladder-angle"), linearize=True)


# Speed, and the command line


def test_a_chain_of_five_pendulums() -> None:
    """Planar, unit masses and lengths: T = sum |v_i|^2/2."""
    n = 5
    xs = ["(" + " + ".join(f"cos(q{j}) q{j}dot" for j in range(1, i + 1)) + ")" for i in range(1, n + 1)]
    ys = ["(" + " + ".join(f"sin(q{j}) q{j}dot" for j in range(1, i + 1)) + ")" for i in range(1, n + 1)]
    kinetic = " + ".join(f"{x}^2/2 + {y}^2/2" for x, y in zip(xs, ys, strict=True))
    potential = " - ".join(["0", *(f"{n + 1 - j} g cos(q{j})" for j in range(1, n + 1))])
    chain = scene(coordinates=" ".join(f"q{i}" for i in range(1, n + 1)), **energies(kinetic, potential))
    start = time.process_time()
    report = dofkit.lagrange(chain)
    assert time.process_time() - start < 10
    names = names_of(chain, report)
    for i, text in enumerate(report.equations, 1):
        terms = [
            f"({n + 1 - max(i, j)}) (cos(q{i} - q{j}) q{j}ddot + sin(q{i} - q{j}) q{j}dot^2)" for j in range(1, n + 1)
        ]
        expected = parse_expression(" + ".join(terms) + f" + {n + 1 - i} g sin(q{i})", names)
        assert vanishes(zero(text, names) - expected)


def test_the_command_line(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def run(*arguments: str) -> tuple[int, str]:
        monkeypatch.setattr("sys.argv", ["dofkit", *arguments])
        with pytest.raises(SystemExit) as ended:
            cli.main()
        return int(ended.value.code or 0), capsys.readouterr().out

    status, out = run("lagrange", "orbit-polar", "particle-in-space", "--json")
    told = [json.loads(line) for line in out.splitlines()]
    assert status == 2
    assert told[0]["coordinates"] == ["r", "theta"]
    assert told[1]["scene"] == "particle-in-space"
    assert "neither `energies` nor masses" in told[1]["error"]["message"]
    status, out = run("lagrange", "trolley-pendulum", "--linearize")
    assert status == 0
    assert "Equations of motion" in out
    assert "M = [M + m, l*m; l*m, l^2*m]" in out


def test_the_numbers_are_exact() -> None:
    half = scene(coordinates="x", **energies("0.1 xdot^2", "x/3"))
    report = dofkit.lagrange(half)
    assert report.equations == ["xddot/5 + 1/3 = 0"]
    assert by_time(parameter("m")).is_zero
    assert Fraction(1, 5) == Fraction(2, 10)
