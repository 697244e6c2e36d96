"""What looks for evidence: texts, floats, elimination, squares."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from dofkit.checker.grammar import KnownNames, parse
from dofkit.checker.problem import read_problem
from dofkit.checker.trees import number
from dofkit.methods.certificates.elimination import Pivot, echelon, least_step, solved
from dofkit.methods.certificates.estimates import Estimates, NoEstimateError, Values
from dofkit.methods.certificates.integrals import determinant
from dofkit.methods.certificates.rigid_fields import motions
from dofkit.methods.certificates.texts import number_text, text_of

NAMES = KnownNames(frozenset({"x", "y"}), {}, {"h": ("u",)})
TEXTS = [
    "x + 2*y - 3",
    "x*(y + 1)/7",
    "-x^2*sin(y)",
    "sqrt(x^2 + 1)*exp(-y)",
    "2*pi*x",
    "x^(1/3)",
    "atan2(y, x)",
    "(1/2)/(x - 1)",
]


@pytest.mark.parametrize("text", TEXTS)
def test_texts_are_read_again_with_the_same_value(text: str) -> None:
    tree = parse(text, NAMES)
    values = Estimates({"x": 1.375, "y": 0.625})
    assert values.value(parse(text_of(tree), NAMES)) == pytest.approx(values.value(tree), rel=1e-14)


@pytest.mark.parametrize("text", TEXTS)
def test_gradients_are_slopes(text: str) -> None:
    tree, step = parse(text, NAMES), 1e-6
    ahead, back = (
        Values({"x": 1.375 + step, "y": 0.625}).value(tree),
        Values({"x": 1.375 - step, "y": 0.625}).value(tree),
    )
    found = Estimates({"x": 1.375, "y": 0.625}).gradient(tree).get("x", 0.0)
    assert found == pytest.approx((ahead - back) / (2 * step), abs=1e-8)


def test_what_has_no_value_says_so() -> None:
    with pytest.raises(NoEstimateError):
        Estimates({"x": -1.0, "y": 0.0}).value(parse("sqrt(x)", NAMES))
    with pytest.raises(NoEstimateError):
        Values({"x": 0.0, "y": 0.0}).value(parse("1/x", NAMES))


def test_numbers() -> None:
    assert (number_text(Fraction(-3, 4)), number_text(5)) == ("-3/4", "5")


def test_rows_are_kept_in_their_order() -> None:
    rows = [{"a": 1.0, "b": 2.0}, {"a": 2.0, "b": 4.0}, {"b": 1.0, "c": 1.0}]
    found = echelon(rows)
    assert found.pivots == [Pivot(0, "b"), Pivot(2, "c")] or found.pivots == [Pivot(0, "b"), Pivot(2, "a")]
    assert found.dependent == [1]


def test_square_systems() -> None:
    assert solved([{"a": 2.0}, {"a": 1.0, "b": 1.0}], [4.0, 5.0], ["a", "b"]) == {"a": 2.0, "b": 3.0}
    assert solved([{"a": 1.0}, {"a": 1.0}], [1.0, 1.0], ["a", "b"]) is None


def test_the_least_step_is_along_the_row() -> None:
    step = least_step([{"a": 3.0, "b": 4.0}], [25.0])
    assert (step["a"], step["b"]) == pytest.approx((3.0, 4.0))


def test_determinants() -> None:
    rows = [[number(2), number(1)], [number(5), number(4)]]
    assert math.isclose(Values({}).value(determinant(rows)), 3.0)


def test_rigid_motions_of_the_plane() -> None:
    found = motions({"particles": ["A"], "bodies": [{"name": "B"}]}, 2)
    assert found[0] == {"x_A": "1", "x_B": "1"}
    assert found[2] == {"x_A": "-y_A", "x_B": "-y_B", "y_A": "x_A", "y_B": "x_B", "theta_B": "1"}
    assert motions({"bodies": ["B"]}, 3) == []


def test_the_reading_is_the_checkers() -> None:
    problem = read_problem({"coordinates": ["x"], "constraints": ["x = 1"]})
    assert [one.name for one in problem.relations] == ["c1"]
