"""Terms, factors and signs in a reader's order: each expectation is how it stands on a board."""

from __future__ import annotations

import pytest

import dofkit
from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.expressions.text import parse_expression
from dofkit.expressions.text.names import Names
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import parameter
from dofkit.motion.lagrange.tidying import ordered

NAMES = Names(
    coordinates=frozenset({"x", "y", "theta"}),
    parameters={name: parameter(name) for name in ("m", "M", "m1", "m2", "J", "g", "l", "k", "a", "b", "R")},
)


@pytest.mark.parametrize(
    ("given", "board"),
    [
        ("l^2 m thetadot^2/2", "m*l^2*thetadot^2/2"),
        ("g l m sin(theta)", "m*g*l*sin(theta)"),
        ("-a^2 (-m1 - 2 m2 sin(theta)^2) thetadot^2", "a^2*(m1 + 2*m2*sin(theta)^2)*thetadot^2"),
        ("g l m (cos(theta) - 1)", "-m*g*l*(1 - cos(theta))"),
        ("-g l m (1 - cos(theta))", "-m*g*l*(1 - cos(theta))"),
        ("-g (m1 - m2)", "(m2 - m1)*g"),
        ("-k (x - y)", "-k*(x - y)"),
        ("(R^2 m/2 + J/2) thetadot^2", "(m*R^2 + J)*thetadot^2/2"),
        ("(2 a + 2 b)^2 x", "4*(a + b)^2*x"),
        ("(-a - b)^3 x", "-(a + b)^3*x"),
        ("x/(-a - b)", "-x/(a + b)"),
        ("x/(2 a + 2 b)", "x/(2*(a + b))"),
        ("k x + m xdot", "m*xdot + k*x"),
        ("(-a)*(-b - x)", "a*(b + x)"),
        ("a - b", "a - b"),
        ("-a", "-a"),
        ("2", "2"),
    ],
)
def test_it_stands_as_on_a_board(given: str, board: str) -> None:
    e = parse_expression(given, NAMES)
    assert to_text(ordered(e)) == board
    assert is_identically_zero(parse_expression(board, NAMES) - e) is True


def test_the_lagrangian_of_a_pendulum_is_that_of_the_lecture() -> None:
    pendulum = {
        "coordinates": ["theta"],
        "parameters": {"m": "positive", "g": "positive", "l": "positive"},
        "energies": {"kinetic": "m l^2 thetadot^2/2", "potential": "m g l (1 - cos(theta))"},
    }
    report = dofkit.lagrange(pendulum)
    assert report.lagrangian == "m*l^2*thetadot^2/2 - m*g*l*(1 - cos(theta))"
    assert report.equations == ["m*l^2*thetaddot + m*g*l*sin(theta) = 0"]


@pytest.mark.sweep
def test_no_text_of_the_catalog_has_two_minus_signs_in_a_row() -> None:
    """``-a*(-b ...)`` and ``- -``."""
    for name in dofkit.catalog_names():
        scene = dofkit.load(name)
        if scene.energies is None:
            continue
        report = dofkit.lagrange(scene)
        for text in (report.lagrangian, *report.equations, *report.momenta.values(), *report.forces.values()):
            assert "*(-" not in text, (name, text)
            assert "- -" not in text, (name, text)
