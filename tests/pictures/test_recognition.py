"""Discs and knife edges, recognised by their forms."""

from __future__ import annotations

import pytest

import dofkit
from dofkit.expressions.text import to_text
from dofkit.pictures.stage import stage_of

ROLLS = ["dy = R cos(theta) dphi", "dx = -R sin(theta) dphi"]


@pytest.mark.parametrize(
    ("coordinates", "constraints", "kinds", "heading"),
    [
        ("x y theta phi", ROLLS, ["plane", "disc", "point"], "theta + pi/2"),
        ("x y phi a", ["xdot = 2 cos(a) phidot", "ydot = 2 sin(a) phidot"], ["plane", "disc", "point"], "a"),
        ("x y s", ["sin(s) dx - cos(s) dy = 0"], ["blade"], "s"),
        ("x y s", ["cos(s) dx - sin(s) dy = 0"], ["blade"], "-s + pi/2"),
        ("x y z", ["dz = x dy"], [], ""),
        ("x y theta", ["dx = 0"], [], ""),
        ("u v theta", ["sin(theta) du - cos(theta) dv = 0"], [], ""),
    ],
)
def test_a_rolling_disc_and_a_knife_edge_are_drawn(
    coordinates: str, constraints: list[str], kinds: list[str], heading: str
) -> None:
    scene = dofkit.load(
        {"coordinates": coordinates.split(), "parameters": {"R": "positive"}, "constraints": constraints}
    )
    shapes = stage_of(scene, dofkit.classify(scene)).picture.shapes
    assert [shape.kind for shape in shapes] == kinds
    angles = [shape.heading for shape in shapes if shape.heading is not None]
    assert [to_text(angle) for angle in angles] == ([heading] if heading else [])
