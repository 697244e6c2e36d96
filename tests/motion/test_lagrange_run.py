"""Equations of motion along a run, handed over to SymPy, about an equilibrium, and on the command line."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import pytest
import sympy
from shared.command_line import called
from shared.known_scenes import spread, swept
from shared.motions import PLANE, energies, names_of, scene, vanishes, zero
from shared.work import calls_of

import dofkit
from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.text import parse_expression
from dofkit.motion.lagrange.report import MotionReport
from dofkit.scene.scene import Scene

# Energy along a run, and what is handed over

CONSERVATIVE = (
    "simple-pendulum-lagrangian", "sliding-ladder-angle", "sliding-ladder-centre", "spring-pendulum", "mass-on-spring",
    "orbit-polar", "orbit-three-variables", "spherical-pendulum-angles", "spherical-pendulum-cartesian",
    "spherical-pendulum", "trolley-pendulum", "trolley-pendulum-linearized", "disc-string-springs-mass",
    "free-particle-in-space", "pendulum-cartesian", "pendulum-angle", "pendulum-small-angles", "atwood-machine",
    "double-pendulum-lagrangian", "atwood-machine-one-coordinate", "bead-on-parabola", "rigid-body-in-horizontal-plane",
    "bead-on-parabola-one-coordinate",
)  # fmt: skip


def drift(made: Scene, begin: Sequence[float] = ()) -> float:
    """The change of the reported energy along a run of SymPy's equations, for some parameters."""
    import numpy as np
    from scipy.integrate import solve_ivp

    report = dofkit.lagrange(made)
    (energy,) = (c.quantity for c in report.conserved if c.name == "energy")
    derived = report._derived
    assert derived is not None
    method = report.to_sympy()
    method.form_lagranges_equations()
    n = len(report.coordinates)
    state = [*method.q, *method.u]
    flat = sympy.symbols(f"q:{2 * n}")
    bridge = Bridge(report.coordinates, derived.model.positive)
    shown = bridge.to_sympy(parse_expression(energy, names_of(made, report)))
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

    usual = [0.3 + 0.1 * i for i in range(n)] + [0.2 - 0.05 * i for i in range(n)]
    start = np.array(begin or usual)
    run = solve_ivp(rates, (0.0, 1.0), start, method="DOP853", rtol=1e-12, atol=1e-13)
    heights = [float(height(*y)) for y in run.y.T]
    return max(abs(h - heights[0]) for h in heights) / max(1.0, abs(heights[0]))


@pytest.mark.parametrize("name", spread(CONSERVATIVE))
def test_energy_is_conserved_along_a_run(name: str) -> None:
    assert drift(dofkit.load(name)) < 1e-9


def test_energy_is_conserved_with_multipliers() -> None:
    sleigh = scene("sin(theta) dx = cos(theta) dy", coordinates="x y theta", **energies(f"{PLANE} + 2 thetadot^2", "y"))
    assert drift(sleigh, [0.1, 0.2, 0.0, 0.7, 0.0, 0.4]) < 1e-9
    two = scene(
        "x1^2 + y1^2 = 25", "(x2 - x1)^2 + (y2 - y1)^2 = 25", coordinates="x1 y1 x2 y2",
        **energies("m (x1dot^2 + y1dot^2 + x2dot^2 + y2dot^2)/2", "m g (y1 + y2)"),
    )  # fmt: skip
    assert drift(two, [3.0, -4.0, 7.0, -7.0, 0.8, 0.6, 1.4, 1.4]) < 1e-9


BOB: dict[str, Any] = {
    "dimension": 2, "forces": [{"type": "gravity", "acceleration": 10}],
    "particles": [{"name": n, "mass": 1, "coordinates": [f"x{n}", f"y{n}"]} for n in "AB"],
}  # fmt: skip
UPPER = {"type": "link", "between": [[0, 0], "A"], "length": 5}
LOWER = {"type": "link", "between": ["A", "B"], "length": 5}
HANDED: dict[str, tuple[Scene, list[float], list[float]]] = {
    # scene, a state on the constraints
    "disc": (
        scene("dx = 2 cos(theta) dphi", "dy = 2 sin(theta) dphi", coordinates="x y theta phi",
              **energies("(xdot^2 + ydot^2)/2 + 3 thetadot^2/2 + 7 phidot^2/2", forces={"phi": 5})),
        [0.1, 0.2, 0.0, 0.4], [1.0, 0.0, 0.3, 0.5],
    ),
    "sleigh": (
        scene("sin(theta) dx = cos(theta) dy", coordinates="x y theta",
              **energies("(xdot^2 + ydot^2)/2 + 3 thetadot^2/2", "10 y")),
        [0.1, 0.2, 0.0], [0.7, 0.0, 0.4],
    ),
    "two links": (
        scene(UPPER, LOWER, **BOB), [3.0, -4.0, 7.0, -7.0], [0.8, 0.6, 1.4, 1.4],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", HANDED)
def test_what_is_handed_over_suits_sympys_method(name: str) -> None:
    """Its accelerations are Newton's: M a = F + A^T lam and A a = -(dA/dt) v, by hand."""
    import numpy as np

    made, q0, u0 = HANDED[name]
    method = dofkit.lagrange(made).to_sympy()
    method.form_lagranges_equations()
    n = len(q0)
    here = dict(zip([*method.q, *method.u], [*q0, *u0], strict=True))
    told = np.linalg.solve(_at(method.mass_matrix_full, here), _at(method.forcing_full, here)).ravel()[n : 2 * n]
    assert np.allclose(told, BY_HAND[name])


def _at(matrix: Any, state: Any) -> Any:
    import numpy as np

    rates = {q: v for q, v in state.items() if q.is_Derivative}
    return np.array(matrix.xreplace(rates).xreplace(state).evalf(), dtype=float)


def _by_newton(masses: list[float], force: list[float], rows: list[list[float]], rates: list[float]) -> list[float]:
    """Accelerations with M a - A^T lam = F and A a = rates."""
    import numpy as np

    n, k = len(masses), len(rows)
    whole = np.zeros((n + k, n + k))
    whole[:n, :n], whole[:n, n:], whole[n:, :n] = np.diag(masses), -np.array(rows).T, np.array(rows)
    return list(np.linalg.solve(whole, [*force, *rates])[:n])


BY_HAND = {
    # at theta = 0: x'' = 2 phi'', y'' = 2 theta' phi' = 0.3, (7 + 4) phi'' = 5
    "disc": [10 / 11, 0.3, 0.0, 5 / 11],
    # at theta = 0: y'' = theta' x' = 0.28, nothing acts along x
    "sleigh": [0.0, 0.28, 0.0],
    # r.a = -v.v for both links
    "two links": _by_newton(
        [1, 1, 1, 1], [0, -10, 0, -10], [[3, -4, 0, 0], [-4, 3, 4, -3]], [-(0.8**2 + 0.6**2), -(0.6**2 + 0.8**2)]
    ),
}


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
    assert small.mass == [["M + m", "m*l"], ["m*l", "m*l^2"]]
    assert small.damping == [["0", "0"], ["0", "0"]]
    assert small.stiffness == [["k", "0"], ["0", "m*g*l"]]
    assert len(small.frequencies) == 2


def test_a_pendulums_frequency() -> None:
    small = dofkit.lagrange(dofkit.load("pendulum-angle"), linearize=True).linearized
    assert small is not None
    assert small.frequencies == ["sqrt(g/l)"]
    wire = dofkit.lagrange(dofkit.load("bead-on-wire-arc-length"), linearize=True)
    assert wire.linearized is None
    assert "give one as the scene's `configuration`" in wire.notes[-1]


def chain_of_links(n: int) -> Scene:
    """Particles of mass m one below the other, by links of length l."""
    names = ["O", *(f"P{i}" for i in range(1, n + 1))]
    links = [
        {"type": "link", "between": [[0, 0] if i == 0 else names[i], names[i + 1]], "length": "l"} for i in range(n)
    ]
    bobs = [
        {"name": f"P{i}", "mass": "m", "coordinates": [f"x{i}", f"y{i}"], "at": [0, f"-{i}*l"]} for i in range(1, n + 1)
    ]
    return scene(*links, dimension=2, particles=bobs, forces=[{"type": "gravity", "acceleration": "g"}])


def test_small_motions_with_multipliers() -> None:
    """Tensions 2 m g and m g: x1'' = -2 g x1/l + g (x2 - x1)/l, x2'' = -g (x2 - x1)/l; omega^2 = (2 +- sqrt 2) g/l."""
    report = dofkit.lagrange(chain_of_links(2), linearize=True)
    assert len(report.multipliers) == 2
    small = report.linearized
    assert small is not None
    assert small.coordinates == ["x1", "x2"]
    assert small.equilibrium == {"x1": "0", "y1": "-l", "x2": "0", "y2": "-2*l"}
    assert small.mass == [["m", "0"], ["0", "m"]]
    assert small.stiffness == [["3*m*g/l", "-m*g/l"], ["-m*g/l", "m*g/l"]]
    assert small.frequencies == [f"sqrt((2 {sign} sqrt(2))*g/l)" for sign in "+-"]
    assert not small.unstable


def test_small_motions_of_a_pendulum_given_by_a_link() -> None:
    small = dofkit.lagrange(chain_of_links(1), linearize=True).linearized
    assert small is not None
    assert small.equilibrium == {"x1": "0", "y1": "-l"}
    assert small.frequencies == ["sqrt(g/l)"]


def test_small_motions_of_a_disc_on_its_springs() -> None:
    """Rolling along x with x = l phi: (m + J/l^2) x'' = -k x; y follows to second order only."""
    disc = scene(
        "dx = l cos(theta) dphi", "dy = l sin(theta) dphi", coordinates="x y theta phi",
        **energies(f"{PLANE} + J thetadot^2/2 + J phidot^2/2", "k x^2/2 + k theta^2/2"),
    )  # fmt: skip
    small = dofkit.lagrange(disc, linearize=True).linearized
    assert small is not None
    assert small.coordinates == ["x", "theta"]
    assert small.mass == [["m + J/l^2", "0"], ["0", "J"]]
    assert small.stiffness == [["k", "0"], ["0", "k"]]


def test_a_bead_on_a_turning_hoop() -> None:
    """l theta'' = (l w^2 cos(theta) - g) sin(theta)."""
    hoop = scene(coordinates="theta", **energies("m l^2 (thetadot^2 + w^2 sin(theta)^2)/2", "-m g l cos(theta)"))
    small = dofkit.lagrange(hoop, linearize=True).linearized
    assert small is not None
    assert small.equilibrium == {"theta": "0"}
    assert small.frequencies == ["sqrt(g/l - w^2)"]


def test_an_equilibrium_where_what_was_eliminated_has_no_value() -> None:
    """On y + y^3 = x^2, y is x^2 to second order: m x'' = -2 m g x."""
    bowl = scene("y + y^3 = x^2", coordinates="x y", **energies(PLANE, "m g y"))
    small = dofkit.lagrange(bowl, linearize=True).linearized
    assert small is not None
    assert small.coordinates == ["x"]
    assert small.stiffness == [["2*m*g"]]


def test_nothing_rests_where_time_enters_a_constraint() -> None:
    rod = scene("x^2 + y^3 + y = t", coordinates="x y", **energies(PLANE, "m g y"))
    report = dofkit.lagrange(rod, linearize=True)
    assert report.linearized is None
    assert "Not linearized" in report.notes[-1]


def test_a_hanging_mass_rests_where_its_spring_holds_it() -> None:
    """m x'' + k x = m g: about x = m g/k with k/m = omega^2."""
    hanging = scene(coordinates="x", configuration={"x": "m g/k"}, **energies("m xdot^2/2", "k x^2/2 - m g x"))
    small = dofkit.lagrange(hanging, linearize=True).linearized
    assert small is not None
    assert small.equilibrium == {"x": "g*m/k"}
    assert small.frequencies == ["sqrt(k/m)"]


# Speed, and the command line


def chain_in_angles(n: int) -> Scene:
    """Planar, unit masses and lengths: T = sum |v_i|^2/2."""
    xs = ["(" + " + ".join(f"cos(q{j}) q{j}dot" for j in range(1, i + 1)) + ")" for i in range(1, n + 1)]
    ys = ["(" + " + ".join(f"sin(q{j}) q{j}dot" for j in range(1, i + 1)) + ")" for i in range(1, n + 1)]
    kinetic = " + ".join(f"{x}^2/2 + {y}^2/2" for x, y in zip(xs, ys, strict=True))
    potential = " - ".join(["0", *(f"{n + 1 - j} g cos(q{j})" for j in range(1, n + 1))])
    return scene(coordinates=" ".join(f"q{i}" for i in range(1, n + 1)), **energies(kinetic, potential))


def chain_in_all(n: int) -> Scene:
    """The same with the places of all masses, which the angles give."""
    before = ["0", *(f"{{}}{i}" for i in range(1, n))]
    ties = [f"x{i + 1} = {b.format('x')} + sin(q{i + 1})" for i, b in enumerate(before)]
    ties += [f"y{i + 1} = {b.format('y')} - cos(q{i + 1})" for i, b in enumerate(before)]
    names = [f"{c}{i}" for c in "xyq" for i in range(1, n + 1)]
    kinetic = " + ".join(f"(x{i}dot^2 + y{i}dot^2)/2" for i in range(1, n + 1))
    potential = " + ".join(f"g y{i}" for i in range(1, n + 1))
    return scene(*ties, coordinates=" ".join(names), **energies(kinetic, potential))


@pytest.mark.sweep
@pytest.mark.parametrize("made", [chain_in_angles, chain_in_all])
def test_a_longer_chain_is_not_much_more_work(made: Callable[[int], Scene]) -> None:
    """About n^3 terms: from three to five pendulums (5/3)^3 = 4.6."""
    three, five = (calls_of(partial(dofkit.lagrange, made(n))) for n in (3, 5))
    assert five < 15 * three


@pytest.mark.sweep
@pytest.mark.parametrize("n", [3, swept(5)])
@pytest.mark.parametrize("made", [chain_in_angles, chain_in_all])
def test_a_chain_of_pendulums(made: Callable[[int], Scene], n: int) -> None:
    chain = made(n)
    report = dofkit.lagrange(chain)
    assert report.coordinates == [f"q{i}" for i in range(1, n + 1)]
    assert max(map(len, report.equations)) < 400
    names = names_of(chain, report)
    for i, text in enumerate(report.equations, 1):
        terms = [
            f"({n + 1 - max(i, j)}) (cos(q{i} - q{j}) q{j}ddot + sin(q{i} - q{j}) q{j}dot^2)" for j in range(1, n + 1)
        ]
        expected = parse_expression(" + ".join(terms) + f" + {n + 1 - i} g sin(q{i})", names)
        assert vanishes(zero(text, names) - expected)


@pytest.mark.sweep
def test_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = called(capsys, "lagrange", "orbit-polar", "particle-in-space", "--json")
    told = [json.loads(line) for line in out.splitlines()]
    assert status == 2
    assert told[0]["coordinates"] == ["r", "theta"]
    assert told[1]["scene"] == "particle-in-space"
    assert "no equations of motion can be derived" in told[1]["error"]["message"]
    status, out, _ = called(capsys, "lagrange", "trolley-pendulum", "--linearize")
    assert status == 0
    assert "Equations of motion" in out
    assert "A = [M + m, m l; m l, m l^2]" in out


def test_the_numbers_are_exact() -> None:
    half = scene(coordinates="x", **energies("0.1 xdot^2", "x/3"))
    report = dofkit.lagrange(half)
    assert report.equations == ["xddot/5 + 1/3 = 0"]
