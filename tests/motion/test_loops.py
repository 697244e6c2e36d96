"""Closed loops: the displacement is that of the bracket up to third order, and what integrates returns."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import pytest
from shared.residuals import residual

import dofkit
from dofkit.expressions.tree import TIME, Expr, coordinate, parameter
from dofkit.motion.configurations import NoMotionError
from dofkit.motion.loops import Loop, LoopSampler, fields_of_pivots
from dofkit.scene.lowering import lower

SKATE = {"coordinates": ["x", "y", "theta"], "constraints": ["sin(theta) dx - cos(theta) dy = 0"]}
TRAILER = {
    "coordinates": ["x", "y", "theta", "psi"],
    "constraints": ["sin(theta) dx - cos(theta) dy = 0", "dpsi = sin(theta - psi) (cos(theta) dx + sin(theta) dy)"],
}
NAMES = dofkit.catalog_names()


def _sampler(scene: Any, numbers: Mapping[str, float] | None = None) -> LoopSampler:
    system = lower(dofkit.load(scene))
    return LoopSampler(system, dict.fromkeys(system.parameters, 1.0) | dict(numbers or {}))


def _gap(loop: Loop) -> float:
    return max(abs(loop.displacement[n] - loop.prediction[n]) for n in loop.displacement)


def test_the_contact_form_shows_the_area_of_the_loop() -> None:
    """For dz = x dy the bracket [d/dx, d/dy + x d/dz] is d/dz, so z grows by the area, here of a polygon."""
    (loop,) = _sampler({"coordinates": ["x", "y", "z"], "constraints": ["dz = x dy"]}).loops(0.5)
    corners = np.array([[q["x"], q["y"]] for q in loop.configurations])
    x, y = corners.T
    area = float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) / 2)
    assert area == pytest.approx(math.pi / 4, rel=2e-3)
    assert loop.displacement["z"] == pytest.approx(area, rel=1e-9)
    assert loop.prediction["z"] == pytest.approx(area, rel=1e-6)


def test_a_rolling_disc_is_displaced_across_its_heading() -> None:
    """[X_theta, X_phi] of dx = -R sin(theta) dphi, dy = R cos(theta) dphi is R (-cos(theta), -sin(theta))."""
    (loop,) = _sampler("disc-rolling-on-plane", {"theta": 0.3}).loops(0.1)
    theta = loop.configurations[0]["theta"]
    area = 36 * math.sin(2 * math.pi / 72) * 0.01
    assert loop.prediction == pytest.approx({"x": -area * math.cos(theta), "y": -area * math.sin(theta)}, rel=1e-5)
    assert loop.configurations[-1]["theta"] == pytest.approx(theta, abs=1e-10)


@pytest.mark.parametrize(
    "scene", [SKATE, TRAILER, "disc-rolling-on-plane", "rolling-ball", "rolling-ball-euler-angles"]
)
def test_the_difference_to_the_bracket_falls_with_the_third_power_of_the_size(scene: Any) -> None:
    sampler = _sampler(scene)
    for large, small in zip(sampler.loops(0.05), sampler.loops(0.025), strict=True):
        assert max(map(abs, large.prediction.values())) > 1e-3
        assert _gap(small) < max(_gap(large) / 7, 1e-8)


@pytest.mark.parametrize("scene", ["planetary-gear-bodies", "disc-string-no-slip-equation"])
def test_what_integrates_returns(scene: str) -> None:
    loops = _sampler(scene).loops(0.2)
    assert max(abs(v) for loop in loops for v in loop.displacement.values()) < 1e-9


def test_one_free_velocity_has_no_loop() -> None:
    with pytest.raises(NoMotionError, match="two free velocities"):
        _sampler("velocities-that-integrate")


def test_no_loop_where_time_occurs() -> None:
    with pytest.raises(NoMotionError, match="without time"):
        _sampler({"coordinates": ["x", "y", "z"], "constraints": ["dz = x dy + t dt"]})


def test_a_loop_that_leaves_the_set_stops_with_a_reason() -> None:
    """On x^2 + y^2 = 1/4 the free coordinate reaches 1/2 at most, less than the radius of the larger loop."""
    scene = {
        "coordinates": ["x", "y", "z", "w"],
        "constraints": ["x^2 + y^2 = 1/4", "dw = z dy"],
        "configuration": {"x": 0.5, "y": 0, "z": 0, "w": 0},
    }
    sampler = _sampler(scene)
    assert len(sampler.loops(0.25)) == 1
    assert sampler.stopped == []
    assert sampler.loops(0.8) == []
    (reason,) = sampler.stopped
    assert reason.startswith("The loop of y and z with radius 0.8 was not followed: ")


def test_no_other_fields_take_the_place_of_those_of_the_pivots() -> None:
    """Where both coefficients of the form vanish every direction is allowed, and fields of two pivots do not exist."""
    sampler = _sampler({"coordinates": ["x", "y", "z"], "constraints": ["x dz = y dx"], "configuration": {"x": 1}})
    assert sampler.fields(sampler.start).shape == (2, 3)
    with pytest.raises(np.linalg.LinAlgError):
        sampler.fields(sampler.relations.pose({}))


@pytest.mark.parametrize(("basis", "pivots"), [(np.eye(3), [0, 1]), (np.eye(3)[:2], [0, 2]), (np.eye(3)[:1], [0, 1])])
def test_fields_of_pivots_are_refused_where_a_pivot_cannot_move_alone(basis: Any, pivots: list[int]) -> None:
    with pytest.raises(np.linalg.LinAlgError):
        fields_of_pivots(basis, pivots)


def _held(name: str) -> None:
    system = lower(dofkit.load(name))
    ones = dict.fromkeys(system.parameters, 1.0)

    def numbers(path: Iterable[Mapping[str, float]]) -> Iterator[dict[Expr, float]]:
        symbols = {p: parameter(p) for p in system.parameters} | {"t": TIME}
        symbols |= {c.name: coordinate(c.name) for c in system.coordinates}
        return ({TIME: 0.0} | {symbols[n]: v for n, v in q.items()} for q in path)

    try:
        path = dofkit.configurations(system, steps=12, step=0.1, values=ones)
        assert system.generic or residual(system, numbers(path)) < 1e-9
        for loop in _sampler(name).loops(0.2):
            assert system.generic or residual(system, numbers(loop.configurations), chords=True) < 1e-9
    except NoMotionError:
        return


@pytest.mark.parametrize("name", [*NAMES[::16], "disc-rolling-on-plane"])
def test_constraints_hold_along_a_sampled_motion(name: str) -> None:
    _held(name)


@pytest.mark.sweep
@pytest.mark.parametrize("name", NAMES)
def test_constraints_hold_along_every_sampled_motion(name: str) -> None:
    _held(name)
