"""SolveSpace's sketches in space as scenes, and 200 random ones against the numeric rank of SolveSpace's equations."""

from __future__ import annotations

import math

import numpy as np
import pytest
from models.sketches import RandomSketch, random_sketch
from models.spatial_sketches import ON_LINES, TURNS, Plane, Point, RandomSpace, random_space

import dofkit
from dofkit.models.model_document import ModelFile, SceneDraft
from dofkit.models.sketch_file import read_sketch
from dofkit.models.sketch_space_relations import SPACE_KINDS
from dofkit.models.spatial_sketch import SpatialSketch

#: Kinds that random sketches in a plane have, read as in space; cubics have a test of their own.
FLAT = {"52", "53", "61", "62", "63", "123", "124", "125", "130"}
SEEDS = (1, 2)


def load(sketch: RandomSpace) -> dofkit.Scene:
    return dofkit.loads(sketch.text().encode("latin-1"), "sketch")


def origin() -> Point:
    return Point(0x10001, lambda q: np.zeros(3))


def ground(sketch: RandomSpace) -> Plane:
    """A workplane of its own at the origin."""
    sketch.group = 2
    return sketch.group_plane(2, origin(), {"subtype": "6000"}, None, TURNS[0])


def test_three_legs_of_given_length_hold_a_point() -> None:
    """9 coordinates of feet that stay and 3 of the top, less 9 and 3 lengths."""
    s = RandomSpace()
    feet = [(2.0, 0.0, 0.0), (-2.0, 1.0, 0.0), (0.0, -2.0, 0.0)]
    top = s.point(s.request(101), (0.0, 0.0, 2.0))
    for foot in feet:
        place = s.point(s.request(101), foot)
        s.add(200, lambda q: [0j], ptA=place.handle)
        s.add(30, lambda q: [0j], math.dist(foot, (0, 0, 2)), ptA=top.handle, ptB=place.handle)
    scene = load(s)
    assert scene.dimension == 3
    report = dofkit.classify(scene)
    assert (report.dof, report.redundant) == (0, [])
    assert scene.particles[0].name == "r004"


def test_a_line_is_tangent_to_a_cubic_in_space() -> None:
    """Four points (12) and a line (6) that begins where the cubic does (3) and goes on along it (2)."""
    s = RandomSpace()
    base = s.request(300)
    ends = [s.point(base + k, at) for k, at in enumerate([(0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (2.0, 0.0, 1.0),
                                                         (3.0, 0.0, 0.0)], 1)]  # fmt: skip
    s.entity(base, 12000, **{f"point_{k}": end.handle for k, end in enumerate(ends)})
    s.drawn_line((0.0, 0.0, 0.0), (-2.0, -2.0, -2.0))
    line = s.segments[0]
    s.add(20, lambda q: [0j], ptA=ends[0].handle, ptB=line.ends[0].handle)
    s.add(124, lambda q: [0j], entityA=base, entityB=line.handle)
    report = dofkit.classify(load(s))
    assert (report.dof, report.redundant) == (13, [])


def test_a_sketch_on_a_face_moves_with_what_was_extruded() -> None:
    """Two lines in a plane and one on the face above (12), a depth; less the depth, a level line and a place (2)."""
    s = RandomSpace()
    plane = ground(s)
    s.drawn_line((0.0, 0.0), (2.0, 0.0), plane)
    s.drawn_line((0.0, 0.0), (0.0, 1.0), plane)
    s.extruded(plane, 3.0, False)
    one, other = [line for line in s.segments if line.handle & 0x80000000][2:]
    how = {"subtype": "6001", "predef_entityB_v": f"{one.handle:08x}", "predef_entityC_v": f"{other.handle:08x}"}
    face = s.group_plane(ON_LINES, one.ends[0], how, tuple(plane.axes), TURNS[0])
    s.group = ON_LINES
    s.drawn_line((0.0, 1.0), (1.0, 1.0), face)
    drawn, below = s.segments[-1], s.segments[0]
    s.add(30, lambda q: [0j], 3.0, ptA=below.ends[0].handle, ptB=one.ends[0].handle)
    s.add(80, lambda q: [0j], entityA=drawn.handle, workplane=face.handle)
    s.add(20, lambda q: [0j], ptA=drawn.ends[0].handle, ptB=other.ends[1].handle, workplane=face.handle)
    scene = load(s)
    assert not [told for told in scene.left_out if told.startswith("constraint")]
    report = dofkit.classify(scene)
    assert (report.instantaneous_dof, report.redundant) == (9, [])


def test_a_workplane_of_its_own_turns() -> None:
    """A place (3), a turn (3) and a line in the plane (4); less the place, and one of the line's directions."""
    s = RandomSpace()
    plane = s.free_plane((1.0, 0.0, 0.0), TURNS[2])
    s.drawn_line((0.0, 0.0), (1.0, 2.0), plane)
    s.drawn_line((0.0, 0.0), (3.0, 0.0), plane)
    s.add(200, lambda q: [0j], ptA=s.places[0].handle)
    s.add(80, lambda q: [0j], entityA=s.segments[1].handle, workplane=plane.handle)
    report = dofkit.classify(load(s))
    assert report.dof == 3 + 3 + 8 - 3 - 1


def test_what_is_made_by_turning_is_not_read_and_says_so() -> None:
    s = RandomSpace()
    plane = ground(s)
    s.drawn_line((0.0, 0.0), (2.0, 0.0), plane)
    s.extruded(plane, 3.0, False)
    s.add(30, lambda q: [0j], 3.0, ptA=s.places[0].handle, ptB=s.places[4].handle)
    text = s.text().replace("Group.type=5100", "Group.type=5200")
    scene = dofkit.loads(text.encode("latin-1"), "sketch")
    assert any("the true freedom may be smaller: constraint c001" in told for told in dofkit.classify(scene).warnings)
    assert "extrude: groups that are derived from sketches" in scene.left_out


def test_workplanes_that_rest_on_each_other_are_not_read() -> None:
    """Each of two origins lies in the workplane of the other one."""
    s = RandomSpace()
    for k in (8, 9):
        base = k << 16
        s.record("Request", h_v=f"{k:08x}", type="100", group_v="00000003")
        s.entity(base, 10000, point_0=base + 1, normal_v=base + 32)
        s.entity(base + 1, 2001, workplane_v=(17 - k) << 16)
        s.entity(base + 32, 3000, {"actNormal_w": 1.0}, point_0=base + 1)
    s.point(s.request(101), (1.0, 2.0, 3.0))
    scene = load(s)
    assert [p.name for p in scene.particles if p.name[-2] != "_"] == ["r004"]


def test_an_equation_that_is_too_long_is_told_and_no_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("dofkit.models.sketch_scene.MAX_CHARACTERS", 30)
    s = RandomSpace()
    s.drawn_line((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    s.drawn_line((1.0, 0.0, 0.0), (3.0, 2.0, 1.0))
    s.add(50, lambda q: [0j], entityA=s.segments[0].handle, entityB=s.segments[1].handle)
    told = dofkit.classify(load(s)).warnings
    assert any("constraint c001-eq-length: its equation is longer than a text of a scene" in one for one in told)


def compared(sketch: RandomSketch, scene: dofkit.Scene) -> str:
    """How a random sketch compares: right, open, or what is wrong."""
    j = sketch.jacobian()
    rank = int(np.linalg.matrix_rank(j, tol=1e-7)) if j.size else 0
    right = len(sketch.drawn) - rank
    unread = [told for told in scene.left_out if told.startswith("constraint")]
    report = dofkit.classify(scene)
    if unread or report.instantaneous_dof not in (None, right):
        return f"{report.instantaneous_dof} for {right}, {unread}"
    if report.instantaneous_dof is None:
        return "open"
    if report.singular is False and report.redundant is not None:
        nullity = sum(group.nullity for group in report.redundancies)
        if nullity != len(j) - rank or report.dof != right:
            return f"dof {report.dof} for {right}, nullity {nullity} for {len(j) - rank}"
    return "right"


@pytest.mark.parametrize("seed", SEEDS)
def test_random_sketches_in_space_have_the_freedom_of_their_rank(seed: int) -> None:
    sketch = random_space(seed)
    assert compared(sketch, load(sketch)) == "right"


@pytest.mark.sweep
def test_200_random_sketches_in_space_have_the_freedom_of_their_rank() -> None:
    sketches = [random_space(seed) for seed in range(200)]
    told = [compared(one, load(one)) for one in sketches]
    assert not [f"{seed}: {one}" for seed, one in enumerate(told) if one not in ("right", "open")]
    assert told.count("open") <= math.floor(0.02 * len(told))


def as_in_space(seed: int) -> str:
    """How a random sketch in a plane compares that is read as one in space."""
    sketch = random_sketch(seed)
    file = read_sketch(ModelFile(sketch.text().encode("latin-1"), "sketch"))
    document = SpatialSketch(file, SceneDraft("sketch")).document()
    return compared(sketch, dofkit.load(document.value))


def test_a_sketch_in_a_plane_is_the_same_in_space() -> None:
    assert as_in_space(8) == "right"


@pytest.mark.sweep
def test_100_sketches_in_a_plane_are_the_same_in_space() -> None:
    told = [as_in_space(seed) for seed in range(100)]
    assert not [f"{seed}: {one}" for seed, one in enumerate(told) if one not in ("right", "open")]
    assert told.count("open") <= math.floor(0.02 * len(told))


@pytest.mark.sweep
def test_every_kind_that_is_read_in_space_has_a_random_sketch() -> None:
    met = {line.rpartition("=")[2] for seed in range(200) for line in random_space(seed).text().split("\n")
           if line.startswith("Constraint.type")}  # fmt: skip
    assert {str(k) for k in SPACE_KINDS} - met <= FLAT
