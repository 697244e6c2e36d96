"""What is found of a case is a part of the set; constants are generic."""

from __future__ import annotations

import pytest

import dofkit


def test_a_case_is_a_part_of_the_set_and_says_nothing_of_what_passes_through_its_point() -> None:
    """x = 5, e = 0 and y = 0 leave u, v, w free. The case w = -26 of y (w + y^2 + 26) = 0 is a part of that."""
    scene = {
        "coordinates": ["x", "e", "y", "u1", "v1", "w1"],
        "constraints": [
            "y*(y^2 + x^2 + 1) = e",
            "(sqrt(1 + (x - 5)) - 1)*v1 = y*w1 + e",
            "(x - 5)^4 + e^6 + (e - x + 5)^2 = 0",
            "(sqrt(1 + (x - 5)) - 1)*u1 = y*v1",
        ],
    }
    report = dofkit.classify(scene)
    assert report.dof in (None, 3)


@pytest.mark.parametrize(
    ("upper", "lower", "verdict"),
    [("a", "b", "proved"), ("sin(a)", "cos(a) + t", "proved"), ("exp(a)", "b", "probable")],
)
def test_lengths_are_constants_whatever_their_values(upper: str, lower: str, verdict: str) -> None:
    """On a circle and on another about it: 4 - 2. A random number stands for the exponential, for sines unknowns do."""
    texts = [f"x^2 + y^2 = ({upper})^2", f"(x - z)^2 + (y - w)^2 = ({lower})^2"]
    scene = {"coordinates": list("xyzw"), "parameters": {"a": "positive", "b": "positive"}, "constraints": texts}
    report = dofkit.classify(scene)
    assert (report.dof, report.verdicts["dof"].verdict, report.redundant) == (2, verdict, [])
