"""Lines of the report: what to give where the freedom is open, and sentences whose grammar follows the numbers."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import dofkit

#: Landau's centrifugal governor: two arms of equal length from the ground, two more to a sleeve below.
_PLACES = {"A": ["a/2", 0, "-sqrt(3) a/2"], "B": ["-a/2", 0, "-sqrt(3) a/2"], "C": [0, 0, "-sqrt(3) a"]}


def governor(*, drawn: bool) -> dict[str, Any]:
    """It turns with Omega; every mass is drawn, or none."""
    ends = [([0, 0, 0], "A"), ([0, 0, 0], "B"), ("A", "C"), ("B", "C")]
    arms = [{"type": "link", "between": list(pair), "length": "a"} for pair in ends]
    turning = [f"x_{m} sin(Omega t) = y_{m} cos(Omega t)" for m in "AB"]
    return {
        "parameters": {"a": "positive", "Omega": "nonzero"},
        "particles": [{"name": m, "at": at} if drawn else {"name": m} for m, at in _PLACES.items()],
        "constraints": [*arms, "x_C = 0", "y_C = 0", *turning],
    }


def test_what_is_undecided_for_want_of_a_drawing_says_so() -> None:
    """exp(x) >= 1 + x, so both are equal and A is at the origin."""
    tangent = {"dimension": 2, "particles": ["A"], "constraints": ["exp(x_A) + exp(y_A) = 2 + x_A + y_A"]}
    blind = dofkit.classify(tangent)
    assert blind.dof is None
    assert any("give `at` for A" in warning for warning in blind.warnings)
    seen = dofkit.classify(tangent | {"particles": [{"name": "A", "at": [0, 0]}]})
    assert seen.dof == 0
    assert not any("give `at`" in warning for warning in seen.warnings)


def test_the_drawing_tells_the_part_of_the_set() -> None:
    """With the collar at the pivot each mass has a circle to itself; as drawn only the height is free."""
    assert dofkit.classify(governor(drawn=False)).dof == 2
    seen = dofkit.classify(governor(drawn=True))
    assert (seen.dof, seen.verdict) == (1, "proved")


def test_what_shows_an_answer_is_no_warning() -> None:
    """A door on two hinges: the second says nothing new, and nothing is open or singular."""
    hinges = [
        {"name": n, "type": "hinge", "between": ["ground", "door"], "at": [0, 0, z], "axis": "z"}
        for n, z in (("lower", 0), ("upper", 2))
    ]
    report = dofkit.classify({"bodies": ["door"], "constraints": hinges})
    assert (report.dof, report.singular, report.warnings) == (1, False, [])
    assert "All 5 of its equations are implied by the preceding ones" in report.constraints[1].reason


def test_one_coordinate_and_one_equation_are_singular() -> None:
    report = dofkit.classify({"coordinates": ["x"], "constraints": ["x = 1", "2 x = 2"]})
    assert "1 coordinate in 1 independent subsystem" in report.modelled
    assert "only 1 of the 2 geometric equations is independent" in (report.count.errs or "")


def test_a_witness_satisfies_the_relations_of_every_block() -> None:
    """Blocks that are equal up to names have their own points; blocks that share a parameter have one value of it."""
    twins = {"coordinates": ["x", "y", "u", "v"], "constraints": ["x^3 + y^2 = 5", "u^3 + v^2 = 5"]}
    at = {name: float(Fraction(text)) for name, text in (dofkit.classify(twins).witness or {}).items()}
    assert abs(at["x"] ** 3 + at["y"] ** 2 - 5) < 1e-12
    assert abs(at["u"] ** 3 + at["v"] ** 2 - 5) < 1e-12
    shared = {"parameters": {"a": "positive"}, "coordinates": ["x", "y", "u", "v"]}
    shared["constraints"] = ["x^3 + y^2 = a", "u^5 + v = a^2"]
    at = {name: float(Fraction(text)) for name, text in (dofkit.classify(shared).witness or {}).items()}
    assert abs(at["x"] ** 3 + at["y"] ** 2 - at["a"]) < 1e-12
    assert abs(at["u"] ** 5 + at["v"] - at["a"] ** 2) < 1e-12


def test_no_witness_is_put_together_of_points_with_other_parameters() -> None:
    """x asks for a >= 7/8 and y for a <= 9/8: most values of a do for one of the two only."""
    apart = {"parameters": ["a"], "coordinates": ["x", "y"], "constraints": ["x^2 = a - 7/8", "y^2 = 9/8 - a"]}
    at = dofkit.classify(apart).witness
    if at is not None:
        found = {name: float(Fraction(text)) for name, text in at.items()}
        assert abs(found["x"] ** 2 - found["a"] + 7 / 8) < 1e-12
        assert abs(found["y"] ** 2 - 9 / 8 + found["a"]) < 1e-12


def test_a_product_with_a_factor_that_is_zero_everywhere() -> None:
    """tanh w = 1 - 2 / (e^(2 w) + 1), so that nothing is said of x."""
    product = "(tanh(w) - 1 + 2/(exp(2*w) + 1))*(x - 1) = 0"
    assert dofkit.classify({"coordinates": ["x", "y", "z", "w"], "constraints": [product]}).dof == 4


def test_what_integrates_together_with_another_says_to_what() -> None:
    """dz = y dx alone does not integrate; with y constant z - y x is constant too."""
    together = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": ["dz = y dx", "dy = 0"]})
    assert "together with 'c2' it integrates to x*y - z = C" in together.constraints[0].reason


def test_a_proof_by_counting_needs_no_warning() -> None:
    links = [{"type": "link", "between": [*pair]} for pair in ("AB", "BC")]
    report = dofkit.classify({"dimension": 1, "particles": [*"ABC"], "constraints": links})
    assert (report.verdict, report.warnings) == ("proved", [])


def test_that_nothing_can_be_dropped_is_reported_of_all_components() -> None:
    """Without the first r may be negative, without another x or y has either sign; near a point one of them follows."""
    texts = ["r = sqrt(x^2 + y^2)", "x = r*cos(theta)", "y = r*sin(theta)"]
    report = dofkit.classify({"coordinates": ["x", "y", "r", "theta"], "constraints": texts})
    assert (report.redundant, report.verdicts["redundant"].about) == ([], "everywhere")
