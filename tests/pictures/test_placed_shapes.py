"""Shapes that a scene's picture places: where they are, and how they move with the coordinates."""

from __future__ import annotations

import math

import numpy as np
import pytest

import dofkit
from dofkit.expressions.tree import coordinate
from dofkit.pictures.shapes import AT_REST, Displacement, Shape
from dofkit.pictures.stage import stage_of
from dofkit.scene.picture import shape_kinds

COIN = {
    "coordinates": ["x", "y", "theta", "phi"],
    "parameters": {"R": 2},
    "constraints": ["dx = R cos(theta) dphi", "dy = R sin(theta) dphi"],
    "picture": [{"disc": "coin", "at": ["x", "y", "R"], "heading": "theta", "turn": "phi", "radius": "R"}],
}


@pytest.mark.parametrize("kind", shape_kinds())
def test_each_shape_is_drawn_and_described(kind: str) -> None:
    scene = dofkit.loads(
        "coordinates: [x, y, theta, phi, x1, x2]\nparameters: {R: positive, l: positive}\n"
        f"picture:\n- {shape_kinds()[kind].example}\n"
    )
    picture = dofkit.draw(scene)
    assert any(mark.ink for mark in picture.page.marks)
    assert all(np.all(np.isfinite(mark.positions)) for mark in picture.page.marks)
    assert dofkit.animate(scene).clips or kind in ("curve", "surface", "plane", "axes", "text")


def test_the_point_of_contact_of_a_rolling_disc_is_at_rest() -> None:
    """The material point that is at the bottom moves in second order: the turn is that of rolling."""
    report = dofkit.classify(COIN)
    arrangement = stage_of(dofkit.load(COIN), report).arrangement
    theta, phi, step = 0.7, 0.4, 1e-5

    def pose(far: float) -> Displacement:
        ahead = {"x": 2 * far * math.cos(theta), "y": 2 * far * math.sin(theta), "theta": theta, "phi": phi + far}
        numbers = arrangement.numbers | {coordinate(n): v for n, v in ahead.items()}
        return arrangement.poses_at(numbers, gibbs=True)["shape 0.0"]

    here, ahead = pose(0.0), pose(step)
    bottom = here.back((0.0, 0.0, 0.0))
    assert np.linalg.norm(ahead.moved(bottom)) < 3 * step**2
    top = here.back((0.0, 0.0, 4.0))
    way = ahead.moved(top) - (0, 0, 4)
    assert way[:2] @ (math.cos(theta), math.sin(theta)) == pytest.approx(4 * step, rel=1e-3)


def test_a_picture_takes_the_place_of_what_it_names() -> None:
    scene = {
        "dimension": 2,
        "particles": ["A"],
        "constraints": [{"name": "rail", "type": "equation", "text": "y_A = 0"}],
        "picture": [{"point": "rail", "show": False}, {"box": "A", "at": ["x_A", 0], "size": 1}],
    }
    sketch = dofkit.draw(scene).sketch
    assert not [s for s in sketch.shapes if s.owner == "rail"]
    assert [s.kind for s in sketch.shapes if s.owner == "A"] == ["area", "words"]


def test_a_straight_curve_is_a_line_and_a_curve_is_named_at_its_middle() -> None:
    curves = [
        {"curve": "line", "at": ["x + u", "u theta"], "range": {"u": [0, 1]}},
        {"curve": "arc", "at": ["cos(u)", "sin(u)"], "range": {"u": [0, "pi/2"]}},
    ]
    sketch = dofkit.draw({**COIN, "picture": curves}).sketch
    lengths = {s.owner: len(s.vertices) for s in sketch.shapes if s.kind == "curve"}
    assert lengths["line"] == 2 < lengths["arc"]
    (name,) = (s for s in sketch.shapes if s.text == "arc")
    assert [sketch.at(v) for v in name.vertices] == [pytest.approx([0.5**0.5, 0.5**0.5, 0])]


def test_what_does_not_move_is_fixed_in_the_world() -> None:
    sketch = dofkit.draw({**COIN, "picture": [*COIN["picture"], {"plane": "", "at": [0, 0, 0]}]}).sketch

    def still(shape: Shape) -> bool:
        return all(sketch.poses.get(v.carrier, AT_REST) is AT_REST for v in shape.vertices)

    assert [still(s) for s in sketch.shapes if s.role in ("body", "plane")] == [False, True]
