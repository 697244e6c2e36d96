"""The directions that forms allow, against brackets worked out by hand."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from shared.documented import written_to

import dofkit
from dofkit.pictures.arrangement import arrangement_of
from dofkit.pictures.directions import Distribution, NoFormsError, directions_of
from dofkit.pictures.files import DrawnSketch
from dofkit.scene.lowering import lower

HEISENBERG: dict[str, Any] = {"coordinates": ["x", "y", "z"], "constraints": ["dz = x dy - y dx"]}
SKATE: dict[str, Any] = {"coordinates": ["x", "y", "theta"], "constraints": ["sin(theta) dx - cos(theta) dy = 0"]}
MARTINET: dict[str, Any] = {
    "coordinates": ["x", "y", "z"],
    "constraints": ["dz = y^2 dx"],
    "configuration": {"x": 0, "y": 0, "z": 0},
}


def distribution(scene: Any) -> Distribution:
    return Distribution(arrangement_of(lower(dofkit.load(scene))))


def growth(scene: Any) -> list[int]:
    orders = [d.order for d in directions_of(distribution(scene))]
    return [sum(o <= k for o in orders) for k in range(1, max(orders) + 1)]


def test_the_fields_satisfy_the_forms() -> None:
    found = distribution(HEISENBERG)
    x, y = found.start[:2]
    for vector in found.at(found.start):
        assert vector[2] == pytest.approx(x * vector[1] - y * vector[0], abs=1e-6)


def test_the_bracket_of_heisenberg_is_twice_the_third_direction() -> None:
    """X1 = d/dx - y d/dz, X2 = d/dy + x d/dz: [X1, X2] = 2 d/dz."""
    found = distribution(HEISENBERG)
    found.pivots = [0, 1]
    bracket = directions_of(found)[-1]
    assert bracket.order == 2
    assert bracket.vector == pytest.approx([0, 0, 2], abs=1e-4)


@pytest.mark.parametrize(
    ("scene", "expected"),
    [
        (HEISENBERG, [2, 3]),
        (SKATE, [2, 3]),
        (MARTINET, [2, 2, 3]),  # at y = 0 the first bracket vanishes: [X2, [X1, X2]] = -2 d/dz
        ("disc-rolling-on-plane", [2, 3, 4]),
        ("x-dy-plus-y-dx", [1]),
        ("rolling-ball-euler-angles", [3, 5]),
    ],
)
def test_brackets_grow_as_worked_out_by_hand(scene: Any, expected: list[int]) -> None:
    assert growth(scene) == expected


def test_the_picture_tells_the_growth_and_what_is_shown() -> None:
    sketch = dofkit.phase("disc-rolling-on-plane").sketch
    assert sketch.axes == ("x", "y", "theta")
    assert sketch.notes[0] == "Growth vector (2, 3, 4); shown: x, y, theta. Not shown: phi."
    assert "Growth vector (2, 3, 4)" in sketch.alternative
    names = {s.text for s in sketch.shapes if s.kind == "words"}
    assert {"X1", "X2", "[X1, X2]"} <= names


@pytest.mark.sweep
@pytest.mark.parametrize("text", ["xdot^2 + ydot^2 = zdot^2", "xdot ydot = 0"])
def test_what_is_not_linear_in_velocities_has_no_directions(text: str) -> None:
    """No field of planes is what a cone of velocities allows, and none of its directions is a motion by itself."""
    scene = {"coordinates": ["x", "y", "z"], "constraints": [text]}
    with pytest.raises(NoFormsError, match="linear in the velocities"):
        dofkit.phase(scene)
    drawn = dofkit.draw(scene).sketch
    assert not [s for s in drawn.shapes if s.role == "field"]
    assert not [s for s in drawn.shapes if s.state == "moving"]
    assert not any("infinitesimal" in clip.name for clip in dofkit.animate(scene).clips)


#: The pictures of the README and the tutorial, which are drawn of the catalog or of the tutorial's scenes.
SHOWN: dict[str, Callable[[Path], DrawnSketch]] = {
    "loop": lambda folder: dofkit.animate("disc-rolling-on-plane", loop=True),
    "four-bar": lambda folder: dofkit.draw("four-bar-linkage"),
    "motion": lambda folder: dofkit.animate("four-bar-linkage"),
    "mended": lambda folder: dofkit.draw(folder / "mended.yaml"),
    "directions": lambda folder: dofkit.phase(folder / "disc.yaml"),
}


@pytest.mark.parametrize("name", SHOWN)
def test_the_pictures_of_the_first_pages_are_of_today(name: str, tmp_path: Path) -> None:
    kept = (Path(dofkit.__file__).parent / "site" / "pages" / f"{name}.svg").read_text(encoding="utf-8")
    drawn = SHOWN[name](written_to(tmp_path)).svg()
    for part in (r"<desc>.*?</desc>", r"<style>.*?</style>", r">[^<>]+</text>"):
        assert re.findall(part, kept) == re.findall(part, drawn)


def test_a_growth_vector_that_is_not_told_is_not_made_up() -> None:
    report = dofkit.classify(HEISENBERG).model_copy(update={"growth_vector": None})
    sketch = dofkit.phase(HEISENBERG, report).sketch
    assert (
        sketch.notes[0]
        == "The growth vector is undecided; in floating point it is (2, 3) at this point; shown: x, y, z."
    )
    assert sketch.notes[0] in sketch.alternative


def test_finite_constraints_have_no_such_picture() -> None:
    with pytest.raises(NoFormsError, match="needs differential constraints"):
        dofkit.phase("four-bar-linkage")
