"""Special cases: loci and parameter values at which the answer is another one, derived by hand.

Each row: why it is so, the scene, and all cases as (where, what is said, of which constraints, verdict).
"""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.classification.special.cases import SEARCHED
from dofkit.report import Report

XYZ = ["x", "y", "z"]
Case = tuple[str, str, tuple[str, ...], str]


def scene(*constraints: Any, coordinates: list[str] | None = None, **more: Any) -> dict[str, Any]:
    return {"coordinates": coordinates or XYZ, "constraints": list(constraints), **more}


def drop(rank: int, to: int, velocities: int) -> str:
    more = velocities + rank - to
    freedom = f"the instantaneous freedom is {more} instead of {velocities}"
    return f"the rank of the constraints drops from {rank} to {to} there, and {freedom}"


def flat(there: str, elsewhere: str) -> str:
    return f"the first Lie brackets add no direction there: the growth vector is {there} instead of {elsewhere}"


ORIGIN, ONE = "x = 0 and y = 0", ("c1",)
KNIFE = "sin(theta) dx - cos(theta) dy = 0"
CAR = ["x", "y", "theta", "phi"]

LOCI: list[tuple[str, dict[str, Any], list[Case]]] = [
    ("sin and cos never vanish together", scene(KNIFE, coordinates=CAR[:3]), []),
    ("dz is the arc length at x = 0 too", scene("x^2 + y^2 = 1", "xdot^2 + ydot^2 = zdot^2"), []),
    ("the contact form has curvature 1", scene("dz = y dx"), []),
    (
        "-2y dy^dx; [X, [X, Y]] = 2 d/dz",
        scene("dz = y^2 dx"),
        [("y = 0", flat("(2, 2, 3)", "(2, 3)"), ONE, "probable")],
    ),
    ("Martinet's form", scene("dz - y^2 dx/2 = 0"), [("y = 0", flat("(2, 2, 3)", "(2, 3)"), ONE, "probable")]),
    (
        "-3y^2 dy^dx: two more brackets are needed",
        scene("dz = y^3 dx"),
        [("y = 0", flat("(2, 2, 2, 3)", "(2, 3)"), ONE, "probable")],
    ),
    ("2y - 1 = 0", scene("dz = y*(y - 1) dx"), [("y = 1/2", flat("(2, 2, 3)", "(2, 3)"), ONE, "probable")]),
    ("-x dy^dx", scene("dz = x y dx"), [("x = 0", flat("(2, 2, 3)", "(2, 3)"), ONE, "probable")]),
    ("-z d/dz", scene("dz = z y dx"), [("z = 0", "the first Lie brackets add no direction there", ONE, "proved")]),
    ("exp never vanishes", scene("dz = exp(y) dx"), []),
    ("1 + y^2 never vanishes", scene("dz = (y + y^3/3) dx"), []),
    ("curvatures 1 and 2y are never both 0", scene("dz = y dx", "dw = y^2 dx", coordinates=[*XYZ, "w"]), []),
    ("both coefficients are 0", scene("x dy = y dx", coordinates=["x", "y"]), [(ORIGIN, drop(1, 0, 1), ONE, "proved")]),
    ("a coordinate more", scene("x dy = y dx"), [(ORIGIN, drop(1, 0, 2), ONE, "proved")]),
    (
        "x dx + y dy + z dz is 0 at the centre of the spheres",
        scene("x dx + y dy + z dz = 0"),
        [("x = 0 and y = 0 and z = 0", drop(1, 0, 2), ONE, "proved")],
    ),
    ("a factor of the whole form", scene("x*(dz - y dx) = 0"), [("x = 0", drop(1, 0, 2), ONE, "proved")]),
    ("a moving locus", scene("(x - t)*dz = 0", coordinates=["x", "z"]), [("x = t", drop(1, 0, 1), ONE, "proved")]),
    (
        "the two body components of the angular velocity have the determinant -sin(theta)",
        scene(
            "sin(theta)*sin(psi)*dphi + cos(psi)*dtheta = 0",
            "sin(theta)*cos(psi)*dphi - sin(psi)*dtheta = 0",
            coordinates=["phi", "theta", "psi"],
        ),
        [("sin(theta) = 0", drop(2, 1, 1), ("c1", "c2"), "proved")],
    ),
    (
        "at the poles x dy - y dx is 0, the sphere is not",
        scene("x^2 + y^2 + z^2 = 1", "x dy - y dx = 0"),
        [(ORIGIN, drop(2, 1, 1), ("c2",), "proved")],
    ),
    ("a curve in x, y without its origin", scene("x^2 + y^2 = 1", "x dy - y dx = 0"), []),
    (
        "the apex of a cone",
        scene("x^2 + y^2 = k^2 z^2", parameters={"k": "positive"}),
        [("x = 0 and y = 0 and z = 0", drop(1, 0, 2), ONE, "proved")],
    ),
    ("a cusp", scene("x^2 = y^3", coordinates=["x", "y"]), [(ORIGIN, drop(1, 0, 1), ONE, "proved")]),
    (
        "dt = 0 where y = 0",
        scene("y dx = dt", coordinates=["x", "y"]),
        [("y = 0", "no velocity satisfies the constraints there", ONE, "proved")],
    ),
    (
        "a car that steers: the tangent has poles",
        scene(
            KNIFE,
            "dtheta = tan(phi)/L*(cos(theta)*dx + sin(theta)*dy)",
            coordinates=CAR,
            parameters={"L": "positive"},
        ),
        [],
    ),
    (
        "dz = y w dx integrates on w = 0, everywhere alike",
        scene("w = 0", "dz = w y dx", coordinates=[*XYZ, "w"]),
        [],
    ),
    ("at t = 0 only", scene("dz = (y/t) dx"), []),
    ("1/y has a pole; its derivative never vanishes", scene("dz = dx/y"), []),
    ("(y^2 - 1)/(y - 1) has none", scene("dz = ((y^2 - 1)/(y - 1))*dx"), []),
    ("an inequality keeps away from the axis", scene("dz = y^2 dx", "y >= 1"), []),
    (
        "an inequality that lets it in",
        scene("dz = y^2 dx", "y >= 0"),
        [("y = 0", flat("(2, 2, 3)", "(2, 3)"), ONE, "probable")],
    ),
    (
        "w = t x dx + y dy: w = 0 where x = y = 0, and w ^ dw = x y dy ^ dt ^ dx",
        scene("t x dx + y dy = 0", coordinates=["x", "y"]),
        [
            (ORIGIN, drop(1, 0, 1), ONE, "proved"),
            *((f"{q} = 0", flat("(2, 2, 3)", "(2, 3)"), ONE, "probable") for q in "xy"),
        ],
    ),
    ("an unknown function may vanish or not", scene("h(x)*dz = dx", functions={"h": ["x"]}), []),
    ("nonlinear in velocities: not searched", scene("xdot^2 + ydot^2 = zdot^2"), []),
]


def told(report: Report) -> list[Case]:
    return [(c.where, c.what, tuple(c.constraints), c.verdict) for c in report.special_cases]


@pytest.mark.parametrize(("given", "expected"), [row[1:] for row in LOCI], ids=[r[0] for r in LOCI])
def test_special_cases_by_hand(given: dict[str, Any], expected: list[Case]) -> None:
    assert sorted(told(dofkit.classify(dofkit.load(given)))) == sorted(expected)


def test_it_says_whether_special_cases_were_sought() -> None:
    assert SEARCHED in dofkit.classify(dofkit.load(scene("dz = y dx"))).method
    long = " + ".join(f"x^{k}*y^{30 - k}" for k in range(30))
    assert SEARCHED not in dofkit.classify(dofkit.load(scene(f"dz = ({long})*dx"))).method
    not_drawn = {"dimension": 2, "bodies": ["b"], "constraints": [{"type": "revolute", "between": ["ground", "b"]}]}
    assert SEARCHED not in dofkit.classify(dofkit.load(not_drawn)).method


def test_measured_and_drawn_scenes_are_left_alone() -> None:
    drawn = {"dimension": 2, "particles": [{"name": "A", "at": [3, 4]}], "constraints": ["x_A^2 + y_A^2 = 25"]}
    assert dofkit.classify(dofkit.load(drawn)).special_cases == []
    assert dofkit.classify(dofkit.load({**drawn, "tolerance": 1e-3})).special_cases == []


def test_blocks_that_are_alike_have_their_own_loci() -> None:
    twins = scene("dz1 = y1^2 dx1", "dz2 = y2^2 dx2", coordinates=["x1", "y1", "z1", "x2", "y2", "z2"])
    cases = dofkit.classify(dofkit.load(twins)).special_cases
    assert [(c.where, c.constraints) for c in cases] == [("y1 = 0", ["c1"]), ("y2 = 0", ["c2"])]
