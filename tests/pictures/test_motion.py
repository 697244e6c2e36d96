"""Moving pictures: what the frames hold, which motions are shown, and what their files say."""

from __future__ import annotations

import json
import re
import shutil
from itertools import combinations, pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared.residuals import residual

import dofkit
from dofkit.base.errors import ArgumentError
from dofkit.expressions.tree import coordinate
from dofkit.pictures import motion_clips
from dofkit.pictures.animation import STILL, Animation
from dofkit.pictures.files import ExtraMissingError
from dofkit.pictures.motion_clips import GOES_ON
from dofkit.scene.lowering import lower
from dofkit.system import GROUND

#: Of the truss with corners (0, 0), (4, 0), (1, 3): AB, AC, BC.
LENGTHS = [4, 10**0.5, 18**0.5]


def test_a_four_bar_turns_around_in_one_line() -> None:
    (clip,) = dofkit.animate("four-bar-linkage").clips
    assert clip.closed
    assert len(clip.frames) > 60
    pins = np.array([f["crank"].moved((0, 2, 0)) for f in clip.frames])
    assert np.linalg.norm(pins, axis=1) == pytest.approx(2)  # the crank is 2 long, about the origin
    angles = np.unwrap(np.arctan2(pins[:, 1], pins[:, 0]))
    assert np.ptp(angles) > 6.0  # and goes all the way around


def test_hinges_hold_in_every_frame() -> None:
    (clip,) = dofkit.animate("slider-crank").clips
    scene = dofkit.load("slider-crank")
    joints = [c.model_dump() for c in scene.constraints if c.kind() == "revolute"]
    assert len(joints) == 3
    for frame in clip.frames:
        for joint in joints:
            at = (*map(float, joint["at"]), 0.0)
            first, second = (frame[body].moved(at) for body in joint["between"])
            assert first == pytest.approx(second, abs=1e-9)


def test_a_guide_is_as_long_as_its_motion() -> None:
    """A crank from (0, 0) to (1, 2), whose piston slides along y = 0, moves it by twice the root of 5."""
    wide = []
    for sketch in (dofkit.draw("slider-crank").sketch, dofkit.animate("slider-crank").sketch):
        rails = [s for s in sketch.shapes if s.owner == "bore" and s.role == "guide"]
        wide.append(np.ptp([v.at[0] for s in rails for v in s.vertices if {w.carrier for w in s.vertices} == {GROUND}]))
    assert wide[1] - wide[0] == pytest.approx(20**0.5, rel=0.02)


def test_bars_keep_their_lengths() -> None:
    clip = dofkit.animate("pinned-truss").clips[0]
    for frame in clip.frames:
        places = [frame[p].shift for p in "ABC"]
        gaps = [float(np.linalg.norm(a - b)) for a, b in combinations(places, 2)]
        assert gaps == pytest.approx(LENGTHS, abs=1e-9)


def test_each_of_several_freedoms_is_shown_by_itself() -> None:
    arm, sun = dofkit.animate("planetary-gear-bodies").clips
    assert (arm.name, sun.name) == ("free velocity 1 of 2: theta_arm", "free velocity 2 of 2: theta_sun")
    values = {name: [q[coordinate(name)] for q in arm.path] for name in ("theta_arm", "theta_sun")}
    assert np.ptp(values["theta_arm"]) > 1
    assert np.ptp(values["theta_sun"]) < 1e-9


def test_both_motions_leave_a_flat_parallelogram() -> None:
    """Crank and rocker 1, coupler and ground 2. If the crank is at a and the rocker at c, both small, the coupler is at
    (c - a)/2, and the second order of the ends' distance gives (c - a)(c + 3a) = 0."""
    places = [[0, 0], [1, 0], [3, 0], [2, 0]]
    members = ["ground", "crank", "coupler", "rocker", "ground"]
    joints = [
        {"type": "revolute", "between": [*pair], "at": p} for pair, p in zip(pairwise(members), places, strict=True)
    ]
    clips = dofkit.animate({"dimension": 2, "bodies": members[1:4], "constraints": joints}).clips
    assert [clip.name for clip in clips] == ["finite motion 1", "finite motion 2"]
    ratios = []
    for clip in clips:
        assert all(clip.text == GOES_ON and abs(b[0] - a[0]) < 1e-3 for a, b in clip.arrows)
        up = {round(float(a[0])): b[1] - a[1] for a, b in clip.arrows}
        ratios.append(up[3] / up[1])
    assert sorted(ratios) == pytest.approx([-3, 1], abs=0.2)


def test_a_switch_leaves_out_a_constraint(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of more constraints than have a switch a redundant one has."""
    door = {"bodies": ["door"], "constraints": [_hinge("lower", 0), _hinge("upper", 2)]}
    moving = dofkit.animate(door)
    assert [(s.name, s.free) for s in moving.switches] == [("lower", False), ("upper", True)]
    assert "as long as upper is in use" in moving.switches[0].text
    assert [clip.name for clip in moving.clips] == ["a finite motion"]
    monkeypatch.setattr(motion_clips, "MOST_SWITCHES", 1)
    assert [s.name for s in dofkit.animate(door).switches] == ["upper"]


def test_without_a_constraint_that_is_needed_the_others_hold() -> None:
    """P hangs on three bars, one of them redundant, and Q on P: without that bar Q is free, and P rests."""
    bars = {"a": [[0, 0], "P"], "b": [[2, 0], "P"], "c": [[1, -1], "P"], "d": ["P", "Q"]}
    scene = {
        "dimension": 2,
        "particles": [{"name": "P", "at": [1, 1]}, {"name": "Q", "at": [2, 2]}],
        "constraints": [{"name": n, "type": "link", "between": ends} for n, ends in bars.items()],
    }
    moving = dofkit.animate(scene)
    assert [(s.name, s.free) for s in moving.switches] == [("a", False), ("b", False), ("c", True), ("d", False)]
    (clip,) = (clip for clip in moving.clips if clip.dropped)
    assert clip.dropped == "d"
    assert all(frame["P"].shift == pytest.approx([1, 1, 0], abs=1e-9) for frame in clip.frames)
    assert np.ptp([float(np.linalg.norm(f["Q"].shift - f["P"].shift)) for f in clip.frames]) > 0.3


def _hinge(name: str, height: float) -> dict[str, Any]:
    return {"name": name, "type": "revolute", "between": ["ground", "door"], "at": [0, 0, height], "axis": [0, 0, 1]}


def test_a_function_in_forces_alone_stops_no_motion() -> None:
    names = [clip.name for clip in dofkit.animate("cart-spring-hinged-rod").clips]
    assert names == ["free velocity 1 of 2: x", "free velocity 2 of 2: theta"]


def test_a_motion_of_first_order_only_is_shown() -> None:
    """A link drawn through the line of its ends: C has an infinitesimal motion across it and no finite one."""
    points = {"A": [0, 0], "B": [2, 0], "C": [1, 0]}
    links = [["A", "C"], ["C", "B"]]
    scene = {
        "dimension": 2,
        "particles": [{"name": n, "at": p} for n, p in points.items()],
        "constraints": [{"type": "fixed", "point": n} for n in "AB"] + [{"type": "link", "between": e} for e in links],
    }
    found = dofkit.animate(scene)
    assert [clip.name for clip in found.clips] == ["infinitesimal motion: y_C"]
    assert "instantaneous freedom 1 at this singular configuration" in found.alternative
    assert "no finite motion is possible" in found.clips[0].text
    heights = [f["C"].shift[1] for f in found.clips[0].frames]
    assert max(heights) > 0.1
    assert min(heights) < -0.1


def test_what_does_not_move_says_so() -> None:
    found = dofkit.animate("crank-held-at-angle")
    assert found.clips == ()
    assert STILL in found.sketch.notes
    assert len(list(found.pages())) == 1


def test_what_is_placed_by_coordinates_moves_with_them() -> None:
    disc = dofkit.animate("disc-rolling-on-plane")
    frames = disc.clips[0].frames
    assert max(abs(frame["shape 1.0"].shift[2] - 1.0) for frame in frames) < 1e-9
    assert max(abs(frame["shape 1.0"].shift[0] - frames[0]["shape 1.0"].shift[0]) for frame in frames) > 0.5


def test_time_goes_on_where_only_the_picture_knows_of_it() -> None:
    place = ["sin(theta) cos(t)", "sin(theta) sin(t)", "-cos(theta)"]
    clips = dofkit.animate({"coordinates": ["theta"], "picture": [{"ball": "m", "at": place, "radius": 1}]}).clips
    assert [clip.name for clip in clips] == ["a finite motion", "time"]
    at = [float(np.linalg.norm(frame["shape 0.0"].shift)) for frame in clips[1].frames]
    assert at == pytest.approx([1.0] * len(at))
    assert len({round(float(frame["shape 0.0"].shift[2]), 9) for frame in clips[1].frames}) == 1


def test_a_graph_does_not_move() -> None:
    free = dofkit.animate({"coordinates": ["a", "b", "c", "d"]})
    assert free.clips == ()
    assert "`picture`" in free.sketch.notes[0]


def _worst(found: Animation, scene: str) -> float:
    """Return the largest residual in finite motions with all constraints."""
    clips = [clip for clip in found.clips if not clip.dropped and not clip.name.startswith("infinitesimal")]
    system = lower(dofkit.load(scene))
    return max((residual(system, clip.path) for clip in clips), default=0.0)


@pytest.mark.parametrize("name", ["slider-crank", "double-pendulum-links"])
def test_constraints_hold_in_every_frame(name: str) -> None:
    assert _worst(dofkit.animate(name), name) < 1e-9


# -- files -----------------------------------------------------------------------------------------


def data_of(found: Animation) -> dict[str, Any]:
    match = re.search(r'<script type="application/json" id="data">(.*?)</script>', found.html(), re.S)
    assert match is not None
    told: dict[str, Any] = json.loads(match[1])
    return told


def test_other_endings_are_told(tmp_path: Path) -> None:
    with pytest.raises(ArgumentError, match=r"the endings are \.svg, \.png, \.pdf, \.html, \.gif, \.mp4$"):
        dofkit.animate("crank-held-at-angle").save(tmp_path / "a.avi")


def test_without_ffmpeg_an_mp4_says_so(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from matplotlib.animation import FFMpegWriter

    monkeypatch.setattr(FFMpegWriter, "isAvailable", classmethod(lambda cls: False))
    with pytest.raises(ExtraMissingError, match="ffmpeg"):
        dofkit.animate("crank-held-at-angle").save(tmp_path / "a.mp4")


@pytest.mark.sweep
def test_a_gif_moves(tmp_path: Path) -> None:
    from PIL import Image

    with Image.open(dofkit.animate("pendulum-in-plane").save(tmp_path / "a.gif")) as image:
        assert getattr(image, "n_frames", 1) > 60


@pytest.mark.sweep
@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="needs ffmpeg")
def test_an_mp4_is_written(tmp_path: Path) -> None:
    path = dofkit.animate("pendulum-in-plane").save(tmp_path / "a.mp4")
    assert b"ftyp" in path.read_bytes()[:16]


@pytest.mark.sweep
@pytest.mark.parametrize("name", dofkit.catalog_names())
def test_the_whole_catalog_is_animated(name: str) -> None:
    found = dofkit.animate(name)
    report = dofkit.classify(name)
    moves = bool(report.velocity_dof) or report.scleronomic is False
    is_graph = any(shape.role == "node" for shape in found.sketch.shapes)
    assert bool(found.clips) == (moves and not is_graph)
    assert _worst(found, name) < 1e-9
    data_of(found)
    assert len(found.html()) < 60_000
