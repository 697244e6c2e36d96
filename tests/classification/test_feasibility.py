"""Inequalities together with the constraints: met at a point, or proved not to be, each worked out by hand."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest
from shared.known_scenes import spread

import dofkit
from dofkit.report import Report

PARAMETERS = {"L": "positive", "m": "real"}


def classified(texts: str, **more: Any) -> Report:
    made: dict[str, Any] = {"coordinates": ["x", "y", "z", "s", "a"], "parameters": PARAMETERS}
    return dofkit.classify({**made, "functions": {"h": ["s"]}, "constraints": texts.split("; "), **more})


#: What can be met, and why.
MET = [
    ("x >= 0", "one alone"),
    ("0 <= x <= L", "a chain"),
    ("x^2 + y^2 = 1; x >= 0; x <= 0", "(0, 1) and (0, -1)"),
    ("x^2 + y^2 = L^2; y >= 0", "a pendulum on a table"),
    ("x = cos(s); y = sin(s); z = s; z > 5; y < 0", "a bead on a helix, s in (5, 2 pi)"),
    ("x y = 0; x >= 1", "the branch y = 0"),
    ("x = t; x >= 100", "from t = 100 on"),
    ("x = t; y = t + 1; x >= 0; y <= 2", "0 <= t <= 1"),
    ("x >= m; x <= 1", "for m < 1"),
    ("xdot >= 1", "in motion"),
    ("xdot = ydot; xdot >= 1; ydot <= 2", "in motion, tied together"),
    ("sin(a) xdot - cos(a) ydot = 0; xdot >= 1; ydot >= 1; x <= 0", "an ice skate that heads up and right"),
    ("xdot^2 + ydot^2 = 4; xdot >= 1; x > 0", "a given speed"),
    ("xdot^2 + ydot^2 <= 0; x >= 1", "at rest"),
    ("ydot/xdot > 2", "in motion only: the slope has no value at rest"),
    ("ydot/xdot > 2; y = 3 x", "along a line of slope 3"),
    ("sqrt(x) >= 2; x < 5", "4 <= x < 5"),
    ("exp(x) >= y; y >= 3", "x above log 3"),
    ("tan(x) >= 1; cos(x) >= 1/10", "x = 1"),
]


@pytest.mark.parametrize(("texts", "why"), MET, ids=[row[0] for row in MET])
def test_what_can_be_met(texts: str, why: str) -> None:
    report = classified(texts)
    assert (report.consistent, report.feasible, report.infeasible) == (True, True, []), why
    assert report.feasible_at, why


#: What cannot, the minimal set (the earliest written), and why.
UNMET = [
    ("x^2 + y^2 = 1; x >= 2", "c1 c2", "the circle ends at 1"),
    ("x > 1; x < 0", "c1 c2", "a half-line each"),
    ("ydot/xdot > 2; x = 3", "c1 c2", "the slope has no value where x rests"),
    ("x > 0; x < 0; y > 0", "c1 c2", "y has no part in it"),
    ("x > 0; x <= 0", "c1 c2", "they touch, one of them open"),
    ("x^2 + y^2 < 1; x >= 1", "c1 c2", "they touch, the disc open"),
    ("x >= 0; y >= 0; x + y <= -1", "c1 c2 c3", "three half-planes, every two of which meet"),
    ("x > y; y > z; z > x; a > s", "c1 c2 c3", "a cycle"),
    ("x^2 + y^2 = L^2; y >= 2 L", "c1 c2", "a pendulum is no longer than itself"),
    ("x^2 + y^2 + z^2 = L^2; z > L", "c1 c2", "the same in space, open"),
    ("x = cos(s); y = sin(s); z = s; x > 1", "c1 c4", "a helix of radius 1"),
    ("x = L cos(a); y = L sin(a); y > L", "c2 c3", "sin(a) <= 1"),
    ("x = sin(t); x >= 2", "c1 c2", "at no time"),
    ("x = t; y = t; x >= 1; y <= 0", "c1 c2 c3 c4", "two clocks that agree"),
    ("x >= m; y <= m; x <= 0; y >= 1", "c1 c2 c3 c4", "m would be <= 0 and >= 1"),
    ("x >= L; x <= 0", "c1 c2", "L is positive"),
    ("exp(x) <= y; y <= 0", "c1 c2", "exp is positive"),
    ("sin(x) >= y; y >= 2", "c1 c2", "sin(x) <= 1"),
    ("abs(x) <= 1; x >= 2", "c1 c2", "|x| >= x"),
    ("abs(x) + abs(y) <= 1; x + y > 1", "c1 c2", "|x| + |y| >= x + y"),
    ("sqrt(x) >= 2; x < 4", "c1 c2", "x is the root's square"),
    ("x^2 >= 4; -1 <= x <= 1", "c1 c2", "outside of 2, within 1"),
    ("x y = 0; x >= 1; y >= 1", "c1 c2 c3", "neither branch"),
    ("xdot = ydot; xdot >= 1; ydot <= 0", "c1 c2 c3", "equal velocities"),
    ("x = y; xdot >= 1; ydot <= 0", "c1 c2 c3", "the rate of a finite relation"),
    ("xdot = 1; xdot <= 0", "c1 c2", "a given velocity"),
    ("xdot^2 + ydot^2 <= 1; xdot >= 2", "c1 c2", "a bounded speed"),
    ("xdot = y; x = 0; y >= 1", "c1 c2 c3", "y = 0 is hidden"),
]


@pytest.mark.parametrize(("texts", "names", "why"), UNMET, ids=[row[0] for row in UNMET])
def test_what_cannot_be_met(texts: str, names: str, why: str) -> None:
    report = classified(texts)
    assert (report.feasible, report.infeasible, report.feasible_at) == (False, names.split(), None), why
    assert report.consistent, "each by itself"
    assert not any("needs" in line for line in report.warnings), "every one of them is shown to be needed"


#: Met by touching only, or by nothing, or by some functions: at worst open.
HARD = [
    ("x^2 + y^2 <= 1; x >= 1", True, "a disc and a half-plane that touch at (1, 0)"),
    ("x y >= 1; x^2 + y^2 <= 2", True, "a hyperbola touches a disc at (1, 1)"),
    ("x y > 1; x^2 + y^2 <= 2", False, "2 x y <= x^2 + y^2"),
    ("x >= y; y >= z; z >= x; x = 3", True, "a cycle, all of them 3"),
    ("x^2 + y^2 <= 0", True, "the origin"),
    ("z = x^2 + y^2; z <= 0", True, "the lowest point of a bowl"),
    ("x = cos(s); y = sin(s); z = s; x >= 1; z > 5", True, "s = 2 pi"),
    ("abs(x) + abs(y) <= 1; x + y >= 1", True, "an edge"),
    ("z >= x^2 + y^2; z <= x - 1", False, "x^2 - x + 1 > 0"),
    ("log(x) >= 0; x < 1", False, "1 is not below 1"),
    ("x cos(a) + y sin(a) = L; x^2 + y^2 < L^2", False, "Cauchy and Schwarz"),
    ("x^3 <= y; y <= -x^3; x^2 <= x^4 - 1", True, "x = -2, y = 0"),
    ("x^4 + y^4 <= 1; x + y >= 2", False, "x + y <= 2^(3/4)"),
    ("x^4 + y^4 <= 2; x + y >= 2", True, "they touch at (1, 1)"),
    ("(x - 1/3)^2 + (y - 1/7)^2 <= 1; (x - 7/3)^2 + (y - 1/7)^2 <= 1", True, "discs that touch at (4/3, 1/7)"),
    ("(x - 1/3)^2 + (y - 1/7)^2 < 1; (x - 7/3)^2 + (y - 1/7)^2 <= 1", False, "the same, one of them open"),
    ("x^2 = 2; x >= 14142135623730950488/10^19", True, "the root of 2 is a little larger"),
    ("x^2 = 2; x >= 14142135623730950489/10^19", False, "and below this"),
    ("x = t; x >= 0; x <= 0", False, "at one instant only"),
]


@pytest.mark.parametrize(("texts", "truth", "why"), spread(HARD, several=True), ids=[row[0] for row in HARD])
def test_what_is_hard_is_right_or_open(texts: str, truth: bool, why: str) -> None:
    report = classified(texts)
    assert report.feasible in (truth, None), why
    if report.feasible is None:
        assert any("not decided" in line for line in report.warnings)
        assert report.verdicts["feasible"].verdict == "undecided"


@pytest.mark.parametrize("texts", ["h(x) >= 1; x >= 0", "y = h(x); y >= 0; x >= 1", "h(x) > h(y); x = y"])
def test_an_unknown_function_is_open(texts: str) -> None:
    assert classified(texts).feasible in ((None,) if "=" not in texts[-3:] else (None, False))


def test_without_inequalities_nothing_is_said() -> None:
    report = classified("x = 1; y = 2")
    assert (report.feasible, report.infeasible, report.feasible_at) == (None, [], None)


def test_what_contradicts_itself_is_infeasible() -> None:
    report = classified("x = 1; y >= 0; x = 2")
    assert (report.consistent, report.feasible, report.infeasible) == (False, False, ["c1", "c3"])
    alone = classified("x >= 0; sin(y) >= 2")
    assert (alone.consistent, alone.feasible, alone.infeasible) == (False, False, ["c2"])


def value(text: str, at: dict[str, str]) -> float:
    known = {name: float(dofkit_number(v)) for name, v in at.items()}
    return {"y": known.get("y", 0.0), "r": math.hypot(known.get("x", 0.0), known.get("y", 0.0))}[text]


def dofkit_number(text: str) -> float:
    top, _, bottom = text.partition("/")
    return float(top) / float(bottom or 1)


def test_the_point_is_on_the_constraints() -> None:
    at = classified("x^2 + y^2 = 1; y >= 1/3; y <= 1/2").feasible_at
    assert at is not None
    assert value("r", at) == pytest.approx(1)
    assert 1 / 3 < value("y", at) < 1 / 2
    at = classified("x + y >= 1; x - 2 y <= 3; y > -x/7").feasible_at
    assert at is not None
    x, y = (Fraction(at[name]) for name in "xy")
    assert x + y > 1
    assert x - 2 * y < 3
    assert y > -x / 7
    assert max(x.denominator, y.denominator) < 100, "linear: no decimals of a ball"


def test_a_pendulum_of_links_on_a_table() -> None:
    """The bob hangs below; it may stand above the table too, but never two lengths up."""
    bob = {"name": "A", "at": [0, -1]}
    rod = {"name": "rod", "type": "link", "between": [[0, 0], "A"]}
    made = {"dimension": 2, "particles": [bob]}
    above = dofkit.classify({**made, "constraints": [rod, {"name": "table", "type": "equation", "text": "y_A >= 0"}]})
    assert (above.feasible, above.dof, above.verdict) == (True, 1, "proved")
    never = dofkit.classify({**made, "constraints": [rod, {"name": "roof", "type": "equation", "text": "y_A >= 2"}]})
    assert (never.consistent, never.feasible, never.infeasible) == (True, False, ["rod", "roof"])


def test_a_door_in_its_drawing() -> None:
    """Two hinges in one line, one too many: the drawing itself is the point. It cannot be lifted."""
    hinge = {"type": "revolute", "between": ["ground", "door"], "axis": [0, 0, 1]}
    hinges = [{**hinge, "at": [0, 0, 0]}, {**hinge, "at": [0, 0, 2]}]
    open_ = dofkit.classify({"bodies": ["door"], "constraints": [*hinges, "x_door >= -1"]})
    assert (open_.feasible, open_.verdicts["feasible"].verdict, open_.dof) == (True, "proved", 1)
    assert open_.feasible_at is not None
    assert set(open_.feasible_at) == {"x_door", "y_door", "z_door", "phi_door", "theta_door", "psi_door"}
    lifted = dofkit.classify({"bodies": ["door"], "constraints": [*hinges, "z_door >= 1"]})
    assert (lifted.feasible, lifted.infeasible) == (False, ["c1", "c3"])


def test_four_bars_beside_a_wall() -> None:
    """The crank of length 1 reaches x = 1/2, and never 3/2: its pivot, itself and the wall."""
    places = {"A": [0, 0], "B": [0, 1], "C": [3, 2], "D": [3, 0]}
    links = [{"type": "link", "between": [*pair]} for pair in ("AB", "BC", "CD")]
    made = {"dimension": 2, "particles": [{"name": n, "at": at} for n, at in places.items()]}
    fixed = [{"type": "fixed", "point": p} for p in "AD"]
    assert dofkit.classify({**made, "constraints": [*fixed, *links, "x_B >= 1/2", "y_B >= 0"]}).feasible is True
    report = dofkit.classify({**made, "constraints": [*fixed, *links, "x_B >= 3/2"]})
    assert (report.feasible, report.infeasible) == (False, ["c1", "c3", "c6"])


def test_measured_geometry_is_open() -> None:
    made = {"dimension": 2, "tolerance": 1e-3, "particles": [{"name": "A", "at": [0.3, -0.95]}]}
    report = dofkit.classify({**made, "constraints": [{"type": "link", "between": [[0, 0], "A"]}, "y_A >= 0"]})
    assert report.feasible is None


def test_a_reference_does_not_confine_the_inequalities() -> None:
    """They are judged for all configurations: the circle's other half too."""
    report = classified("x^2 + y^2 = 1; x <= -1/2", configuration={"x": 1, "y": 0, "z": 0, "s": 0, "a": 0})
    assert report.feasible is True


@pytest.mark.sweep
def test_many_pendulums_of_one_length() -> None:
    names = [f"P{k}" for k in range(30)]
    texts = [t for n in names for t in (f"x_{n}^2 + y_{n}^2 = L^2", f"y_{n} >= 0")]
    made = {"dimension": 2, "parameters": PARAMETERS, "particles": names}
    report = dofkit.classify({**made, "constraints": texts})
    assert report.feasible is True
    low = dofkit.classify({**made, "constraints": [*texts, "y_P7 <= -L/10"]})
    assert (low.feasible, low.infeasible) == (False, ["c16", "c61"])


def test_what_is_not_shown_to_be_needed_is_said() -> None:
    """That h(x) >= 1 can be met alone hangs on h."""
    report = classified("h(x) >= 1; h(x) <= 0")
    assert (report.feasible, report.infeasible) == (False, ["c1", "c2"])
    assert any("whether 'c1', 'c2' are needed" in line for line in report.warnings)
