"""Equations of motion against accelerations derived by hand, at random exact points; energy along a run."""

from __future__ import annotations

from typing import Any

import pytest
from shared.known_scenes import spread
from shared.motions import PLANE, acceleration, check, energies, names_of, scene, vanishes, zero
from shared.work import counted

import dofkit
from dofkit.base.errors import SceneError
from dofkit.expressions.calculus import substitute
from dofkit.expressions.text import parse_expression
from dofkit.expressions.text.names import Names
from dofkit.expressions.tree import ZERO, Expr, parameter, velocity
from dofkit.motion.lagrange.model import NoEquationsError

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


@pytest.mark.parametrize("name", spread(sorted(LECTURE), 2))
def test_lecture(name: str) -> None:
    check(dofkit.load(name), LECTURE[name])


def test_the_lectures_four_answers() -> None:
    report = dofkit.lagrange(dofkit.load("simple-pendulum-lagrangian"))
    assert report.momenta == {"theta": "m*l^2*thetadot"}
    assert report.forces == {"theta": "-m*g*l*sin(theta)"}
    assert report.equations == ["m*l^2*thetaddot + m*g*l*sin(theta) = 0"]
    assert "action" in report.action
    damped = dofkit.lagrange(dofkit.load("damped-oscillator"))
    assert damped.forces == {"x": "-c*xdot + F(t) - k*x"}
    orbit = dofkit.lagrange(dofkit.load("orbit-polar"))
    assert orbit.cyclic == ["theta"]
    assert next((c.name, c.quantity) for c in orbit.conserved) == ("p_theta", "m*r^2*thetadot")


def test_a_bead_on_a_rotating_rod() -> None:
    """Along the rod r'' = w^2 r; x = r cos(w t) gives x'' = -2 w rdot sin(w t)."""
    rod = scene("x sin(w t) - y cos(w t) = 0", coordinates="x y", **energies(PLANE))
    report = check(rod, {"x": "-2 w sin(w t) (xdot + w x tan(w t))/cos(w t)"})
    assert not report.multipliers
    assert not report.conserved


def test_a_bead_on_a_hoop_that_is_turned() -> None:
    """The hoop does work: h = sum qdot p - L is conserved, T + V is not. The squares of sines add up to one."""
    hoop = scene(
        "x = l sin(a1) cos(w t)", "y = l sin(a1) sin(w t)", "z = -l cos(a1)", coordinates="x y z a1",
        **energies(f"{PLANE} + m zdot^2/2", "m g z"),
    )  # fmt: skip
    report = check(hoop, {"a1": "sin(a1) (w^2 cos(a1) - g/l)"})
    assert report.lagrangian == "m*l^2*a1dot^2/2 + m*l^2*w^2*sin(a1)^2/2 + m*g*l*cos(a1)"
    (found,) = report.conserved
    assert found.name == "h"
    assert "do work" not in found.reason


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
    turning = "(h/(I3 + m R^2))"
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
    report = check(wedge, {"x1": x1, "x2": f"-m {x1}/M"})
    assert report.eliminated.keys() == {"y1"}
    assert report.coordinates == dofkit.classify(wedge).generalized_coordinates


def test_what_is_kept_is_what_the_report_calls_generalized_coordinates() -> None:
    """The angle gives x and y, and not the other way round; of joints, too."""
    rod = {"name": "B", "mass": "m", "inertia": "J", "coordinates": ["x", "y", "theta"]}
    pinned = scene(
        {"type": "revolute", "between": ["ground", "B"], "at": [0, 0]},
        dimension=2, bodies=[rod], configuration={"x": 0, "y": -2}, forces=[GRAVITY],
    )  # fmt: skip
    assert dofkit.classify(pinned).generalized_coordinates == ["theta"]
    check(pinned, {"theta": "-2 m g sin(theta)/(J + 4 m)"})
    ladder = dofkit.load("sliding-ladder-centre")
    assert dofkit.classify(ladder).generalized_coordinates == dofkit.lagrange(ladder).coordinates == ["theta"]


def test_energies_that_would_fill_pages_are_not_tidied() -> None:
    wide = scene(coordinates="x y", **energies("(xdot + ydot + x + y)^60 + xdot^2", "x"))
    report, calls = counted(lambda: dofkit.lagrange(wide))
    assert len(report.equations) == 2
    assert calls < 5_000_000


def test_a_sleigh_slides_on_its_edge() -> None:
    """A knife edge at the centre of mass: thetaddot = 0, and the force turns the velocity with the edge."""
    sleigh = scene("sin(theta) dx = cos(theta) dy", coordinates="x y theta", **energies(f"{PLANE} + J thetadot^2/2"))
    report = dofkit.lagrange(sleigh)
    assert report.coordinates == ["x", "y", "theta"]
    names = names_of(sleigh, report)
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


def test_what_the_scene_leaves_out_is_a_note() -> None:
    """Its energy is conserved only without that."""
    free = scene(coordinates="x", left_out=["the friction of the table"], **energies("m xdot^2/2", "0"))
    assert "Not modelled: the friction of the table." in dofkit.lagrange(free).notes


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
        bodies=[
            {"name": "B", "mass": "m", "inertia": ["I1", "I1", "I3"], "coordinates": [*"xyz", "phi", "theta", "psi"]}
        ],
    )
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
    assert "where parameters are near 1" in dofkit.lagrange(above.model_copy(update={"configuration": {}})).notes[0]


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


ONE = {"particles": [{"name": "A", "mass": 1}]}
SPRING = {"type": "spring", "between": [[0, 0, 0], "A"]}
MOVES = {"kinetic": "xdot^2"}


@pytest.mark.parametrize(
    ("made", "said"),
    [
        ({"coordinates": ["x"]}, "no equations of motion can be derived"),
        ({"coordinates": ["x"], "energies": {"potential": "x"}}, "no equations of motion can be derived"),
        ({"coordinates": ["x"], "energies": {"kinetic": "m xdot^2"}}, "`m` is not declared"),
        ({"coordinates": ["x"], "energies": {"kinetic": "xddot^2"}}, "acceleration of x cannot stand here"),
        ({"coordinates": ["x"], "energies": {**MOVES, "forces": {"y": 1}}}, "no coordinate 'y'"),
        ({"coordinates": ["x"], "constraints": ["x = 1", "x = 2"], "energies": MOVES}, "inconsistent"),
        ({"particles": [{"name": "A", "mass": 1}, "B"]}, "the mass of B is missing"),
        ({"dimension": 2, "bodies": [{"name": "B", "mass": 1}]}, "the inertia of B is missing"),
        ({**ONE, "forces": [{"type": "gravity"}]}, "`acceleration` of gravity is missing"),
        ({**ONE, "forces": [SPRING]}, "`stiffness` of a spring"),
        ({**ONE, "forces": [{**SPRING, "stiffness": 1}]}, "rest_length"),
        ({**ONE, "forces": [{"type": "force", "value": [1, 0, 0]}]}, "at which the force acts"),
        ({"bodies": [{"name": "B", "mass": 1, "inertia": [1, 2]}]}, "three principal moments"),
    ],
)
def test_what_cannot_be_derived_is_reported(made: dict[str, Any], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        dofkit.lagrange(dofkit.load(made))


def test_of_several_branches_none_is_taken() -> None:
    """On x = 0 a weight falls, on y = 0 it slides: one set of equations would be wrong on the other branch."""
    moves = {"kinetic": "(xdot^2 + ydot^2)/2", "potential": "y"}
    with pytest.raises(NoEquationsError, match="c1 is satisfied on several branches"):
        dofkit.lagrange(dofkit.load({"coordinates": ["x", "y"], "constraints": ["x y = 0"], "energies": moves}))


def test_accelerations_are_no_constraints_of_lagranges() -> None:
    with pytest.raises(SceneError, match="second derivative"):
        dofkit.lagrange(scene("xddot = yddot", coordinates="x y", **energies(PLANE)))


def test_a_constant_velocity_leaves_a_constant_that_does_not_matter() -> None:
    moving = scene("xdot = w", coordinates="x y", **energies(PLANE, "k x^2/2 + m g y"))
    report = check(moving, {"y": "-g"})
    assert report.eliminated == {"x": "C + w*t"}
    assert "initial conditions" in report.notes[0]


def test_energies_that_fix_no_accelerations_are_told() -> None:
    for kinetic, potential, said in (("5", "x", "1 = 0"), ("0", "x y", "holds no velocity")):
        with pytest.raises(NoEquationsError, match=said):
            dofkit.lagrange(scene(coordinates="x y", **energies(kinetic, potential)))
    together = scene(coordinates="x y", **energies("(xdot + ydot)^2", "x^2"))
    assert "do not determine" in dofkit.lagrange(together).notes[-1]


def test_a_ball_rolls() -> None:
    """On the plane without forces its centre and its spin are steady; sloping gravity gives 5/7 of what slides."""
    ball = scene(
        {"type": "roll", "body": "B", "radius": "R"},
        bodies=[{"name": "B", "mass": "m", "inertia": "2 m R^2/5", "coordinates": ["x", "y", "z", *ANGLES]}],
        forces=[{"type": "gravity", "acceleration": "g", "direction": [1, 0, 0]}],
    )
    report = dofkit.lagrange(ball)
    assert report.eliminated == {"z": "R"}
    assert len(report.multipliers) == 2
    names = names_of(ball, report)
    # in space xdot = R wy, ydot = -R wx, and (2/5 m R^2 + m R^2) wy' = m g R
    rates = parse_rates(names)
    accelerations = {acceleration("x"): parse_expression("5 g/7", names), acceleration("y"): ZERO}
    forces = {parameter("lam1"): parse_expression("2 m g/7", names), parameter("lam2"): ZERO}
    for text in report.equations[:2]:
        assert vanishes(substitute(zero(text, names), {**accelerations, **forces}))
    for text in report.equations[2:]:
        assert vanishes(substitute(zero(text, names), {**rates, **forces}))


ANGLES = ("phi", "theta", "psi")


def parse_rates(names: Names) -> dict[Expr, Expr]:
    """The Euler angles' accelerations from w' = (0, 5 g/(7 R), 0), with
    w = (theta' cos phi + psi' sin theta sin phi, theta' sin phi - psi' sin theta cos phi, phi' + psi' cos theta)."""
    turn = "(5 g/(7 R))"
    across = "(psidot thetadot cos(theta))"
    # the rates of wx and wy without theta'' and psi''
    gx = f"(-thetadot phidot sin(phi) + {across} sin(phi) + psidot phidot sin(theta) cos(phi))"
    gy = f"(thetadot phidot cos(phi) - {across} cos(phi) + psidot phidot sin(theta) sin(phi))"
    nutation = f"({turn} sin(phi) - {gx} cos(phi) - {gy} sin(phi))"
    spin = f"((-{turn} cos(phi) - {gx} sin(phi) + {gy} cos(phi))/sin(theta))"
    precession = f"(psidot thetadot sin(theta) - {spin} cos(theta))"
    found = {"theta": nutation, "psi": spin, "phi": precession}
    return {acceleration(n): parse_expression(text, names) for n, text in found.items()}


@pytest.mark.sweep
def test_equations_too_long_to_read_keep_a_multiplier() -> None:
    """Every text can be read back: the grammar takes at most 2000 characters."""
    steep = scene(
        "z = exp(x) sin(a y) + x^3 cos(y)^2/(1 + x^2)", "theta = sin(x y z) + x^2",
        coordinates="x y z theta", **energies(f"{PLANE} + (1 + x^2 y^2) zdot^2/2 + (2 + cos(x)) thetadot^2", "m g z"),
    )  # fmt: skip
    report = dofkit.lagrange(steep)
    assert report.multipliers
    assert all(len(text) <= 2000 for text in report.equations)
    assert "too long" in report.notes[-1]


@pytest.mark.parametrize(
    ("potential", "forces", "frequencies", "unstable"),
    [
        ("m g l cos(theta)", {}, [], True),
        ("-m g l cos(theta)", {"theta": "-l thetadot"}, [], False),  # m l^2 s^2 + l s + m g l
        ("-m g l cos(theta)", {"theta": "l thetadot"}, [], True),
        ("theta^4", {"theta": "-l thetadot"}, [], None),  # s (m l^2 s + l)
        ("theta^2/2 + z^2/2", {"theta": "2 z", "z": "-2 theta"}, [], True),  # flutter: w^2 is not real
        (
            "theta^2/2 + 2 z^2",
            {"theta": "z", "z": "z - theta"},
            ["sqrt(2)"] * 2,
            None,
        ),  # (w^2 - 2)^2 = 0, with resonance
    ],
)
def test_the_growth_of_small_motions(
    potential: str, forces: dict[str, str], frequencies: list[str], unstable: bool | None
) -> None:
    plane = "z" in potential
    given = energies("thetadot^2/2 + zdot^2/2" if plane else "m l^2 thetadot^2/2", potential, forces=forces)
    small = dofkit.lagrange(scene(coordinates="theta z" if plane else "theta", **given), linearize=True).linearized
    assert small is not None
    assert small.unstable is unstable
    assert small.frequencies == frequencies
