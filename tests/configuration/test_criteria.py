"""The table of criteria: each row has cases in which it decides, and no earlier row; the truth is found by hand."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from flint import ctx
from shared.germs import on_plane, through
from shared.known_scenes import spread

import dofkit
from dofkit.classification.arguments import arguments
from dofkit.configuration.local import conclusions, criteria
from dofkit.configuration.local.criteria import CRITERIA, local_dimension
from dofkit.configuration.local.germ import Germ
from dofkit.configuration.local.manifold import LocalDimension, Manifold
from dofkit.exact.points.balls import PRECISION


class Case(NamedTuple):
    """Relations at a point; mu, the column of time, and the dimension of the set there as found by hand."""

    manifolds: list[Manifold]
    truth: int
    rigid: int = 0
    time: int | None = None


#: (key of the row, case)
CASES: list[tuple[str, Case]] = [
    ("independent relations", Case(through(["x^2 + y^2 - 1"], (1, 0)), 1)),
    ("independent relations", Case(through(["x^2 - y"], (0, 0)), 1, time=1)),
    ("rigid to first order", Case(through(["x", "y", "x + y"], (0, 0)), 0)),
    ("rigid to first order", Case(through(["y", "y + x y"], (0, 0)), 1, rigid=1)),  # the x axis, moved along itself
    ("zero along a curve", Case(through(["z", "2 z", "z (1 + x)"], (0, 0, 0)), 2)),
    ("zero along a curve", Case(through(["x", "z", "z + x y^3"], (0, 0, 0)), 1)),
    ("flat along a curve", Case(on_plane(2, "x^40 y^40"), 1)),  # of a higher degree than is examined
    ("flat along a curve", Case(through(["x + x^2 - y^5", "z", "z + x^4"], (0, 0, 0)), 0)),  # x about y^5: y^20 = 0
    ("isolated zero of one variable", Case(through(["x", "z", "z + y^3"], (0, 0, 0)), 0)),
    ("isolated zero of one variable", Case(on_plane(2, "y^2"), 1, rigid=1)),
    ("indefinite form", Case(on_plane(2, "x y"), 1)),
    ("indefinite form", Case(through(["z - y", "z - y - x^2 + y^2"], (0, 0, 0)), 1, time=1)),  # x = +-t
    ("definite form", Case(on_plane(2, "x^2 + y^2"), 0)),
    ("definite form", Case(through(["z - y", "z - y - x^2 - y^2"], (0, 0, 0)), 0, time=1)),
    ("definite combination", Case(on_plane(3, "x^2 + y^2 - z^2", "3 z^2 - x^2 - y^2"), 0)),  # 2 f_1 + f_2
    ("least along a motion", Case(on_plane(2, "(x - y^2)^2"), 1)),
    ("change of sign", Case(on_plane(2, "x^2 - y^3"), 1)),  # a cusp
    ("change of sign", Case(on_plane(2, "x^2 - y^4"), 1)),  # two parabolas that touch
    ("change of sign", Case(on_plane(2, "x^3 + y^3"), 1)),
    ("critical branch", Case(on_plane(3, "x^2", "y^2"), 1)),
    ("branch followed", Case(on_plane(3, "x y", "x z"), 2)),  # a plane and a line
]
KEYS = [criterion.key for criterion in CRITERIA]

#: Scenes in which a row decides, and the degrees of freedom there.
SCENES = [
    ("rigid to first order", "pentagon-with-all-diagonals", 3),
    ("zero along a curve", "double-banana", 7),
    ("isolated zero of one variable", "desargues-perspective", 3),
    ("indefinite form", "parallelogram-flattened", 1),
    ("definite form", "four-bar-stretched", 0),
    ("definite combination", "spherical-four-bar-stretched", 0),
    ("least along a motion", "platform-on-parallel-legs", 2),
    ("change of sign", "double-watt", 1),
    ("critical branch", "wren-platform", 1),
    ("branch followed", "miura-vertex-flat", 1),
]
ROOT = Path(__file__).parents[2]
FILES = {path.stem: path for folder in ("catalog", "tests/scenes") for path in ROOT.glob(f"{folder}/*/*.yaml")}


def decided(manifolds: list[Manifold], rigid: int, time: int | None) -> LocalDimension:
    with ctx.workprec(PRECISION):
        return local_dimension(Germ(*manifolds, rigid, time))


@pytest.mark.parametrize(("key", "case"), CASES, ids=[f"{key}-{i}" for i, (key, _) in enumerate(CASES)])
def test_a_row_decides_and_no_earlier_one(key: str, case: Case) -> None:
    told = decided(case.manifolds, case.rigid, case.time)
    (criterion,) = (row for row in CRITERIA if row.key == key)
    assert told.argument == key
    assert (told.dimension, told.verdict) == (None if told.verdict == "undecided" else case.truth, criterion.verdict)


def test_every_row_has_a_case() -> None:
    assert [key for key in KEYS if key in dict(CASES)] == KEYS
    assert len(set(KEYS)) == len(KEYS)


@pytest.mark.parametrize(("key", "case"), CASES, ids=[f"{key}-{i}" for i, (key, _) in enumerate(CASES)])
def test_balls_alone_are_no_surer_and_never_wrong(key: str, case: Case) -> None:
    with ctx.workprec(PRECISION):
        told = local_dimension(Germ(None, case.manifolds[1], case.rigid, case.time))
    assert told.dimension in (case.truth, None)
    assert told.verdict == ("numeric" if told.dimension is not None else "undecided")


@pytest.mark.parametrize(("key", "scene", "dof"), spread(SCENES, several=True))
def test_a_row_decides_in_a_scene(key: str, scene: str, dof: int, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str | None] = []

    def noted(germ: Germ, *rows: Any) -> Any:
        told = local_dimension(germ, *rows)
        asked.append(told.argument)
        return told

    monkeypatch.setattr(criteria, "local_dimension", noted)
    assert dofkit.classify(dofkit.load(FILES[scene])).dof == dof
    assert key in asked


# The table itself


def test_every_function_of_a_germ_is_in_the_table() -> None:
    """A criterion that no row asks would decide nothing."""
    used = {criterion.decide for criterion in CRITERIA}
    for name, f in inspect.getmembers(conclusions, inspect.isfunction):
        if f.__module__ == conclusions.__name__ and not name.startswith("_"):
            assert f in used, name


def test_every_decision_names_its_theorem() -> None:
    for criterion in CRITERIA:
        assert f"[{arguments()[criterion.key].theorem}]" in (criterion.decide.__doc__ or ""), criterion.key
