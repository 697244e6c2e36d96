"""Equations of motion against M a = h + A^T lam, A a = -(dA/dt) v in all coordinates, in figures at random states."""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from typing import Any

import pytest
from shared.known_scenes import swept
from shared.motions import PLANE, energies, names_of, regular, scene, zero

import dofkit
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.text import parse_expression
from dofkit.expressions.tree import TIME, Expr, coordinate, num, parameter, sym, velocity
from dofkit.motion.lagrange.elimination import by_time

VALUES = {"m": 1.25, "g": 2.0, "l": 1.5, "k": 0.625, "c": 0.375, "w": 0.75, "b": 0.875}
SPACE = f"{PLANE} + m zdot^2/2"
STATES = 2
#: Coordinates, constraints, energies.
Case = tuple[str, list[str], dict[str, Any]]
CASES: dict[str, Case] = {
    "rod": ("x y", ["x sin(w t) - y cos(w t) = 0"], energies(PLANE, "m g y")),
    "string that is drawn in": ("x y", ["x^2 + y^2 = (2 + sin(t))^2"], energies(PLANE, "m g y")),
    "two links": (
        "x y a1 a2", ["x^2 + y^2 = 1", "(a1 - x)^2 + (a2 - y)^2 = 1"],
        energies(f"{PLANE} + a1dot^2 + a2dot^2", "m g (y + a2)"),
    ),
    "crank and slide": (
        "a1 a2 x", ["l cos(a1) + 3 cos(a2) = x", "l sin(a1) + 3 sin(a2) = 0"],
        energies("a1dot^2 + a2dot^2 + 2 xdot^2 + a1dot a2dot cos(a1 - a2)", "g sin(a1) + sin(a2)"),
    ),
    "two knife edges that slide together": (
        "x y a1", ["sin(a1) xdot - cos(a1) ydot = 0", "sin(a1) xdot - cos(a1) ydot - l a1dot = 0"],
        energies(f"{PLANE} + a1dot^2", "y"),
    ),
    "two crossed knife edges": (
        "x y a1", ["sin(a1) xdot - cos(a1) ydot = 0", "sin(a1 + 1) xdot - cos(a1 + 1) ydot - l a1dot = 0"],
        energies(f"{PLANE} + a1dot^2", "y"),
    ),
    "car": (
        "x y a1 a2",
        ["xdot sin(a1) - ydot cos(a1) = 0", "xdot sin(a1 + a2) - ydot cos(a1 + a2) - l a1dot cos(a2) = 0"],
        energies(f"{PLANE} + a1dot^2 + a2dot^2", "m g x"),
    ),
    "turntable": (
        "x y a1 a2", ["xdot = l a1dot - 2 y", "ydot = l a2dot + 2 x"],
        energies(f"{PLANE} + a1dot^2 + a2dot^2", "m g x"),
    ),
    "disc with a wheel too many": (
        "x y a1 a2", ["xdot = l cos(a1) a2dot", "ydot = l sin(a1) a2dot", "xdot sin(a1) = ydot cos(a1)"],
        energies(f"{PLANE} + a1dot^2 + 2 a2dot^2", "m g y"),
    ),
    "driven heading": (
        "x y a1 a2", ["xdot = l cos(a1) a2dot", "ydot = l sin(a1) a2dot", "a1 = t^2"],
        energies(f"{PLANE} + a1dot^2 + 2 a2dot^2", "m g y"),
    ),
    "affine": ("x y z", ["zdot = y xdot + x"], energies("xdot^2 + ydot^2/2 + zdot^2", "m g z")),
    "Appell": ("x y z", ["xdot^2 + ydot^2 = l^2 zdot^2"], energies("xdot^2 + ydot^2 + zdot^2", "m g z")),
    "friction and forces on what is eliminated": (
        "x y", ["x^2 + y^2 = l^2"],
        energies(PLANE, "m g y", dissipation="(xdot^2 + 3 ydot^2)/2", forces={"y": "x t", "x": "ydot"}),
    ),
    "the same on a turning rod": (
        "x y a1", ["x = a1 cos(t)", "y = a1 sin(t)"],
        energies(PLANE, "m g y", dissipation="(xdot^2 + 3 ydot^2)/2", forces={"y": "x t", "a1": "a1"}),
    ),
    "cubic friction": ("x y", ["y = x^2"], energies(PLANE, "m g y", dissipation="c (xdot^2 + ydot^2)^2/4")),
    "a charge on a bowl": ("x y z", ["z = x^2 + y^2"], energies(SPACE, "m g z + b (y xdot - x ydot) + x zdot")),
    "mass that grows": ("x y", ["y = x t"], energies(f"exp(w t) {PLANE}", "m g y")),
    "written four times": (
        "x y z", ["x + y + z = 1", "x - y = t", "2 x + z = 1 + t", "xdot + ydot + zdot = 0"], energies(SPACE, "z^2"),
    ),
    "third degree": ("x y", ["x^3 + x = y^3"], energies(PLANE, "m g y")),
}  # fmt: skip


def figure(e: Expr, at: dict[Expr, float]) -> float:
    """The value of an expression where all its symbols have one."""
    value = approximate(substitute(e, {s: num(Fraction(at[s])) for s in e.symbols}))
    assert value is not None
    return value


def _gaps(at: dict[Expr, float], symbols: list[Expr], relations: list[Expr], x: Any) -> list[float]:
    here = {**at, **dict(zip(symbols, map(float, x), strict=True))}
    return [figure(g, here) for g in relations]


class Newton:
    """A scene in all its coordinates, and its accelerations at random states that satisfy the constraints."""

    def __init__(self, case: Case) -> None:
        self.made = scene(*case[1], coordinates=case[0], **case[2])
        self.report = dofkit.lagrange(self.made)
        self.names = names_of(self.made, self.report)
        given = case[2]["energies"]
        read = {
            key: parse_expression(given.get(key, "0"), self.names) for key in ("kinetic", "potential", "dissipation")
        }
        lagrangian = read["kinetic"] - read["potential"]
        relations = [zero(text, self.names) for text in case[1]]
        self.own = case[0].split()
        self.q = [coordinate(n) for n in self.own]
        self.v = [velocity(n) for n in self.own]
        self.a = [sym("acceleration", n) for n in self.own]
        self.finite = [g for g in relations if not any(s.args[0] == "velocity" for s in g.symbols)]
        self.rates = [by_time(g) if g in self.finite else g for g in relations]
        self.motion = []
        for n, q, v in zip(self.own, self.q, self.v, strict=True):
            force = parse_expression(given.get("forces", {}).get(n, "0"), self.names)
            self.motion.append(
                by_time(diff(lagrangian, v)) - diff(lagrangian, q) + diff(read["dissipation"], v) - force
            )

    def state(self, seed: int) -> dict[Expr, float]:
        """Places and velocities that satisfy the constraints, by least squares."""
        import numpy as np
        from scipy.optimize import least_squares

        rng = np.random.default_rng(seed)
        at = {parameter(n): v for n, v in VALUES.items()} | {TIME: 0.5 + seed / 16}
        for symbols, relations in ((self.q, self.finite), (self.v, self.rates)):
            start = rng.uniform(0.3, 1.2, len(symbols)) * rng.choice([-1, 1], len(symbols))

            gaps = partial(_gaps, at, symbols, relations)
            found = least_squares(gaps, start, xtol=1e-15, ftol=1e-15, gtol=1e-15).x if relations else start
            assert max(map(abs, gaps(found)), default=0) < 1e-9
            at |= dict(zip(symbols, map(float, found), strict=True))
        return at

    def accelerations(self, at: dict[Expr, float]) -> list[float]:
        """By least squares, so that what is written twice does no harm."""
        import numpy as np

        n, k = len(self.own), len(self.rates)
        whole, right = np.zeros((n + k, n + k)), np.zeros(n + k)
        rest = {**at, **dict.fromkeys(self.a, 0.0)}
        for i, row in enumerate([*self.motion, *map(by_time, self.rates)]):
            whole[i, :n] = [figure(diff(row, a), at) for a in self.a]
            right[i] = -figure(row, rest)
        whole[:n, n:] = whole[n:, :n].T
        found, *_ = np.linalg.lstsq(whole, right, rcond=1e-10)
        assert np.allclose(whole @ found, right)
        return [float(x) for x in found[:n]]


@pytest.mark.parametrize("name", [swept(name) if k % 4 else name for k, name in enumerate(CASES)])
def test_the_equations_hold_for_newtons_accelerations(name: str) -> None:
    import numpy as np

    system = Newton(CASES[name])
    report = system.report
    assert regular(report, system.names)
    equations = [zero(text, system.names) for text in report.equations]
    forces = [parameter(n) for n in report.multipliers]
    known = not any("Constants of integration" in note for note in report.notes)
    solved = {n: parse_expression(text, system.names) for n, text in report.eliminated.items() if known}
    seen = 0
    for seed in range(16):
        at = system.state(seed)
        at |= dict(zip(system.a, system.accelerations(at), strict=True))
        if any(abs(figure(e, at) - at[coordinate(n)]) > 1e-6 for n, e in solved.items()):
            continue
        slopes = np.array([[figure(diff(e, f), at) for f in forces] for e in equations]).reshape(len(equations), -1)
        rest = np.array([figure(e, {**at, **dict.fromkeys(forces, 0.0)}) for e in equations])
        if forces:
            rest = rest + slopes @ np.linalg.lstsq(slopes, -rest, rcond=1e-10)[0]
        assert np.allclose(rest, 0, atol=1e-6), rest
        for n, e in solved.items():
            assert abs(figure(by_time(by_time(e)), at) - at[sym("acceleration", n)]) < 1e-5
        seen += 1
        if seen == STATES:
            return
    raise AssertionError("no state was on the branch that the report tells of")
