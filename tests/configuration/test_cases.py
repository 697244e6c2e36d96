"""What is found of a case is a part of the set."""

from __future__ import annotations

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
