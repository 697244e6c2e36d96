"""Degenerate finite equations: the answers by hand, each with the line that gives it.

A number may be left open only where a row says None; `consistent` None is an honest "not known".
"""

from __future__ import annotations

from typing import Any

import pytest

import dofkit

#: (coordinates, constraints, why, answer)
Row = tuple[str, list[str], str, dict[str, Any]]

EMPTY = {"consistent": False, "dof": None, "velocity_dof": None, "verdict": "proved"}


def answer(dof: int | None, **more: Any) -> dict[str, Any]:
    return {"consistent": True, "dof": dof, "velocity_dof": dof, **more}


def at(**values: Any) -> dict[str, Any]:
    return {"configuration": values}


POWERS: list[Row] = [
    ("x y", ["(x - y)^3 = 0"], "x = y", answer(1, verdict="proved")),
    ("x y", ["x^2 = 2 x y - y^2"], "(x - y)^2 = 0", answer(1, verdict="proved")),
    ("x y", ["x^2 + y^2 = 0"], "both vanish", answer(0, verdict="proved")),
    ("x y z", ["x^4 + y^4 + z^2 = 0"], "all vanish", answer(0, verdict="proved")),
    ("x y", ["1e30 x^2 + 1e-30 y^2 = 0"], "both vanish, whatever the size", answer(0, verdict="proved")),
    ("x y z", ["x^2 + y^2 + z^2 = x y + y z + z x"], "x = y = z: half the sum of squares of differences", answer(1)),
    ("x", ["(x - 1)^2 + (sqrt(x) - 1)^2 = 0"], "x = 1 satisfies both", answer(0)),
    ("x y", ["sqrt((x - 1)^2) + abs(y) = 0"], "both terms are >= 0: x = 1, y = 0", answer(0, verdict="proved")),
    ("x y", ["sqrt(x) + sqrt(y) = 0"], "both roots vanish", answer(0, verdict="proved")),
    ("x y", ["sqrt(x^2 + y^2) = 0"], "the origin", answer(0, verdict="proved")),
    ("x y", ["sin(x)^2 + sin(y)^2 = 0"], "both sines vanish", answer(0, verdict="proved")),
    ("x y", ["cos(x) + cos(y) = 2"], "both are 1", answer(0, verdict="proved")),
    ("x y", ["x^3 + y^3 = 0"], "x = -y, for the other factor is definite", answer(1, verdict="proved")),
    ("x y", ["x^3 = 0", "y^2 = 0"], "the origin", answer(0, verdict="proved")),
    ("x y z", ["x^2 + y^2 = 0", "z = x"], "the origin", answer(0, verdict="proved")),
    ("x y z", ["x^2 = 0", "dz = x dy"], "x = 0, so dz = 0", answer(1, holonomic=True)),
    ("x y z", ["(x - 1)^2 = 0", "dz = x dy"], "x = 1, so dz = dy", answer(1, holonomic=True)),
    ("x y z", ["x^2 + y^2 = 0", "dz = y dx"], "x = y = 0, so dz = 0", answer(0, holonomic=True)),
]

PRODUCTS: list[Row] = [
    ("x y", ["x^2 y = 0"], "two lines", answer(1, verdict="proved")),
    ("x y", ["x y = 0", "x + y = 0"], "both lines meet the third in the origin", answer(0, verdict="proved")),
    ("x y", ["(x^2 + y^2) (x - 1) = 0"], "the line x = 1 and the origin", answer(1, verdict="proved")),
    ("x y z", ["z (x^2 + y^2) = 0"], "the plane z = 0 and the z axis", answer(2, verdict="proved")),
    ("x y", ["x^2 - y^2 = 0", "x^2 + y^2 = 0"], "the origin", answer(0)),
    ("x y", ["abs(x) = x^2"], "x = 0, 1, -1", answer(1, verdict="proved")),
    ("x y z", ["x y = 0", "dz = y dx"], "on x = 0 dz = 0, on y = 0 dz = 0", answer(1, holonomic=True)),
    ("x y", ["x y = 0", "x = 1"], "y = 0", answer(0)),
    (
        "x y",
        ["x (x - 1) (x - 2) = 0", "x = 3"],
        "none of the three",
        {"consistent": False, "conflicting": ["c1", "c2"]},
    ),
]

NOTHING: list[Row] = [
    ("x", ["x^4 + 1 = 0"], "positive", EMPTY),
    ("x", ["x^2 + x + 1 = 0"], "discriminant -3", EMPTY),
    ("x y", ["x^2 - 2 x y + 2 y^2 = -1"], "(x - y)^2 + y^2 >= 0", EMPTY),
    ("x y", ["1e-30 x^2 + y^2 = -1e-30"], "however small", EMPTY),
    ("x", ["sin(x) = 2"], "1 at most", EMPTY),
    ("x y", ["cos(x) + sin(y) = 3"], "2 at most", EMPTY),
    ("x y", ["cos(x) cos(y) = 2"], "1 at most", EMPTY),
    ("x", ["x^2 + cos(x) = -2"], "-1 at least", EMPTY),
    ("x", ["exp(x) = 0"], "positive", EMPTY),
    ("x", ["sqrt(x) = -1"], "not negative", EMPTY),
    ("x", ["abs(x) = -1"], "not negative", EMPTY),
    ("x", ["asin(x) = 2"], "pi/2 at most", EMPTY),
    ("x", ["acos(x) = -1"], "not negative", EMPTY),
    ("x", ["atan(x) = 2"], "pi/2 at most", EMPTY),
    ("x y", ["atan(y/x) = 2"], "pi/2 at most", EMPTY),
    ("x y", ["log(-x^2) = y"], "no logarithm", EMPTY),
    ("x y", ["sqrt(-1 - x^2) y = 0"], "no root anywhere, so no product", EMPTY),
    ("x", ["1 = 2"], "in no coordinate", EMPTY),
    ("x y", ["x^2 + y^2 = 1", "(x - 5)^2 + y^2 = 1"], "two circles apart", EMPTY | {"conflicting": ["c1", "c2"]}),
    ("x y", ["x^2 + y^2 = 9", "(x - 1)^2 + y^2 = 1"], "one inside the other", EMPTY | {"conflicting": ["c1", "c2"]}),
    ("x y z", ["x^2 + y^2 + z^2 = 1", "x + y + z = 2"], "the plane misses the sphere", EMPTY),
    ("x y", ["x y = 1", "x + y = 1"], "discriminant -3", EMPTY),
    ("x", ["x^2 = 2", "x^3 = 3"], "8 is not 9", {"consistent": False, "conflicting": ["c1", "c2"]}),
    ("x y", ["abs(x) = y", "y = -1"], "not negative", EMPTY | {"conflicting": ["c1", "c2"]}),
]

WHERE_IT_HAS_A_VALUE: list[Row] = [
    ("x y", ["sqrt(x) y = 0", "x = -1"], "no root of -1, though y = 0", {"consistent": False}),
    ("x y", ["log(x) y = 0", "x = -1"], "no logarithm of -1, though y = 0", EMPTY),
    ("x y", ["log(x) y = 0"], "x = 1, or y = 0 with x > 0", answer(1)),
    ("x y", ["y/x = 0", "x = 0"], "0/0 is no value", {"consistent": False}),
    ("x y", ["(x^2 + y^2)/x = 0"], "only 0/0 would do", {"consistent": False}),
    ("x y", ["(x^2 - 1)/(x - 1) = y"], "y = x + 1", answer(1, verdict="proved")),
    ("x y", ["(x^2 - 1)/(x - 1) = 0"], "x = -1, not 1", answer(1, verdict="proved")),
    ("x y", ["(x^2 - 1)/(x - 1) = 0", "x = 1"], "2 is not 0", {"consistent": False}),
    ("x", ["(x - 1) (x^2 + 1)/(x - 1) = 0"], "x^2 + 1", EMPTY),
    ("x", ["x/x = 1"], "always", answer(1)),
    ("x y", ["x/x = y"], "y = 1", answer(1)),
    ("x y", ["x + abs(x) = 0"], "x <= 0, a half plane", answer(2)),
    ("x", ["sqrt(x^2) = x"], "x >= 0", answer(1)),
    ("x y", ["x + abs(x) = 0", "x = 1"], "x <= 0", {"consistent": False, "conflicting": ["c1", "c2"]}),
    ("x y", ["x + abs(x) = 0", "x = -1"], "x <= 0 holds", answer(1)),
    ("x y", ["x + abs(x) = 0", "x = y^2 + 1"], "x <= 0", {"consistent": False}),
    ("x y", ["x + abs(x) = 0", "y = x^3"], "half a cubic", answer(1)),
    ("x y", ["y (x + abs(x)) = 0"], "the half plane x <= 0 and the line y = 0", answer(2)),
    ("x y", ["y (x + abs(x)) = 0", "x = 1"], "y = 0", answer(0)),
    ("x y", ["sqrt(x^2 + y^2) = x"], "y = 0 where x >= 0", answer(1, verdict="proved")),
    ("x y", ["sqrt(x^2 + y^2) = x", "x = -2"], "not negative", {"consistent": False}),
    ("x y", ["sqrt(x^2 + y^2) = x", "x = 2"], "y = 0", answer(0)),
    ("x y", ["(x^2)^(1/4) = y", "x = -4"], "y = sqrt(2)", answer(0)),
    ("x y", ["abs(x) + abs(y) = 1"], "a square", answer(1)),
    ("x y", ["abs(x) + abs(y) = 0"], "the origin", answer(0, verdict="proved")),
    ("x y z", ["dz = x dy", "x + abs(x) = 0"], "a contact form where x < 0", {"dof": 3, "velocity_dof": 2}),
]


def rate(dof: int | None, velocity_dof: int | None, holonomic: bool | None, **more: Any) -> dict[str, Any]:
    return {"consistent": True, "dof": dof, "velocity_dof": velocity_dof, "holonomic": holonomic, **more}


#: Relations in one combination of velocities. A contact form in (x, y, t) or (x, y, z) is non-holonomic.
ONE_RATE: list[Row] = [
    ("x y", ["exp(xdot) = -1"], "positive", EMPTY),
    ("x y", ["cosh(xdot) = 1/2"], "1 at least", EMPTY),
    ("x y", ["xdot^3 = 1"], "xdot = 1: the other factor is definite", rate(1, 1, True, scleronomic=False)),
    ("x y", ["sqrt(xdot) = -2"], "not negative", EMPTY),
    ("x y", ["sqrt(xdot) = y", "y = -1"], "not negative", {"consistent": False, "conflicting": ["c1", "c2"]}),
    ("x y", ["1/xdot = 2"], "xdot = 1/2", rate(1, 1, True, scleronomic=False)),
    ("x y", ["exp(xdot) = 2", "xdot = 1"], "log 2 is not 1", {"consistent": False, "conflicting": ["c1", "c2"]}),
    ("x y", ["exp(xdot) = E", "xdot = 1"], "the same", rate(1, 1, True, redundant=["c2"])),
    ("x y z", ["(zdot - y xdot)^3 = 8"], "dz - y dx - 2 dt", rate(3, 2, False, scleronomic=True)),
    ("x y", ["sin(xdot) = 0"], "xdot = k pi, one branch for every k", rate(1, 1, True)),
    ("x y", ["exp(xdot) + xdot = 2"], "one root without a formula", rate(1, 1, True)),
]

#: Equations of which every answer may be undecided, and none may be wrong.
MAY_BE_UNDECIDED: list[Row] = [
    ("x y", ["x^4 + y^4 - x^2 y^2 + 1 = 0"], "(x^2 - y^2/2)^2 + 3 y^4/4 >= 0", EMPTY),
    ("x y", ["sqrt(xdot) = 2"], "xdot = 4", rate(1, 1, True, scleronomic=False)),
    ("x y", ["abs(xdot) = 1"], "xdot = 1 or -1", rate(1, 1, True, scleronomic=False)),
    ("x y z", ["atan(zdot - y xdot) = 0"], "dz - y dx", rate(3, 2, False, scleronomic=True)),
    ("x", ["log(x^2 + 1) = -1"], "not negative", EMPTY),
    ("x", ["asin(x^2 + 1) = 0"], "the argument is 1 at most, where asin is pi/2", EMPTY),
    ("x y", ["x^4 + y^4 + 3 = 4 x y"], "x^4 + y^4 + 1 + 1 >= 4 x y by the means", EMPTY),
    ("x y z", ["x^4 + y^4 + z^4 + 4 = 4 x y z"], "the means of x^4, y^4, z^4, 1 give 4 x y z - 1 at most", EMPTY),
    ("x y", ["exp(xdot) = 1"], "xdot = 0", rate(1, 1, True, scleronomic=True)),
    ("x y", ["exp(xdot) = 2"], "xdot = log 2", rate(1, 1, True, scleronomic=False)),
    ("x y", ["exp(xdot) = y"], "dx - log(y) dt: its curvature is dt dy / y", rate(2, 1, False, scleronomic=True)),
    ("x y", ["exp(x xdot + y ydot) = 2"], "x^2 + y^2 = 2 t log 2 + C", rate(1, 1, True, scleronomic=False)),
    ("x y", ["exp(xdot + ydot) = 1"], "x + y = C", rate(1, 1, True, scleronomic=True)),
    ("x y", ["exp(xdot) + exp(-xdot) = 4"], "exp(xdot) = 2 +- sqrt(3)", rate(1, 1, True, scleronomic=False)),
    ("x y", ["cosh(xdot) = 1"], "xdot = 0", rate(1, 1, True, scleronomic=True)),
    ("x y", ["tanh(xdot) = 1/2"], "xdot = log(3)/2", rate(1, 1, True, scleronomic=False)),
    ("x y", ["asin(xdot) = 2"], "pi/2 at most", EMPTY),
    ("x y", ["asin(xdot) = 1"], "xdot = sin 1", rate(1, 1, True, scleronomic=False)),
    ("x y", ["2^xdot = 8"], "xdot = 3", rate(1, 1, True, scleronomic=False)),
    ("x y", ["xdot^3 = 2"], "one real root", rate(1, 1, True, scleronomic=False)),
    ("x y", ["xdot^4 = 2"], "two real roots", rate(1, 1, True, scleronomic=False)),
    ("x y", ["xdot^3 = y"], "dx - y^(1/3) dt", rate(2, 1, False, scleronomic=True)),
    ("x y", ["sqrt(xdot) = y", "y = 2"], "xdot = 4", rate(0, 0, True)),
    ("x y", ["abs(xdot) = y", "y = -1"], "not negative", {"consistent": False, "conflicting": ["c1", "c2"]}),
    ("x y", ["abs(xdot) = 2 - xdot"], "xdot = 1, for 2 = 0 is wrong", rate(1, 1, True)),
    ("x y", ["abs(xdot) = xdot - 2"], "xdot = 1 is not negative", EMPTY),
    ("x y z", ["exp(zdot - y xdot) = 1"], "dz - y dx", rate(3, 2, False, scleronomic=True)),
    ("x y", ["abs(xdot) = xdot"], "xdot >= 0, an inequality", rate(2, 2, False)),
    ("x y", ["xdot = abs(ydot)"], "x - y = C or x + y = C, and xdot >= 0: an inequality as well", rate(1, 1, False)),
]

#: Numbers that are 0 by an identity that may be missed: the true freedom, or an honest None.
HIDDEN_NUMBERS = [
    ("x", "atan(1) = pi/4", 1),
    ("x y", "(atan(1) - pi/4) x = 0", 2),
    ("x y", "(4 atan(1/5) - atan(1/239) - pi/4) x y = 0", 2),
    ("x y", "(sqrt(5 + 2 sqrt(6)) - sqrt(2) - sqrt(3)) (x^2 + 1) = 0", 2),
]

#: The same with a reference configuration.
AT_A_POINT: list[tuple[str, list[str], dict[str, Any], str, dict[str, Any]]] = [
    ("x y", ["y^2 = x^2 (x + 1)"], at(x=0, y=0), "a node", answer(1, instantaneous_dof=2, singular=True)),
    ("x y", ["y^2 = x^2 (x - 1)"], at(x=0, y=0), "an isolated point", answer(0, instantaneous_dof=2, singular=True)),
    ("x y", ["x^3 + y^3 = 3 x y"], at(x=0, y=0), "a node", answer(1, instantaneous_dof=2, singular=True)),
    ("x y", ["(x^2 + y^2)^2 = x^2 - y^2"], at(x=0, y=0), "a node", answer(1, instantaneous_dof=2, singular=True)),
    ("x y", ["x^2 y = 0"], at(x=0, y=1), "on the double line", answer(1)),
    ("x y", ["x^2 + y^2 = 1", "y = 1 - x^2/2 - x^4/8 - x^6/16"], at(x=0, y=1), "contact of order 8", answer(0)),
    ("x y", ["(x^2 + y^2) (x - 1) = 0"], at(x=0, y=0), "an isolated point", answer(0)),
    ("x y z", ["z (x^2 + y^2) = 0"], at(x=0, y=0, z=1), "on the axis", answer(1)),
    ("x y z", ["z (x^2 + y^2) = 0"], at(x=0, y=0, z=0), "the plane is larger", answer(2)),
    ("x y", ["sqrt(x^2 + y^2) = 5"], at(x=3, y=4), "a circle", answer(1, instantaneous_dof=1, singular=False)),
    ("x y", ["sqrt(x^2 + y^2) = x"], at(x=1, y=0), "a half line", answer(1, instantaneous_dof=1)),
    ("x y", ["y (x + abs(x)) = 0"], at(x=1, y=0), "on the line", answer(1, instantaneous_dof=1)),
    ("x y", ["y (x + abs(x)) = 0"], at(x=-1, y=1), "within the half plane", answer(2, instantaneous_dof=2)),
    ("x y", ["sin(x) = sin(y)"], at(x="pi/2", y="pi/2"), "x = y and x + y = pi cross", answer(1, instantaneous_dof=2)),
    ("x y", ["y^2 = x^3"], at(x=0, y=0), "a cusp: x = s^2, y = s^3", answer(1, instantaneous_dof=2, singular=True)),
    ("x y", ["(y - x^2)^2 = x^5"], at(x=0, y=0), "a cusp of the second kind", answer(1, singular=True)),
    ("x y", ["x^3 = y^4"], at(x=0, y=0), "x = y^(4/3)", answer(1, instantaneous_dof=2)),
    ("x y", ["1 - cos(y) = x^3"], at(x=0, y=0), "y^2/2 = x^3 nearby", answer(1, instantaneous_dof=2)),
    ("x y z", ["y^2 = x^3", "z = sin(x) + y"], at(x=0, y=0, z=0), "a cusp in space", answer(1, instantaneous_dof=2)),
    ("x y z", ["x^2 = y^2 z"], at(x=0, y=0, z=0), "Whitney's umbrella, the pinch point", answer(2, singular=True)),
    ("x y z", ["x^2 = y^2 z"], at(x=0, y=0, z=-1), "Whitney's umbrella, its handle", answer(1, singular=True)),
    ("x y z", ["x^2 = y^2 z"], at(x=0, y=0, z=1), "Whitney's umbrella, two sheets cross", answer(2, singular=True)),
    ("x y z", ["z (x^2 + y^2) = x^3"], at(x=0, y=0, z=1), "Cartan's umbrella, its stick", answer(1, singular=True)),
    ("x y z", ["z (x^2 + y^2) = x^3"], at(x=0, y=0, z=0), "Cartan's umbrella, the cloth", answer(2, singular=True)),
    ("x y z", ["x^2 + y^2 = z^3"], at(x=0, y=0, z=0), "a spike of revolution", answer(2, singular=True)),
    ("x y z", ["x^2 + y^2 = z^4"], at(x=0, y=0, z=0), "two paraboloids that touch", answer(2, singular=True)),
]


#: The freedom at a configuration where an absolute value has no derivative; it may be undecided.
AT_A_KINK: list[tuple[str, dict[str, Any], int]] = [
    ("x + abs(x) = 0", at(x=0, y=1), 2),  # on the edge of the half plane
    ("abs(x) = y", at(x=0, y=0), 1),
    ("abs(x) = abs(y)", at(x=0, y=0), 1),  # four rays meet
]


def check(made: dict[str, Any], expected: dict[str, Any]) -> None:
    report = dofkit.classify(dofkit.load(made)).model_dump(mode="json")
    assert {key: report[key] for key in expected} == expected


TABLES = {
    "powers": POWERS,
    "products": PRODUCTS,
    "nothing": NOTHING,
    "where it has a value": WHERE_IT_HAS_A_VALUE,
    "one rate": ONE_RATE,
}
ROWS = [pytest.param(*row, id=f"{name}: {'; '.join(row[1])}") for name, rows in TABLES.items() for row in rows]


@pytest.mark.parametrize(("coordinates", "constraints", "why", "expected"), ROWS)
def test_degenerate_equations(coordinates: str, constraints: list[str], why: str, expected: dict[str, Any]) -> None:
    assert why
    check({"coordinates": coordinates.split(), "constraints": constraints}, expected)


@pytest.mark.parametrize(
    ("coordinates", "constraints", "why", "expected"),
    MAY_BE_UNDECIDED,
    ids=["; ".join(row[1]) for row in MAY_BE_UNDECIDED],
)
def test_what_may_be_undecided_is_not_wrong(
    coordinates: str, constraints: list[str], why: str, expected: dict[str, Any]
) -> None:
    report = dofkit.classify({"coordinates": coordinates.split(), "constraints": constraints}).model_dump(mode="json")
    compared = expected if report["consistent"] is not None else {"consistent": expected["consistent"]}
    assert all(None in (report[key], value) or report[key] == value for key, value in compared.items()), why


@pytest.mark.parametrize(
    ("coordinates", "constraints", "reference", "why", "expected"),
    [pytest.param(*row, id=f"{'; '.join(row[1])} at {row[2]['configuration']}") for row in AT_A_POINT],
)
def test_degenerate_configurations(
    coordinates: str, constraints: list[str], reference: dict[str, Any], why: str, expected: dict[str, Any]
) -> None:
    assert why
    check({"coordinates": coordinates.split(), "constraints": constraints, **reference}, expected)


def test_what_is_exceptional_may_be_undecided() -> None:
    """y^2 = x^4 (x - 1) < 0 nearby: nothing moves. A form along a cusp: one leaf passes through it."""
    forms = {"coordinates": ["x", "y", "z"], "constraints": ["y^2 = x^3", "dz = y dx"], **at(x=0, y=0, z=0)}
    assert dofkit.classify(forms).dof in (1, None)
    report = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["y^2 + x^4 = x^5"], **at(x=0, y=0)})
    assert (report.dof in (0, None), report.instantaneous_dof) == (True, 2)


@pytest.mark.parametrize(("text", "reference", "dof"), AT_A_KINK)
def test_kinks(text: str, reference: dict[str, Any], dof: int) -> None:
    report = dofkit.classify({"coordinates": ["x", "y"], "constraints": [text], **reference})
    assert (report.dof in (dof, None), report.instantaneous_dof) == (True, None)


@pytest.mark.parametrize(("coordinates", "text", "dof"), HIDDEN_NUMBERS)
def test_numbers_that_are_zero_unseen(coordinates: str, text: str, dof: int) -> None:
    report = dofkit.classify(dofkit.load({"coordinates": coordinates.split(), "constraints": [text]}))
    assert report.dof in (dof, None)
    assert report.consistent is not False


def test_what_was_done_is_said() -> None:
    def said(*constraints: str) -> str:
        return " ".join(dofkit.classify(dofkit.load({"coordinates": ["x", "y"], "constraints": constraints})).warnings)

    assert "a power is zero where its base is" in said("(x - y)^3 = 0")
    assert "a sum of squares" in said("x^2 + y^2 = 0")
    assert "several branches" in said("x y = 0")
    assert "whole region" in said("x + abs(x) = 0")
    assert "removed by squaring" in said("sqrt(x^2 + y^2) = x")
    assert "no real configuration" in said("x^2 + y^2 = 1", "(x - 5)^2 + y^2 = 1")
    assert "-x >= 0" in said("x + abs(x) = 0", "x = 1")
    assert "it has no real value anywhere" in said("sqrt(-1 - x^2) y = 0")


@pytest.mark.parametrize(
    ("text", "dof", "extra"),
    [
        ("sqrt(x^2 + 2 x y + y^2) = x + y", 2, 1),  # |x + y| = x + y, on a half plane
        ("sqrt(x^2 - 2 x + 1) + x = 1", 2, 1),  # x <= 1
        ("sqrt(x^2 - 2 x + 1)^3 = (x - 1)^3", 2, 1),  # x >= 1
        ("sqrt(x^2 + 2 x y + y^2) = x + y + 1", 1, 0),  # x + y = -1/2
        ("sqrt(x^2 + 2 x y + 2 y^2) = x + y", 1, 0),  # no square: y = 0, x >= 0
    ],
)
def test_a_root_of_a_square_that_is_written_out_is_an_absolute_value(text: str, dof: int, extra: int) -> None:
    report = dofkit.classify({"coordinates": ["x", "y"], "constraints": [text]})
    assert (report.dof, report.redundant_equations) == (dof, extra)
    assert report.redundant in ([], None)
