"""Motions of measured drawings that lead to where a relation has no value."""

from __future__ import annotations

import dofkit

PLACES = {"A": (0, 0, 0), "B": (2, 0, 1), "C": (-1, 0, 0), "D": (1, 0, -2), "E": (-2, 0, 1), "F": (0, 0, 1)}


def _length(a: str, b: str) -> str:
    return "sqrt(" + " + ".join(f"({c}_{a} - {c}_{b})^2" for c in "xyz") + ")"


def _dot(a: str, b: str, c: str, d: str) -> str:
    return "(" + " + ".join(f"({k}_{a} - {k}_{b})*({k}_{c} - {k}_{d})" for k in "xyz") + ")"


def test_a_motion_ends_where_a_line_has_no_length() -> None:
    """Six points of the plane y = 0, 12 freedoms: the directions of A B and C D, told thrice, one distance and one
    projection leave 8. Along a motion E F shrinks to nothing, where its direction has no value.
    """
    texts = (
        "((x_C - x_D)*(z_A - z_B) - (z_C - z_D)*(x_A - x_B))*cos(pi*71.565051177078/180)"
        " = ((x_C - x_D)*(x_A - x_B) + (z_C - z_D)*(z_A - z_B))*sin(pi*71.565051177078/180)",
        f"z_C - z_D = {_length('C', 'D')}*cos(pi*45/180)",
        "(x_A - x_B)*(z_D - z_B) - (z_A - z_B)*(x_D - x_B) = 894427191*sqrt((x_A - x_B)^2 + (z_A - z_B)^2)/400000000",
        f"x_A - x_B = {_length('A', 'B')}*cos(pi*153.434948822922/180)",
        f"{_dot('D', 'F', 'E', 'F')} = -{_length('E', 'F')}",
    )
    plane = {"type": "on", "members": [*PLACES], "surface": "-y = 0"}
    equations = [{"type": "equation", "text": text} for text in texts]
    particles = [{"name": name, "at": list(at)} for name, at in PLACES.items()]
    value = {"dimension": 3, "particles": particles, "constraints": [plane, *equations], "tolerance": 2.5e-07}
    report = dofkit.classify(dofkit.load(value))
    assert (report.instantaneous_dof, report.dof, report.redundant) == (8, 8, ["c5"])
