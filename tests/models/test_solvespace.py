"""SolveSpace's sketches as scenes: names, every kind of constraint, and 200 random ones against the numeric rank."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from models.sketches import RandomSketch, distance, random_sketch

import dofkit
from dofkit.base.errors import SceneError
from dofkit.models.sketch_relations import KINDS


def load(text: str) -> dofkit.Scene:
    return dofkit.loads(text.encode("latin-1"), "sketch")


def equal(*pairs: tuple[int, int]) -> Callable[[Any], list[Any]]:
    """The relations q_a - q_b of pairs of coordinates."""
    return lambda q: [q[a] - q[b] for a, b in pairs]


def square() -> RandomSketch:
    """Four lines about a square of side 2, end to end."""
    sketch = RandomSketch()
    corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
    for k in range(4):
        sketch.line(corners[k], corners[(k + 1) % 4])
    for k in range(4):
        (h, a), (i, b) = sketch.points[2 * k + 1], sketch.points[(2 * k + 2) % 8]
        sketch.add(20, equal((a, b), (a + 1, b + 1)), ptA=h, ptB=i)
    return sketch


def test_names_are_those_that_solvespace_shows() -> None:
    scene = load(square().text())
    assert [p.name for p in scene.particles][:3] == ["r004_start", "r004_end", "r005_start"]
    assert scene.constraints[0].name == "c001-points-coincident"
    assert scene.particles[1].at == (2, 0)


def test_a_square_has_as_much_freedom_as_its_corners() -> None:
    """16 coordinates less 4 times 2 are 8; level and upright edges leave the place and two sides."""
    sketch = square()
    assert dofkit.classify(load(sketch.text())).dof == 8
    for k, (base, a, b) in enumerate(sketch.lines):
        way = 1 if k % 2 == 0 else 0
        sketch.add((81, 80)[way], equal((a + way, b + way)), entityA=base)
    assert dofkit.classify(load(sketch.text())).dof == 4
    sketch.add(121, lambda q: [0j], entityA=sketch.lines[0][0], entityB=sketch.lines[2][0])
    report = dofkit.classify(load(sketch.text()))
    assert report.dof == 4
    assert report.redundant == ["c009-parallel"]


def test_a_reference_dimension_only_measures() -> None:
    sketch = square()
    distance(sketch, random.Random(0))
    text = sketch.text().replace("AddConstraint\n", "AddConstraint", 4)
    last = text.rindex("AddConstraint")
    scene = load(f"{text[:last]}Constraint.reference=1\n{text[last:]}")
    assert len(scene.constraints) == 4
    assert any("reference dimension" in told for told in scene.left_out)


def test_a_constraint_that_is_not_read_is_a_warning() -> None:
    sketch = square()
    sketch.add(110, lambda q: [0j])
    report = dofkit.classify(load(sketch.text()))
    assert any("less freedom: constraint c005: of kind same-orientation" in told for told in report.warnings)


def in_space(sketch: RandomSketch) -> None:
    """A point of a sketch in space, whose group stands last."""
    sketch.record("Group", h_v="00000009", type="5000", name="sketch-in-3d")
    sketch.record("Request", h_v="00000777", type="100", group_v="00000009")
    sketch.record("Entity", h_v="07770000", type="2000", actPoint_z="3.0")


def test_sketches_in_space_are_told_by_name() -> None:
    sketch = square()
    in_space(sketch)
    told = load(sketch.text()).left_out
    assert any(one.startswith("1 points outside the plane") for one in told)
    assert any(one.startswith("sketch-in-3d: sketches in space") for one in told)


def test_a_file_with_nothing_but_a_sketch_in_space_says_so_in_its_line() -> None:
    sketch = RandomSketch()
    in_space(sketch)
    with pytest.raises(SceneError, match="sketch-in-3d is drawn in space") as raised:
        load(sketch.text())
    assert raised.value.faults[0].line == 1 + sketch.text().split("\n").index("Group.h.v=00000009")


START = "\xb1\xb2\xb3SolveSpaceREVa\n"
POINT = "Entity.h.v=00010001\nEntity.type={}\nAddEntity\n"
FAULTS = {
    "no entity": START,
    "no point of this file is drawn in a workplane": START + POINT.format(2000),
    "line 2, column 1: Entity.type is 'no'": START + POINT.format("no"),
}


@pytest.mark.parametrize("message", FAULTS)
def test_faults(message: str, tmp_path: Path) -> None:
    place = tmp_path / "it.slvs"
    place.write_bytes(FAULTS[message].encode("latin-1"))
    with pytest.raises(SceneError) as raised:
        dofkit.load(place)
    assert message in str(raised.value)


def test_every_kind_that_is_read_has_a_random_sketch() -> None:
    """But two, whose equations are those of distances and angles."""
    met = {line.rpartition("=")[2] for seed in range(200) for line in random_sketch(seed).text().split("\n")
           if line.startswith("Constraint.type")}  # fmt: skip
    assert {str(k) for k, kind in KINDS.items() if kind.says is not None} - met == {"52", "53", "54"}


def compared(seed: int) -> str:
    """How a random sketch compares: right, open, or what is wrong."""
    sketch = random_sketch(seed)
    j = sketch.jacobian()
    rank = int(np.linalg.matrix_rank(j, tol=1e-7)) if j.size else 0
    report = dofkit.classify(load(sketch.text()))
    if report.instantaneous_dof is None:
        return "open"
    if report.instantaneous_dof != len(sketch.drawn) - rank:
        return f"{seed}: {report.instantaneous_dof} for {len(sketch.drawn) - rank}"
    if report.singular is False:
        nullity = sum(group.nullity for group in report.redundancies)
        if nullity != len(j) - rank or report.dof != len(sketch.drawn) - rank:
            return f"{seed}: dof {report.dof}, nullity {nullity} for {len(j) - rank}"
    return "right"


@pytest.mark.parametrize("seed", range(6))
def test_random_sketches_have_the_freedom_of_their_rank(seed: int) -> None:
    assert compared(seed) == "right"


@pytest.mark.sweep
def test_200_random_sketches_have_the_freedom_of_their_rank() -> None:
    told = [compared(seed) for seed in range(200)]
    wrong = [one for one in told if one not in ("right", "open")]
    assert not wrong
    assert told.count("open") <= math.floor(0.02 * len(told))
