"""Scenes that were once answered wrongly, and sure: each right, or open, its truth worked out by hand."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit

H = {"h": ["s"]}
QUINTIC = "x^5 + 5*x^4*y + 10*x^3*y^2 + 10*x^2*y^3 + 5*x*y^4 + y^5"


def scene(coordinates: str, *constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": coordinates.split(), "constraints": [*constraints], **more}


#: What makes it hard, the scene, and the truth.
RIGHT: list[tuple[str, dict[str, Any], dict[str, Any]]] = [
    (
        "a power beside its terms in exponents: dx = 0",
        scene("x y z", f"xdot + y*(exp((x+y)^5) - exp({QUINTIC}))*zdot = 0"),
        {"holonomic": True, "dof": 2},
    ),
    (
        "cos(2 a) = 1 - 2 sin(a)^2 within an unknown function",
        scene("a x y z", "xdot + y*(h(cos(2 a)) - h(1 - 2*sin(a)^2))*zdot = 0", functions=H),
        {"holonomic": True, "dof": 3},
    ),
    (
        "h(x) = h(y) follows from x = y",
        scene("x y", "x = y", "h(x) = h(y)", functions=H),
        {"dof": 1, "redundant": ["c2"]},
    ),
    (
        "a driven cam: y = h(v t) follows",
        scene("x y", "y = h(x)", "x = v t", "y = h(v t)", functions=H, parameters=["v"]),
        {"consistent": True, "dof": 0, "redundant": ["c3"]},
    ),
    (
        "two beads that meet on a wire",
        scene("x1 y1 x2 y2", "y1 = h(x1)", "y2 = h(x2)", "x1 = x2", "y1 = y2", functions=H),
        {"dof": 1, "redundant_equations": 1},
    ),
    (
        "f(x) - f(y) vanishes where x = y",
        scene("x y z w", "x = y", "dz = (h(x) - h(y)) w dx", functions=H),
        {"holonomic": True, "dof": 2, "velocity_dof": 2},
    ),
    (
        "roots of the same number",
        scene("x y z w u", "x = y", "dw = z du", "dw - z du + (sqrt(1+x^2) - sqrt(1+y^2)) dz = 0"),
        {"holonomic": False, "dof": 4, "velocity_dof": 3, "redundant": ["c3"]},
    ),
    ("sin(x) = sin(t) follows from x = t", scene("x y", "x = t", "sin(x) = sin(t)"), {"redundant": ["c2"]}),
    (
        "a curve behind seven points",
        scene(
            "x y z",
            "x = 0",
            "xdot = (y^5+z^3+5)*" + "*".join(f"((y-{i})^2+(z-{i * i})^2)" for i in range(1, 8)),
        ),
        {"dof": 1},
    ),
]


@pytest.mark.parametrize(("made", "truth"), [row[1:] for row in RIGHT], ids=[row[0] for row in RIGHT])
def test_right(made: dict[str, Any], truth: dict[str, Any]) -> None:
    report = dofkit.classify(made)
    assert {key: getattr(report, key) for key in truth} == truth
    assert report.verdict != "undecided"


def test_a_quotient_that_is_rounded_excludes_no_solution() -> None:
    """w = 0 and u^2 = 7.4e-18 solve it exactly."""
    parts = ["z = 1/(6004799503160661/18014398509481984 + u^2)", "z - 3 = s", "s = 1/10^16 + w^2"]
    assert dofkit.classify(scene("u w z s", *parts)).consistent is not False


def test_an_exact_form_with_arguments_in_two_writings_is_not_called_inexact() -> None:
    """It is d(x sin(1/(1+y)))."""
    entry = dofkit.classify(scene("x y", "sin(1/(1+y))*xdot + x*cos(2/(2+2*y))*(-1)/(1+y)^2*ydot = 0")).constraints[0]
    assert entry.exact or entry.verdict == "undecided"


# Measured geometry with everything else attached

#: Three cranks, parallel and of one length within 1e-3: they move, and one link is redundant.
CRANKS = {"A": (0, 0), "B": (1, 0), "C": (2, 0), "D": (0.333, 0.943), "E": (1.333, 0.943), "F": (2.3334, 0.9427)}


def cranks(coordinates: str, *constraints: str, **more: Any) -> dict[str, Any]:
    """The cranks, and more."""
    links = [{"type": "link", "between": [*pair]} for pair in ("AD", "BE", "CF", "DE", "EF", "DF")]
    return {
        "dimension": 2,
        "tolerance": 1e-3,
        "particles": [{"name": name, "at": [*at]} for name, at in CRANKS.items()],
        "coordinates": coordinates.split(),
        "constraints": [*({"type": "fixed", "point": p} for p in "ABC"), *links, *constraints],
        **more,
    }


@pytest.mark.parametrize(
    ("made", "dof", "velocity_dof"),
    [
        (cranks(""), 1, 1),
        # dr - x_D dq on the turn of the cranks, q and r: d of it is -dx_D dq, and x_D turns
        (cranks("q r", "rdot = x_D*qdot"), 3, 2),
        (cranks("q r", "rdot = x_D*qdot", configuration={"q": 0, "r": 0}), 3, 2),
        # along the one motion of the cranks everything integrates
        (cranks("r", "rdot = x_D*ydot_D"), 1, 1),
    ],
)
def test_measured_cranks_with_a_form(made: dict[str, Any], dof: int, velocity_dof: int) -> None:
    report = dofkit.classify(made)
    assert (report.dof, report.velocity_dof, report.verdict) == (dof, velocity_dof, "numeric")
    assert report.holonomic == (dof == velocity_dof)
    assert report.redundant is not None
    assert "c9" in report.redundant


@pytest.mark.parametrize(
    ("made", "truth"),
    [
        # x_E - x_D is 1 on the cranks' motion, 1.0004 - 1e-4 ... as measured: r - q is constant, dof 2
        (cranks("q r", "rdot = (x_E - x_D)*qdot"), 2),
        # q is free, r is constant: A stands still
        (cranks("q r", "rdot = x_A*qdot"), 2),
        (cranks("q r", "rdot = h(x_D)*qdot", functions=H), 3),
        (cranks("u", "u = x_D^2"), 1),
    ],
)
def test_what_the_tolerance_may_hide_is_open(made: dict[str, Any], truth: int) -> None:
    report = dofkit.classify(made)
    assert (report.dof, report.verdict) in ((truth, "numeric"), (None, "undecided"))


@pytest.mark.parametrize(
    ("made", "dof", "velocity_dof"),
    [
        (cranks("u v", "u = v^2"), 2, 2),
        (cranks("u v", "u = v^2", configuration={"u": 1, "v": 1}), 2, 2),
        (cranks("u v", "u^2 + v^2 = 1", "2*u^2 + 2*v^2 = 2"), 2, 2),
        (cranks("u v w", "udot = v*wdot"), 4, 3),
    ],
)
def test_equations_beside_measured_geometry_stay_proved_and_it_stays_measured(
    made: dict[str, Any], dof: int, velocity_dof: int
) -> None:
    """Once it was put to exact arithmetic, and said to be rigid, where other coordinates were given no values."""
    report = dofkit.classify(made)
    assert (report.dof, report.velocity_dof, report.verdict) == (dof, velocity_dof, "numeric")
    own = [e for e in report.constraints if e.type == "equation"]
    assert {e.verdict for e in own} == {"proved"}


def test_relations_that_a_measured_drawing_does_not_meet_are_open() -> None:
    report = dofkit.classify(cranks("", "x_E = x_D + 2"))
    assert (report.dof, report.verdict) == (None, "undecided")
    assert dofkit.classify(cranks("", "x_E = x_D + 1")).dof == 1


def test_what_no_measured_number_enters_is_proved() -> None:
    ball = {"bodies": ["ball"], "parameters": ["R"], "constraints": ["z_ball = R"], "tolerance": 1e-6}
    report = dofkit.classify(ball)
    assert (report.dof, report.verdict) == (5, "proved")
    pendulum = {"dimension": 2, "particles": ["A"], "tolerance": 1e-3}
    link = {"type": "link", "between": [[0, 0], "A"], "length": "0.333"}
    assert dofkit.classify({**pendulum, "constraints": [link]}).dof == 1


def test_three_and_three_on_two_lines_measured() -> None:
    """(sqrt(a^2 + c), 0) and (0, sqrt(b^2 - c)) keep all nine lengths."""
    places = {"A": (1, 0), "B": (3, 0), "C": (-5, 0), "D": (0, 2), "E": (0, 4), "F": (0, -3)}
    made = {
        "dimension": 2,
        "tolerance": 1e-6,
        "particles": [{"name": name, "at": [*at]} for name, at in places.items()],
        "constraints": [{"type": "link", "between": [a, b]} for a in "ABC" for b in "DEF"],
    }
    report = dofkit.classify(made)
    assert (report.dof, report.verdict) == (4, "numeric")


# Flat contacts among many coordinates


MANY = [f"q{i}" for i in range(70)]
SQUARES = "+".join(f"{q}^2" for q in MANY)
#: Flat at 0: x^9/9! - ..., and -x^10/10! + ...
SINE = "(sin(x) - x + x^3/6 - x^5/120 + x^7/5040)"
COSINE = "(cos(x) - 1 + x^2/2 - x^4/24 + x^6/720 - x^8/40320)"


def flat(*constraints: str) -> dict[str, Any]:
    """Relations on x, y and seventy more, drawn at 0."""
    names = ["x", "y", *MANY]
    return scene(" ".join(names), *constraints, configuration=dict.fromkeys(names, 0))


@pytest.mark.parametrize(
    ("constraints", "truth"),
    [
        # y = 0 leaves SINE^3 (1 + ...) + COSINE^3 q0 = 0, or x^27 (1/9!^3 - x^3 q0/10!^3 + ...) = 0: near 0 x = 0
        (["y = 0", f"y = {SINE}^3*(1 + {SQUARES}) + {COSINE}^3*q0"], 70),
        (["y = 0", f"y = {COSINE}*(1 + {SQUARES})"], 70),
        (["y = 0", f"y = {SINE}^2*(2 + cos(q3))"], 70),
        # the second follows: x and all others are free
        (["y = 0", f"y*(2 + cos(x) + {SQUARES}) = y^3*sin(q0)"], 71),
        (["y = sin(x)", f"y*(1 + {SQUARES}) = sin(x)*(1 + {SQUARES})"], 71),
    ],
)
def test_flat_relations_among_many_coordinates(constraints: list[str], truth: int) -> None:
    report = dofkit.classify(flat(*constraints))
    assert report.dof in ((truth,) if truth == 71 else (truth, None))
    assert (report.dof is None) == (report.verdict == "undecided")
