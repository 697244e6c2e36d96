"""SolveSpace's sketches as scenes: names, every kind of constraint, and 200 random ones against the numeric rank."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from models.sketches import PLANE, RandomSketch, distance, random_sketch

import dofkit
from dofkit.base.errors import SceneError
from dofkit.models.sketch_constraints import KINDS


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


@pytest.mark.parametrize(("flag", "dof"), [("allDimsReference", 7), ("relaxConstraints", 8), ("allowRedundant", 6)])
def test_a_group_may_make_its_dimensions_measure_or_be_relaxed(flag: str, dof: int) -> None:
    """Of a square's 8 a length and a level edge leave 6: what measures leaves the edge, what is relaxed nothing."""
    sketch = square()
    (h, _), (i, _) = sketch.points[:2]
    sketch.add(30, lambda q: [0j], 2.0, ptA=h, ptB=i, group=2)
    sketch.add(81, lambda q: [0j], entityA=sketch.lines[1][0], group=2)
    text = sketch.text().replace("Group.name=sketch-in-plane", f"Group.name=sketch-in-plane\nGroup.{flag}=1")
    assert dofkit.classify(load(text)).dof == dof


def test_a_constraint_that_is_not_read_is_a_warning() -> None:
    sketch = square()
    sketch.add(110, lambda q: [0j])
    report = dofkit.classify(load(sketch.text()))
    assert any("the true freedom may be smaller: constraint c005-same-orientation" in told for told in report.warnings)


def test_of_texts_and_cubics_only_the_points_are_read() -> None:
    """Four corners have 8 coordinates; the report says that a text keeps its shape, so that its freedom is 4."""
    sketch = RandomSketch()
    base = sketch.request(600)
    for k, corner in enumerate([(-5.0, 5.0), (-5.0, -5.0), (23.9, -5.0), (23.9, 5.0)], 1):
        sketch.point(base + k, *corner)
    corners = {f"point_{k}": f"{base + 1 + k:08x}" for k in range(4)}
    sketch.record("Entity", h_v=f"{base:08x}", type="15000", workplane_v=f"{PLANE:08x}", **corners)
    sketch.record("Entity", h_v=f"{base + 9:08x}", type="12000", **corners)
    sketch.line((0.0, 0.0), (1.0, 1.0))
    sketch.add(124, lambda q: [0j], entityA=base + 9, entityB=sketch.lines[0][0])
    report = dofkit.classify(load(sketch.text()))
    assert report.dof == 8 + 4
    told = [warning for warning in report.warnings if "the true freedom may be smaller" in warning]
    assert any("texts and images" in warning for warning in told)
    assert any("cubic-line-tangent" in warning for warning in told)
    assert "cubic curves: only their points are read" in report.modelled


def test_a_circle_has_no_end_to_be_tangent_at() -> None:
    sketch = square()
    sketch.circle((0.0, 0.0), 1.0)
    sketch.add(123, lambda q: [0j], entityA=sketch.circles[0][0], entityB=sketch.lines[0][0])
    told = dofkit.classify(load(sketch.text())).warnings
    assert any(
        "constraint c005-arc-line-tangent: the entities that it refers to have no such ends" in one for one in told
    )


def test_an_arc_that_is_a_whole_circle_is_reported_once() -> None:
    """Its ends in one place are as far from the centre: 6 coordinates less 2."""
    sketch = RandomSketch()
    sketch.arc((0.0, 0.0), 1.0, (0.0, math.tau))
    (h, a), (i, b) = sketch.points[1:]
    sketch.add(20, equal((a, b), (a + 1, b + 1)), ptA=h, ptB=i)
    report = dofkit.classify(load(sketch.text()))
    assert (report.dof, report.redundant) == (4, [])


def test_what_belongs_to_another_workplane_or_to_space_is_left_out_with_a_warning() -> None:
    """A constraint in the plane y, z and a free point of space: the square keeps its 8, and the report says so."""
    sketch = square()
    (h, a), (i, b) = sketch.points[0], sketch.points[2]
    sketch.record("Entity", h_v="00030000", type="10000", point_0="00010001", normal_v="00030020")
    half = {f"actNormal_{k}": "0.5" for k in ("w", "vx", "vy", "vz")}
    sketch.record("Entity", h_v="00030020", type="3000", **half)
    sketch.record("Request", h_v="00000003", type="100", group_v="00000001")
    sketch.record("Entity", h_v="00090001", type="2000")
    sketch.add(20, equal((a + 1, b + 1)), ptA=h, ptB=i, workplane=0x30000)
    report = dofkit.classify(load(sketch.text()))
    assert report.dof == 8
    assert any("c005-points-coincident: it belongs to a workplane other than" in told for told in report.warnings)
    assert "1 point outside the plane of most points" in report.modelled


START = "\xb1\xb2\xb3SolveSpaceREVa\n"
POINT = "Entity.h.v=00010001\nEntity.type={}\nAddEntity\n"
FAULTS = {
    "no entity": START,
    "no point that dofkit reads": START + POINT.format(2001),
    "sketches in space are not read": START + POINT.format(2000),
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
    """But those whose equations are those of distances and angles."""
    met = {line.rpartition("=")[2] for seed in range(200) for line in random_sketch(seed).text().split("\n")
           if line.startswith("Constraint.type")}  # fmt: skip
    assert {str(k) for k in KINDS} - met == {"52", "53", "54"}


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
