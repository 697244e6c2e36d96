"""Many independent parts: the sum of the parts, and what is alike is answered once."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from shared.speed_scenes import discs, linked
from shared.work import calls_of

import dofkit
from dofkit.classification.freedom import branches as solving
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block
from dofkit.relations.setting import Setting


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, ...]]:
    """The coordinates of every block that is answered."""
    seen: list[tuple[str, ...]] = []
    plain = solving.in_time

    def counted(block: Block, setting: Setting) -> Answer:
        seen.append(block.coordinates)
        return plain(block, setting)

    monkeypatch.setattr(solving, "in_time", counted)
    return seen


def classified(**scene: Any) -> dofkit.Report:
    return dofkit.classify(dofkit.load(scene))


def test_discs_that_are_alike_are_answered_once(asked: list[tuple[str, ...]]) -> None:
    report = classified(**discs(12))
    assert len(asked) == 1
    assert (report.dof, report.velocity_dof, report.growth_vector) == (48, 24, [24, 36, 48])
    assert all(e.holonomic is False and e.verdict == "proved" for e in report.constraints)
    assert report.generalized_coordinates == discs(12)["coordinates"]


def chain(n: int) -> dict[str, Any]:
    """A chain of n links, its joints placed on a zigzag."""
    scene = linked([(k, k + 1) for k in range(n)])
    return {**scene, "particles": [{"name": name, "at": [k, k % 2]} for k, name in enumerate(scene["particles"])]}


@pytest.mark.parametrize("scene", [discs, chain])
def test_work_grows_with_the_number_of_parts_and_not_with_its_square(scene: Callable[[int], dict[str, Any]]) -> None:
    _, few, many = (calls_of(partial(classified, **scene(n))) for n in (20, 20, 200))  # once with cold caches
    assert many < 12 * few


def test_another_radius_is_another_block(asked: list[tuple[str, ...]]) -> None:
    scene = {**discs(2), "parameters": {"R": "positive", "S": "positive"}}
    scene["constraints"][2:] = [text.replace("R", "S") for text in scene["constraints"][2:]]
    classified(**scene)
    assert len(asked) == 2


def test_names_come_back(asked: list[tuple[str, ...]]) -> None:
    """x + y = t with xdot + ydot = z forces z = 1; each twin has its own hidden relation and its own integral."""
    names = [f"{q}{i}" for i in "ab" for q in "xyz"]
    texts = [text for i in "ab" for text in (f"x{i} + y{i} = t", f"x{i}dot + y{i}dot = z{i}")]
    report = classified(coordinates=names, constraints=texts)
    assert report.consistent
    assert report.dof == 2
    said = " ".join(report.warnings)
    assert "za" in said
    assert "zb" in said
    integrable = classified(coordinates=["x", "y", "u", "v"], constraints=["x dy + y dx = 0", "u dv + v du = 0"])
    assert [e.integral for e in integrable.constraints] == ["x*y = C", "u*v = C"]


def test_the_same_linkage_drawn_otherwise_is_another_block(asked: list[tuple[str, ...]]) -> None:
    """Three collinear joints with the ends held are shaky; bent they are rigid."""

    scene = {
        "dimension": 2,
        "particles": [{"name": "A", "at": [1, 0]}, {"name": "B", "at": [1, 11]}],
        "constraints": [
            {"type": "link", "between": [[0, 0], "A"]},
            {"type": "link", "between": ["A", [2, 0]]},
            {"type": "link", "between": [[0, 10], "B"]},
            {"type": "link", "between": ["B", [2, 10]]},
        ],
    }
    report = classified(**scene)
    assert len(asked) == 2
    assert (report.dof, report.instantaneous_dof, report.singular) == (0, 1, True)


def test_cost_is_the_sum_of_the_parts() -> None:
    """No part is seen together with another: the matrix of a block has its own columns only."""
    report = classified(**discs(3))
    assert "3 independent subsystems" in report.modelled
