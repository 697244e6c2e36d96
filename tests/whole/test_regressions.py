"""Scenes that were once answered wrong, with the answers derived by hand; one row each, and why it is so."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from shared.known_scenes import swept

import dofkit

XYZ = ["x", "y", "z"]
PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59)


def scene(*constraints: Any, coordinates: list[str] | None = None, **more: Any) -> dict[str, Any]:
    return {"coordinates": coordinates or XYZ, "constraints": list(constraints), **more}


TABLE: list[tuple[str, dict[str, Any], dict[str, Any]]] = [
    (
        "no prime has 17 square roots; their sum is 80.05, and 80.05/sqrt(2) < 100",
        scene(f"x - y = {' + '.join(f'sqrt({p})' for p in PRIMES)}", "x^2+y^2=10000", coordinates=["x", "y"]),
        {"consistent": True, "dof": 0},
    ),
    ("a root of velocities is no crash", scene("sqrt(xdot^2+ydot^2)=zdot"), {"dof": 3, "velocity_dof": 2}),
    ("without c3 the plane y=0 appears", scene("x*y=0", "y*z=0", "z*x=0"), {"dof": 1, "redundant": []}),
    ("x*y=0 and x*z=0: neither can go", scene("x*y=0", "x*z=0"), {"dof": 2, "redundant": []}),
    ("one of two branches", scene("y^2=sin(x)^2", "y=sin(x)"), {"dof": 2, "redundant": ["c1"]}),
    ("its other one", scene("y^2=1-cos(x)^2", "y=-sin(x)"), {"dof": 2, "redundant": ["c1"]}),
    ("powers to numbers have one base", scene("y=2^x", "z=4^x", "z=y^2+1e-9"), {"consistent": False}),
    ("4^z = 2^(2 z)", scene("dy + (4^z - 2^(2*z)) x dx = 0"), {"holonomic": True, "dof": 2}),
    ("2^(1/2) is a power of 2", scene("dy + (sqrt(2)^(2*z) - 2^z) x dx = 0"), {"holonomic": True, "dof": 2}),
    (
        "x = y = 0 is the larger part",
        scene("x = y^2", "x^2 = y^2 z", "x w = y^2 u", coordinates=["x", "y", "z", "w", "u"]),
        {"dof": 3},
    ),
    (
        "two minors say less than three where a = d = 0",
        scene("a e = b d", "a f = c d", "b f = c e", coordinates=list("abcdef")),
        {"dof": 4, "redundant": []},
    ),
    (
        "without c2 there is the line x = y = 0",
        scene("x z = y^2", "x y = z", "x^2 = y"),
        {"dof": 1, "redundant": ["c1"]},
    ),
    ("dy/dx has no value where dx = 0", scene("dy/dx = 2", "x = 3"), {"consistent": False}),
    ("nor has dy/(dx + dy)", scene("dy/(dx + dy) = 2", "x + y = 3"), {"consistent": False}),
    ("each is x = 0", scene("exp(x) = 1 + x", "sin(x) = x"), {"dof": 2, "redundant": ["c2"]}),
    (
        "x = y = 0 by the first alone",
        scene("cosh(x) + y^2 = 1", "x = y", "zdot = w udot (1 + x)", coordinates=list("xyzwu")),
        {"redundant": ["c2"]},
    ),
    (
        "circles that miss each other by 1e-99",
        scene("x^2 + y^2 = 1", "(x - 3 - 1/10^50/10^49)^2 + y^2 = 4"),
        {"consistent": False},
    ),
    ("half a line is no line", scene("y=x", "atan2(y,x)=-3*pi/4"), {"dof": 2, "redundant": ["c1"]}),
    ("so it is wherever x < 0", scene("atan(x) + atan(1/x) = -pi/2"), {"consistent": True, "dof": 3}),
    ("half a circle is no circle", scene("x^2+y^2=l^2", "y=-sqrt(l^2-x^2)", parameters=["l"]), {"redundant": ["c1"]}),
    ("x = 0 follows over the reals only", scene("x^2+y^2=z", "z+x^2+y^2=0", "x=0"), {"dof": 0, "redundant": ["c3"]}),
    (
        "no other real root",
        scene("(x^2+y^2)^16=l^32", "x^2+y^2=l^2", parameters={"l": "positive"}),
        {"redundant": ["c2"]},
    ),
    ("a start outside of a root's domain", scene("y=sqrt(1-x^2)", "x^2+y^2=1"), {"dof": 2, "redundant": ["c2"]}),
    ("c1 = x c2", scene("x^3-x*y^2=0", "x^2=y^2", coordinates=["x", "y"]), {"dof": 1, "redundant": ["c1"]}),
    ("ydot^2 = -3", scene("xdot^2+ydot^2=1", "xdot=2"), {"consistent": False, "conflicting": ["c1", "c2"]}),
    ("ydot = 0 follows", scene("xdot^2+ydot^2=1", "xdot=1"), {"dof": 1, "velocity_dof": 1, "holonomic": True}),
    ("everything at rest", scene("xdot^2+ydot^2=zdot^2", "zdot=0"), {"dof": 0, "holonomic": True}),
    ("zdot = +-sqrt(5) xdot", scene("y=2*x", "xdot^2+ydot^2=zdot^2"), {"dof": 1, "holonomic": True}),
    ("zdot = +-xdot", scene("x=y", "xdot*ydot=zdot^2"), {"dof": 1, "holonomic": True}),
    ("the branch x=1 is the larger", scene("(xdot^2+ydot^2)*(x-1)=0"), {"dof": 2, "velocity_dof": 2}),
    ("both squares vanish", scene("(xdot-y*zdot)^2+(x-1)^2=0"), {"consistent": True, "dof": 1}),
    ("x=t follows from its rate", scene("(xdot-1)^2+(x-t)^2=0"), {"consistent": True, "dof": 2}),
    ("no root of -1, though y = 0", scene("sqrt(x) y = 0", "x = -1"), {"consistent": False}),
    ("0/0 is no value", scene("y/x = 0", "x = 0"), {"consistent": False}),
    ("a root that is nowhere real, times y", scene("sqrt(-1-x^2) y = 0"), {"consistent": False}),
    ("the half space x <= 0 does not reach x = 1", scene("x+abs(x)=0", "x=1"), {"consistent": False}),
    ("(x^2)^(1/4) is sqrt(|x|)", scene("(x^2)^(1/4) = y", "x = -4"), {"consistent": True, "dof": 1}),
    ("the origin, though sqrt(-1) |x| has no value", scene("sqrt(-x^2) = y"), {"dof": None}),
    ("holds wherever x <= 0", scene("x+abs(x)=0"), {"dof": 3}),
    ("both cosines vanish", scene("cos(x)^2+cos(y)^2=0"), {"dof": 1}),
    ("both cosines are 1", scene("cos(x)+cos(y)=2"), {"dof": 1}),
    ("a circle of radius 1e-15", scene("x^2+y^2 = 1e-30"), {"dof": 2}),
    ("beside the circle by 1e-60", scene("x^2+y^2 = 1", "x = 1+1e-60"), {"consistent": False}),
    ("on the circle", scene("x^2+y^2 = 1", "x = 1"), {"consistent": True, "dof": 1}),
    ("cosh >= 1", scene("cosh(x) = 1-1e-60"), {"consistent": False}),
    ("x y <= 1 where x + y = 2", scene("x+y = 2", "x*y = 1+1e-60"), {"consistent": False}),
    ("beside the plane of a ball by 1e-60", scene("x+y+z = 3", "x^2+y^2+z^2 = 3-1e-60"), {"consistent": False}),
    ("the plane of a ball", scene("x+y+z = 3", "x^2+y^2+z^2 = 3"), {"consistent": True, "dof": 0}),
    ("far away", scene("x = 1e30"), {"dof": 2}),
    ("the root of minus x", scene("sqrt(-x) = 1"), {"dof": 2}),
    ("logs of two negative numbers", scene("log(x y) = 0", "x = -2"), {"dof": 1}),
    ("a constant factor that is 0", scene("(sqrt(5+2*sqrt(6))-sqrt(2)-sqrt(3))*(x-1) = 0"), {"dof": 3}),
    ("a pole is no zero", scene("z = 0", "z + tan(2*x) - 2*tan(x)/(1-tan(x)^2) + 1e-9 = 0"), {"consistent": False}),
    ("an unseen 0 before a form", scene("dx - y dz = 0", "(asin(1/2)-pi/6)*dz = 0"), {"dof": 3, "redundant": ["c2"]}),
    ("a conjugate root is no zero", scene("z = 0", "z + sqrt(11-6*sqrt(2))+3-sqrt(2) = 0"), {"consistent": False}),
    ("a plane tilted by 1e-25", scene("z = 0", "z + (abs(y)-sqrt(y^2)+1e-25)*x = 0"), {"dof": 1, "redundant": []}),
    ("c2 follows, by a nested root", scene("z=0", "z + (sqrt(3+2*sqrt(2))-1-sqrt(2))*x=0"), {"redundant": ["c2"]}),
    ("an open branch may be the larger", scene("(acos(1-2*y^2)-2*asin(abs(y)))*(x-1) = 0"), {"dof": 3}),
    ("numbers that only exp of a product hides", scene("dx + 1e9*(exp(2)*exp(-2)-1)*(dz-y dx) = 0"), {"dof": 2}),
    (
        "three joints in a line, by a nested root",
        {
            "dimension": 2,
            "particles": [
                {"name": "A", "at": [0, 0]},
                {"name": "B", "at": [1, 0]},
                {"name": "C", "at": [2, "sqrt(3+2*sqrt(2)) - 1 - sqrt(2)"]},
            ],
            "constraints": [{"type": "link", "between": pair} for pair in (["A", "B"], ["B", "C"], ["A", "C"])],
        },
        {"dof": 3, "instantaneous_dof": 4, "singular": True},
    ),
    ("the constant is 0", scene("z = 0", "z + atan(1)-pi/4 = 0"), {"consistent": True, "dof": 2}),
    ("the constant is not 0", scene("z = 0", "z + pi - 22/7 = 0"), {"consistent": False}),
    ("nested root that is 0", scene("(sqrt(5+2*sqrt(6))-sqrt(2)-sqrt(3)) y dz + dy - dx = 0"), {"holonomic": True}),
    ("Machin's formula", scene("(4*atan(1/5)-atan(1/239)-pi/4) y dz + dy - dx = 0"), {"holonomic": True}),
    ("cos(pi/5) by radicals", scene("dx + (cos(pi/5) - (1+sqrt(5))/4) dt = 0"), {"scleronomic": True}),
    ("a huge multiple of an angle", scene("z = 0", "z + sin(1e9*x) = 0"), {"dof": 1}),
    ("no solution, however small exp is", scene("z = 0", "z + exp(-200 x) = 0"), {"dof": None}),
    ("a factor of time alone", scene("t*(x-y)=0"), {"dof": 2, "scleronomic": True}),
    ("a factor of time alone before a form", scene("t*(dz - y dx) = 0"), {"scleronomic": True, "holonomic": False}),
    ("an unknown factor of time", scene("f(t)*(dz - y dx) = 0", functions={"f": ["t"]}), {"scleronomic": True}),
    ("time turns the form", scene("cos(t) dx + sin(t) dy = 0"), {"scleronomic": False}),
    ("x = a and x = -a", scene("x=a", "x=-a", parameters={"a": "nonzero"}), {"consistent": False}),
    ("a ball that holds 0 has squares", scene("z=0", "x^2+y^2+z^2=1", "x^2+y^2=1"), {"dof": 1, "redundant": ["c3"]}),
    ("without x=1 there is x=-1", scene("x^2+y^2=1", "x=1", "y=0"), {"dof": 1, "redundant": ["c3"]}),
    ("cos x = 1 says more", scene("sin(x)=0", "cos(x)=1"), {"dof": 2, "redundant": ["c1"]}),
    ("one written with exp, one with log", scene("exp(x)=y", "x=log(y)"), {"dof": 2, "redundant": ["c2"]}),
    (
        "the pivot is no hidden relation",
        scene("w+sin(x)=0", "dx*cos(x)+dw-(y+sin(x))*dt=0", coordinates=["x", "y", "w"]),
        {"dof": 1, "velocity_dof": 1},
    ),
    (
        "only w = y^2 + z is hidden",
        scene(
            "x+y*z=0",
            "cos(y)*dy+dz-y*dt=0",
            "dx+y*dz+z*dy+(y^2+z-w)*dt+x*(cos(y)*dy+dz-y*dt)=0",
            coordinates=["x", "y", "z", "w"],
        ),
        {"dof": 2, "velocity_dof": 1, "holonomic": False},
    ),
    (
        "c3 - dg = (q2-1)(dq1 - cos t dt) + (1-q2) dt with dq1 = cos t dt: q2 = 1, where the pivot vanishes",
        scene(
            "dq1 - dt*cos(t) + q1*(-2*dq1 + 2*dq2*q2 + dq3 - dt)=0",
            "(q1^2 + 1)*(q2^2 + q3 - t - 2*q1)=0",
            "dq1*q2 - 3*dq1 + 2*dq2*q2 + dq3 - dt*q2*cos(t) - dt*q2 + dt*cos(t)=0",
            coordinates=["q1", "q2", "q3"],
        ),
        {"consistent": True, "dof": 0, "velocity_dof": 0, "holonomic": True},
    ),
    (
        "minors that differ by what vanishes on the variety: q1 = 0 is hidden",
        scene(
            "q3 + q4^2 - q4 = 0",
            "(dq2 + dq3*q4^2*(q3 + q4^2 - q4) + dq4 - dt*q4 + q4^2*(dq3 + dq4*(2*q4 - 1) - dt*q1))*exp(q2) = 0",
            "(q1^2 + 1)*(dq2 + dq3 + dq4*(2*q4 - 1) + dq4 - dt*q1 - dt*q4 + q4^2*(dq3 + dq4*(2*q4 - 1) - dt*q1)) = 0",
            coordinates=["q1", "q2", "q3", "q4"],
        ),
        {"consistent": True, "dof": 2, "velocity_dof": 1, "holonomic": False},
    ),
    (
        "two lines cross at the reference",
        scene("p^2=q^2", coordinates=["p", "q"], configuration={"p": 0, "q": 0}),
        {"dof": 1, "instantaneous_dof": 2, "singular": True},
    ),
    (
        "only the axis passes through the reference",
        scene("z*(x^2+y^2)=0", configuration={"x": 0, "y": 0, "z": 1}),
        {"dof": 1, "instantaneous_dof": 1, "singular": False},
    ),
    (
        "the line x=y=1, not the plane",
        scene("z*(x-1)=0", "z*(y-1)=0", configuration={"x": 1, "y": 1, "z": 1}),
        {"dof": 1, "instantaneous_dof": 1, "redundant": []},
    ),
    (
        "the same pin, both blocks",
        {
            "dimension": 2,
            "bodies": ["a"],
            "constraints": [
                {"name": "p", "type": "revolute", "between": ["ground", "a"], "at": [0, 0]},
                {"name": "q", "type": "revolute", "between": ["ground", "a"], "at": [0, 0]},
            ],
        },
        {"dof": 1, "redundant": ["q"], "redundant_equations": 2},
    ),
    (
        "a body welded to the ground has a reference",
        {"dimension": 2, "bodies": ["a"], "constraints": [{"type": "weld", "between": ["ground", "a"]}]},
        {"dof": 0, "instantaneous_dof": 0, "singular": False},
    ),
    (
        "measured, nearly collinear: the bend is no motion",
        {
            "dimension": 2,
            "particles": [{"name": n, "at": at} for n, at in (("A", [0, 0]), ("B", [1, 0]), ("C", [2, 1e-7]))],
            "constraints": [{"type": "link", "between": pair} for pair in (["A", "B"], ["B", "C"], ["A", "C"])],
            "tolerance": 1e-5,
        },
        {"dof": 3, "instantaneous_dof": 4, "singular": True, "redundant": []},
    ),
    (
        "v sin(theta) = 0 is hidden, and then both forms are dy = 0: x is free",
        scene(
            "(xdot - v) sin(theta) - ydot cos(theta) = 0",
            "xdot sin(theta) - ydot cos(theta) = 0",
            coordinates=["x", "y", "theta"],
            parameters={"v": "positive"},
        ),
        {"consistent": True, "dof": 1, "velocity_dof": 1, "holonomic": True, "growth_vector": [2], "redundant": []},
    ),
    ("cos x = 1 is sin(x/2) = 0", scene("cos(x) = 1"), {"dof": 2, "verdict": "proved"}),
    ("both cosines are -1, told twice", scene("cos(x)+cos(y)=-2", "cos(y)=-1"), {"dof": 1, "redundant": ["c2"]}),
    ("no angle has both", scene("cos(x)=1", "cos(x)=-1"), {"consistent": False, "conflicting": ["c1", "c2"]}),
    ("sin = cos = 1 at no angle", scene("sin(x)+cos(x)=2"), {"consistent": False, "conflicting": ["c1"]}),
    (
        "what rolls obeys the quadratic relation, which no finite relation gives",
        scene(
            "dx = cos(theta) dphi",
            "dy = sin(theta) dphi",
            "dz = dphi",
            "xdot^2 + ydot^2 = zdot^2",
            coordinates=["x", "y", "z", "theta", "phi"],
        ),
        {"dof": 4, "velocity_dof": 2, "holonomic": False, "redundant": ["c4"], "redundant_equations": 1},
    ),
    (
        "a branch of c2 is c1",
        scene("zdot = y xdot", "zdot^2 = y^2 xdot^2"),
        {"redundant": ["c2"], "redundancies": [{"nullity": 1, "members": ["c1", "c2"]}]},
    ),
    (
        "c3 takes c1 and c2 together",
        scene("zdot = y xdot", "xdot^2 + udot^2 = 1", "zdot^2 + y^2 udot^2 = y^2", coordinates=["x", "y", "z", "u"]),
        {"redundant": ["c3"], "redundancies": [{"nullity": 1, "members": ["c1", "c2", "c3"]}]},
    ),
    ("zdot = 0 by difference", scene("xdot^2+ydot^2+zdot=1", "xdot^2+ydot^2=1"), {"dof": 2, "velocity_dof": 1}),
    (
        "z = 1 by difference",
        scene("xdot^2+ydot^2=1", "xdot^2+ydot^2=z"),
        {"dof": 2, "velocity_dof": 1, "redundant": []},
    ),
    ("2 - cos(t)^2 > 0", scene("xdot^2 = 2 - cos(t)^2"), {"consistent": True, "dof": 2, "holonomic": True}),
    ("y = z = 0 is hidden in c1 and c2", scene("x=0", "xdot=y^2+z^2", "y=0"), {"dof": 0, "redundant": ["c3"]}),
    ("flat beside bent", scene("xdot^2+ydot^2=z", "zdot^3=z*wdot^3", coordinates=[*XYZ, "w"]), {"dof": None}),
    ("x = 0, y = 2 pi is no solution of c3", scene("cos(x)=1", "cos(y)=1", "x=y"), {"redundant": ["c2"]}),
    (
        "ten equations in twenty unknowns",
        scene(
            *(" + ".join(f"{pow(i + 2, k + 1, 101)} q{i}" for i in range(20)) + f" = {k}" for k in range(10)),
            coordinates=[f"q{i}" for i in range(20)],
        ),
        {"consistent": True, "dof": 10},
    ),
]


#: Those that take seconds.
SLOW = ("powers to numbers have one base", "2 - cos(t)^2 > 0")


@pytest.mark.parametrize(
    ("made", "expected"),
    [swept(*row[1:]) if row[0] in SLOW else row[1:] for row in TABLE],
    ids=[row[0] for row in TABLE],
)
def test_what_was_wrong_once_is_right(made: dict[str, Any], expected: dict[str, Any]) -> None:
    report = dofkit.classify(dofkit.load(made)).model_dump(mode="json")
    undecided = report["verdict"] == "undecided"
    assert all(report[key] == value or (undecided and report[key] in (None, [])) for key, value in expected.items())


def test_the_time_for_a_scene_is_bounded() -> None:
    long = scene(*(f"dx{i} = x{i + 1} dx{i + 2}" for i in range(60)), coordinates=[f"x{i}" for i in range(70)])
    report = dofkit.classify(dofkit.load(long), budget=1.0)
    assert report.verdict in ("undecided", "probable", "proved")


def test_a_mixture_of_differentials_and_finite_terms_is_refused_with_its_line() -> None:
    with pytest.raises(dofkit.SceneError) as caught:
        dofkit.loads("coordinates: [x]\nconstraints:\n- dx + 1 = 0\n- sin(dx) = 0\n")
    assert [fault.line for fault in caught.value.faults] == [3, 4]


@pytest.mark.parametrize("text", ["xddot = 0", "x xddot + xdot^2 = 0", "xddot^2 = 1", "xddot >= 0", "d^2x/dt^2 = x"])
def test_a_second_derivative_in_a_constraint_is_refused_with_its_line(text: str) -> None:
    with pytest.raises(dofkit.SceneError) as caught:
        dofkit.loads(f"coordinates: [x]\nconstraints:\n- {text}\n")
    (fault,) = caught.value.faults
    assert fault.line == 3
    assert "second derivative" in fault.message


def test_hidden_relations_are_found_at_real_points_too() -> None:
    """Finite relations that no elimination solves, so that only real points are left: x + y = t still forces z = 1."""
    made = scene(
        "p^2 + q^2 + p q^3 = 2",
        "p^3 - q^3 + p q = 1",
        "x + y = t",
        "xdot + ydot = z + p - p",
        coordinates=["p", "q", "x", "y", "z"],
    )
    report = dofkit.classify(dofkit.load(made))
    assert (report.dof, report.velocity_dof) == (1, 1)


def test_branches_that_are_left_out_are_not_passed_over() -> None:
    """x = 0 solves all of y_i x = 0 and leaves the five y_i free; choices that take some y_i = 0 leave four at most."""
    made = scene(*(f"y{i} x = 0" for i in range(5)), coordinates=["x", *(f"y{i}" for i in range(5))])
    assert dofkit.classify(dofkit.load(made)).dof in (None, 5)


def test_redundancy_that_was_not_looked_for_is_not_denied() -> None:
    """Of u = v, v = w, u = w the last follows from the others, whatever else there is."""
    made = scene(
        "a b = 0",
        *(f"x{i} = {i + 1} x{i + 1} + 1" for i in range(15)),
        *("u = v", "v = w", "u = w"),
        coordinates=["a", "b", "u", "v", "w", *(f"x{i}" for i in range(16))],
    )
    report = dofkit.classify(dofkit.load(made))
    assert report.redundant == ["c19"] or report.verdict == "undecided"


@pytest.mark.parametrize(
    ("coordinates", "constraints", "dof"),
    [
        # flat to order 20, and to order 64: the set is the point
        ("x y", ["y = 0", "y = x^20"], 0),
        ("x y", ["y = 0", "y = x^64"], 0),
        # y^2 = x^60 (x - 2) < 0 for 0 < |x| < 2: the origin is isolated, the other points are on a curve with x >= 2
        ("x y", ["y^2 + x^60 (2 - x) = 0"], 0),
        # a cusp: x = s^2, y = s^63
        ("x y", ["y^2 = x^63"], 1),
        # x = y = 0 of the second, which makes the first 0
        ("x y z", ["x y = 0", "x^2 + y^2 + z^64 = 0"], 0),
        # two smooth curves y = x^32 and y = -x^32
        ("x y", ["y^2 = x^64"], 1),
        # the lines x = 0 and z = 0 in the plane y = 0
        ("x y z", ["y = 0", "y = x^64 z"], 1),
        # x^9 + z^9 = 0 is the line z = -x
        ("x y z", ["y = 0", "y = x^9 + z^9"], 1),
        # a motion for t >= 0
        ("x", ["x^2 = t"], 0),
    ],
)
def test_what_is_flat_or_starts_at_the_reference_is_not_guessed(
    coordinates: str, constraints: list[str], dof: int
) -> None:
    names = coordinates.split()
    report = dofkit.classify(dofkit.load(scene(*constraints, coordinates=names, configuration=dict.fromkeys(names, 0))))
    assert report.dof in (dof, None)
    assert report.dof == dof or report.verdict == "undecided"
    assert report.consistent is not False


@pytest.mark.parametrize("constraints", [["x = t", "x = t + t^2"], ["y = t", "y = t + x^2 + t^2"]])
def test_time_that_stands_still_is_not_a_proved_motion(constraints: list[str]) -> None:
    """t^2 = 0 and x^2 + t^2 = 0 hold at one instant only."""
    made = scene(*constraints, coordinates=["x", "y"], configuration={"x": 0, "y": 0})
    report = dofkit.classify(dofkit.load(made))
    assert report.consistent is False or report.verdict == "undecided"


@pytest.mark.sweep
def test_a_long_flag_is_followed_to_its_end() -> None:
    """Fifty chained forms: 51 brackets, more than the orders that a curve was followed to."""
    names = [f"z{i}" for i in range(52)]
    made = scene(*(f"d{a} = {b} du" for a, b in pairwise(names)), coordinates=[*names, "u"])
    report = dofkit.classify(dofkit.load(made))
    assert (report.dof, report.velocity_dof) == (53, 2)
    assert report.growth_vector == list(range(2, 54))


@pytest.mark.parametrize("size", ["1/3", "3"])
def test_a_form_that_is_zero_but_for_rounding_is_no_form(size: str) -> None:
    """Sarrus's linkage with both chains stretched, any size: alpha = beta and alpha = -beta cross."""
    sides = [("a", (2, 0), [0, 1, 0]), ("b", (0, 2), [1, 0, 0])]
    joints = [
        {
            "type": "revolute",
            "between": list(pair),
            "at": [f"{x} * {size}", f"{y} * {size}", f"{z} * {size}"],
            "axis": axis,
        }
        for name, (x, y), axis in sides
        for z, pair in enumerate(pairwise(("ground", f"{name}1", f"{name}2", "plate")))
    ]
    report = dofkit.classify(dofkit.load({"bodies": ["a1", "a2", "plate", "b1", "b2"], "constraints": joints}))
    assert (report.dof, report.instantaneous_dof) == (1, 2)


@pytest.mark.parametrize("away", [0, 100, 10**6])
def test_a_measured_door_far_from_the_origin_has_no_freedom_of_its_own(away: int) -> None:
    """A turn about the origin moves what is far away by so much that a shift looked like nothing beside it."""
    hinges = [
        {"type": "revolute", "between": ["ground", "door"], "at": [away, away, z], "axis": [0, 0, 1]} for z in (0, 2)
    ]
    report = dofkit.classify(dofkit.load({"bodies": ["door"], "constraints": hinges, "tolerance": 1e-6}))
    assert report.instantaneous_dof in (1, None)
    assert report.dof in (1, None)
    assert away or report.dof == 1


def test_a_measured_crossing_of_branches_is_no_motion_of_both() -> None:
    """A flat parallelogram: two velocities, one motion; each direction led onto one of the branches."""
    particles = [{"name": "B", "at": [1, 0]}, {"name": "C", "at": [3, 0]}]
    ends = [[[0, 0], "B"], ["B", "C"], ["C", [2, 0]]]
    links = [{"type": "link", "between": pair} for pair in ends]
    made = {"dimension": 2, "particles": particles, "constraints": links, "tolerance": 1e-6}
    report = dofkit.classify(dofkit.load(made))
    assert (report.dof, report.instantaneous_dof, report.singular) == (1, 2, True)
