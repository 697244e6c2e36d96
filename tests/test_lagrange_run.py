"""Equations of motion along a run, handed over to SymPy, about an equilibrium, and on the command line."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from typing import Any

import pytest
import sympy
from motions import PLANE, energies, names_of, scene, vanishes, zero

import dofkit
from dofkit import cli
from dofkit.lagrange import MotionReport
from dofkit.lagrange.bridge import Bridge
from dofkit.scene import Scene
from dofkit.text import parse_expression

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
    given = report.to_sympy()
    method = given.lagranges_method()
    method.form_lagranges_equations()
    n = len(given.coordinates)
    state = [*given.coordinates, *(q.diff() for q in given.coordinates)]
    flat = sympy.symbols(f"q:{2 * n}")
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

    usual = [0.3 + 0.1 * i for i in range(n)] + [0.2 - 0.05 * i for i in range(n)]
    start = np.array(begin or usual)
    run = solve_ivp(rates, (0.0, 1.0), start, method="DOP853", rtol=1e-12, atol=1e-13)
    heights = [float(height(*y)) for y in run.y.T]
    return max(abs(h - heights[0]) for h in heights) / max(1.0, abs(heights[0]))


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_energy_is_conserved_along_a_run(name: str) -> None:
    pytest.importorskip("scipy")
    assert drift(dofkit.load(name)) < 1e-9


def test_energy_is_conserved_with_multipliers() -> None:
    pytest.importorskip("scipy")
    sleigh = scene("sin(theta) dx = cos(theta) dy", coordinates="x y theta", **energies(f"{PLANE} + 2 thetadot^2", "y"))
    assert drift(sleigh, [0.1, 0.2, 0.0, 0.7, 0.0, 0.4]) < 1e-9
    two = scene(
        "x1^2 + y1^2 = 25", "(x2 - x1)^2 + (y2 - y1)^2 = 25", coordinates="x1 y1 x2 y2",
        **energies("m (x1dot^2 + y1dot^2 + x2dot^2 + y2dot^2)/2", "m g (y1 + y2)"),
    )  # fmt: skip
    assert drift(two, [3.0, -4.0, 7.0, -7.0, 0.8, 0.6, 1.4, 1.4]) < 1e-9


def test_what_is_handed_over_suits_both_methods() -> None:
    from sympy.physics.mechanics import KanesMethod, Particle, Point

    given = dofkit.lagrange(dofkit.load("trolley-pendulum")).to_sympy()
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
    ladder = dofkit.lagrange(dofkit.load("sliding-ladder-angle"), linearize=True)
    assert ladder.linearized is None
    assert "no equilibrium" in ladder.notes[-1]


def test_a_hanging_mass_rests_where_its_spring_holds_it() -> None:
    """m x'' + k x = m g: about x = m g/k with k/m = omega^2."""
    hanging = scene(coordinates="x", **energies("m xdot^2/2", "k x^2/2 - m g x"))
    small = dofkit.lagrange(hanging, linearize=True).linearized
    assert small is not None
    assert small.equilibrium == {"x": "g*m/k"}
    assert small.frequencies == ["sqrt(k)/sqrt(m)"]


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
    assert "nothing to derive motion from" in told[1]["error"]["message"]
    status, out = run("lagrange", "trolley-pendulum", "--linearize")
    assert status == 0
    assert "Equations of motion" in out
    assert "M = [M + m, l*m; l*m, l^2*m]" in out


def test_the_numbers_are_exact() -> None:
    half = scene(coordinates="x", **energies("0.1 xdot^2", "x/3"))
    report = dofkit.lagrange(half)
    assert report.equations == ["xddot/5 + 1/3 = 0"]
