"""Special cases: loci and parameter values at which the answer is another one, derived by hand.

Each row: why it is so, the scene, and all cases as (where, what is said, of which constraints, verdict).
"""

from __future__ import annotations

from fractions import Fraction
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


def rolling(radius: str) -> dict[str, Any]:
    forms = ("dx = R cos(theta) dphi", "dy = R sin(theta) dphi")
    return scene(*forms, coordinates=["x", "y", "theta", "phi"], parameters={"R": radius})


INTEGRABLE = "c1 is holonomic"
ORIGIN, ONE = "x = 0 and y = 0", ("c1",)
KNIFE = "sin(theta) dx - cos(theta) dy = 0"
CAR = ["x", "y", "theta", "phi"]

LOCI: list[tuple[str, dict[str, Any], list[Case]]] = [
    ("sin and cos never vanish together", scene(KNIFE, coordinates=CAR[:3]), []),
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
        "x = y and x = -y",
        scene("x^2 = y^2", coordinates=["x", "y"]),
        [(ORIGIN, "two branches of c1 meet there", ONE, "proved")],
    ),
    (
        "three planes",
        scene("x y z = 0"),
        [
            (f"{a} = 0 and {b} = 0", "two branches of c1 meet there", ONE, "proved")
            for a, b in (("x", "y"), ("x", "z"), ("y", "z"))
        ],
    ),
    (
        "three planes through one line, which each two of them share",
        scene("z (x + y) (x + y + z) = 0"),
        [("y = -x and z = 0", "two branches of c1 meet there", ONE, "proved")],
    ),
    (
        "two planes meet in a line, which holds the point that is the third branch",
        scene("z (x + y + z) (x^2 + y^2 + z^2) = 0"),
        [("y = -x and z = 0", "two branches of c1 meet there", ONE, "proved")],
    ),
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
    ("an unknown function may vanish or not", scene("h(x)*dz = dx", functions={"h": ["x"]}), []),
    ("nonlinear in velocities: not searched", scene("xdot^2 + ydot^2 = zdot^2"), []),
]

PARAMETERS: list[tuple[str, dict[str, Any], list[Case]]] = [
    (
        "dx = 0 and dy = 0",
        rolling("real"),
        [("R = 0", "c1, c2 are holonomic; the degrees of freedom are 2 instead of 4", ("c1", "c2"), "proved")],
    ),
    ("R = 0 is excluded", rolling("positive"), []),
    ("R = 0 is excluded", rolling("nonzero"), []),
    (
        "(a - b) dx^dy",
        scene("dz = (a - b) y dx", parameters=["a", "b"]),
        [("a = b", f"{INTEGRABLE}; the degrees of freedom are 2 instead of 3", ONE, "proved")],
    ),
    (
        "positive parameters may be equal",
        scene("dz = (a - b) y dx", parameters={"a": "positive", "b": "positive"}),
        [("a = b", f"{INTEGRABLE}; the degrees of freedom are 2 instead of 3", ONE, "proved")],
    ),
    (
        "their sum is not 0",
        scene("dz = (a + b) y dx", parameters={"a": "positive", "b": "positive"}),
        [],
    ),
    (
        "an irrational value",
        scene("dz = (a^2 - 2) y dx", parameters=["a"]),
        [("a^2 = 2", f"{INTEGRABLE}; the degrees of freedom are 2 instead of 3", ONE, "proved")],
    ),
    (
        "two values",
        scene("dz = (a^2 - 1) y dx", parameters=["a"]),
        [(f"a = {v}", f"{INTEGRABLE}; the degrees of freedom are 2 instead of 3", ONE, "proved") for v in (1, -1)],
    ),
    (
        "only one of them is positive",
        scene("dz = (a^2 - 1) y dx", parameters={"a": "positive"}),
        [("a = 1", f"{INTEGRABLE}; the degrees of freedom are 2 instead of 3", ONE, "proved")],
    ),
    ("no real value", scene("dz = (a^2 + 1) y dx", parameters=["a"]), []),
    (
        "d omega = (a - b) dx^dy; with a = b = 0 nothing is left",
        scene("a x dy + b y dx = 0", coordinates=["x", "y"], parameters=["a", "b"]),
        [
            (
                "a = 0 and b = 0",
                "the degrees of freedom and velocity freedom are 2 instead of 1; c1 is redundant",
                ONE,
                "proved",
            ),
            (ORIGIN, drop(1, 0, 1), ONE, "proved"),
        ],
    ),
    (
        "one of two forms: dz = 0 leaves the knife edge",
        scene(KNIFE, "dz = a x dtheta", coordinates=["x", "y", "z", "theta"], parameters=["a"]),
        [("a = 0", "c2 is holonomic; the degrees of freedom are 3 instead of 4", ("c2",), "proved")],
    ),
    (
        "two knife edges at the distance b hold theta fast; at one place they are one",
        scene(KNIFE, "sin(theta) dx - cos(theta) dy + b dtheta = 0", coordinates=CAR[:3], parameters=["b"]),
        [
            (
                "b = 0",
                "c1, c2 are non-holonomic; the degrees of freedom are 3 instead of 1; "
                "the velocity freedom is 2 instead of 1; c2 is redundant",
                ("c1", "c2"),
                "proved",
            )
        ],
    ),
    (
        "two slopes that become one",
        scene("dy = a dx", "dy = 2 dx", coordinates=["x", "y"], parameters=["a"]),
        [
            (
                "a = 2",
                "the degrees of freedom and velocity freedom are 1 instead of 0; c2 is redundant",
                ("c2",),
                "proved",
            )
        ],
    ),
    (
        "a sphere becomes a point",
        scene("x^2 + y^2 + z^2 = L^2", parameters=["L"]),
        [("L = 0", "the degrees of freedom and velocity freedom are 0 instead of 2", ONE, "proved")],
    ),
    ("not where L is positive", scene("x^2 + y^2 + z^2 = L^2", parameters={"L": "positive"}), []),
    (
        "a circle becomes a point",
        scene("x^2 + y^2 = L", coordinates=["x", "y"], parameters=["L"]),
        [("L = 0", "the degrees of freedom and velocity freedom are 0 instead of 1", ONE, "proved")],
    ),
    (
        "a hyperbola becomes two lines",
        scene("x y = a", coordinates=["x", "y"], parameters=["a"]),
        [],
    ),
    (
        "the circle of latitude shrinks to a pole",
        scene("x^2 + y^2 + z^2 = R^2", "z = R sin(b)", parameters={"R": "positive", "b": "real"}),
        [("cos(b) = 0", "the degrees of freedom and velocity freedom are 0 instead of 1", ("c2",), "numeric")],
    ),
    (
        "a exp(k z) = b exp(k z), however it is written",
        scene("dx = exp(k z)*(a - b)*sin(a y)*dy", parameters={"a": "real", "b": "real", "k": "nonzero"}),
        [
            ("a = b", f"{INTEGRABLE}; the degrees of freedom are 2 instead of 3", ONE, "proved"),
            ("sin(y*a) = 0", flat("(2, 2, 3)", "(2, 3)"), ONE, "probable"),
        ],
    ),
    ("a line of any direction", scene("x sin(b) = y cos(b)", coordinates=["x", "y"], parameters=["b"]), []),
    (
        "two values for x",
        scene("x = a", "x = b", coordinates=["x", "y"], parameters=["a", "b"]),
        [],
    ),
    (
        "two speeds",
        scene("dx = a dt", "dx = b dt", coordinates=["x", "y"], parameters=["a", "b"]),
        [],
    ),
    (
        "parallel lines",
        scene("a x + y = 1", "x + y = 2", coordinates=["x", "y"], parameters=["a"]),
        [("a = 1", "c1 and c2 cannot be satisfied", ("c1", "c2"), "proved")],
    ),
    (
        "a x = b",
        scene("a x = b", coordinates=["x", "y"], parameters=["a", "b"]),
        [
            ("a = 0", "c1 cannot be satisfied", ONE, "proved"),
            (
                "a = 0 and b = 0",
                "the degrees of freedom and velocity freedom are 2 instead of 1; c1 is redundant",
                ONE,
                "proved",
            ),
        ],
    ),
    (
        "at rest",
        scene("dx = v dt", coordinates=["x"], parameters=["v"]),
        [("v = 0", "c1 is scleronomic", ONE, "proved")],
    ),
    (
        "no oscillation",
        scene("x = cos(w t)", coordinates=["x"], parameters=["w"]),
        [("w = 0", "c1 is scleronomic", ONE, "proved")],
    ),
    (
        "a pendulum whose support slides: no length is 0",
        scene(
            "y1 = 0",
            "(x2 - x1)^2 + (y2 - y1)^2 = L^2",
            coordinates=["x1", "y1", "x2", "y2"],
            parameters={"L": "positive"},
        ),
        [],
    ),
]


def told(report: Report) -> list[Case]:
    return [(c.where, c.what, tuple(c.constraints), c.verdict) for c in report.special_cases]


@pytest.mark.parametrize(
    ("given", "expected"), [row[1:] for row in LOCI + PARAMETERS], ids=[r[0] for r in LOCI + PARAMETERS]
)
def test_special_cases_by_hand(given: dict[str, Any], expected: list[Case]) -> None:
    assert sorted(told(dofkit.classify(dofkit.load(given)))) == sorted(expected)


@pytest.mark.parametrize("row", PARAMETERS, ids=[r[0] for r in PARAMETERS])
def test_the_generic_answer_is_that_of_a_random_value(row: tuple[str, dict[str, Any], list[Case]]) -> None:
    """No other field changes for the special values: a scene with random numbers for them is answered the same."""
    _, given, _ = row
    generic = dofkit.classify(dofkit.load(given))
    values = {name: str(Fraction(7 + 4 * i, 5)) for i, name in enumerate(given["parameters"])}
    numbers = dofkit.classify(dofkit.load({**given, "parameters": values}))
    fields = ("consistent", "dof", "velocity_dof", "holonomic", "scleronomic", "growth_vector")
    assert [getattr(generic, f) for f in fields] == [getattr(numbers, f) for f in fields]


def test_the_kinds_are_told_apart() -> None:
    both = scene("a x dy + b y dx = 0", coordinates=["x", "y"], parameters=["a", "b"])
    assert [c.kind for c in dofkit.classify(dofkit.load(both)).special_cases] == ["parameters", "locus"]


def test_it_says_whether_special_cases_were_sought() -> None:
    assert SEARCHED in dofkit.classify(dofkit.load(scene("dz = y dx"))).method
    long = " + ".join(f"x^{k}*y^{30 - k}" for k in range(30))
    assert SEARCHED not in dofkit.classify(dofkit.load(scene(f"dz = ({long})*dx"))).method


def test_measured_and_drawn_scenes_are_left_alone() -> None:
    drawn = {"dimension": 2, "particles": [{"name": "A", "at": [3, 4]}], "constraints": ["x_A^2 + y_A^2 = 25"]}
    assert dofkit.classify(dofkit.load(drawn)).special_cases == []
    assert dofkit.classify(dofkit.load({**drawn, "tolerance": 1e-3})).special_cases == []


def test_blocks_that_are_alike_have_their_own_loci() -> None:
    twins = scene("dz1 = y1^2 dx1", "dz2 = y2^2 dx2", coordinates=["x1", "y1", "z1", "x2", "y2", "z2"])
    cases = dofkit.classify(dofkit.load(twins)).special_cases
    assert [(c.where, c.constraints) for c in cases] == [("y1 = 0", ["c1"]), ("y2 = 0", ["c2"])]


def test_one_parameter_in_several_blocks_is_told_once() -> None:
    names = [f"{c}{i}" for i in (1, 2) for c in ("x", "y", "z")]
    pair = scene("dz1 = a y1 dx1", "dz2 = a y2 dx2", coordinates=names, parameters=["a"])
    cases = dofkit.classify(dofkit.load(pair)).special_cases
    assert [(c.where, c.what, c.constraints) for c in cases] == [
        ("a = 0", "c1, c2 are holonomic; the degrees of freedom are 4 instead of 6", ["c1", "c2"])
    ]
