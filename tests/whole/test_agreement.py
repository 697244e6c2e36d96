"""Every way to count freedom agrees with every other, on random frameworks and bodies where both are sound."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction

import pytest
from shared.known_scenes import swept

import dofkit
from dofkit.benchmark.trials.frameworks import Framework, RandomBodies, dependent, graph, loop, tree
from dofkit.methods.table import ENGINES, MethodName
from dofkit.report import Report

DIMENSIONS = (1, 2, 3)
Draw = Callable[[random.Random, int, int], RandomBodies]
#: dofkit's own engines, together and alone.
BY_ENGINES = tuple(ENGINES)
#: How many are drawn, and in the sweep.
FEW, MANY = 8, 60
every_dimension = pytest.mark.parametrize(
    ("dimension", "many"), [case for d in DIMENSIONS for case in ((d, FEW), swept(d, MANY))]
)


def classified(scene: dict[str, object], method: MethodName = "auto") -> Report:
    return dofkit.classify(dofkit.load(dict(scene)), method=method)


@every_dimension
def test_scenes_agree_with_the_graph_in_general_position(dimension: int, many: int) -> None:
    """Without positions, and with random ones; by both engines and by each alone."""
    rng = random.Random(f"scenes {dimension}")
    for _ in range(many):
        drawn = graph(rng, dimension, rng.randrange(2, 7))
        redundant = [f"bar{i}" for i in dependent(drawn)]
        dof = drawn.by_rank()
        for scene in (drawn.scene(drawn=False), drawn.scene()):
            for method in BY_ENGINES:
                report = classified(scene, method)
                assert (report.dof, report.velocity_dof) == (dof, dof)
                assert sorted(report.redundant, key=lambda name: int(name[3:])) == redundant
                assert report.redundant_equations == len(redundant)
                assert report.consistent is not False
        assert (report.instantaneous_dof, report.singular) == (dof, False)


def coarse(rng: random.Random, drawn: Framework) -> Framework:
    """Return the same bars between different points of a small grid: many are in line, parallel or in one plane."""
    grid = 3 if drawn.dimension > 1 else 20
    while True:
        joints = {name: tuple(Fraction(rng.randrange(grid)) for _ in p) for name, p in drawn.joints.items()}
        if len(set(joints.values())) == len(joints):
            return Framework(joints, (), drawn.bars)


@pytest.mark.parametrize(("dimension", "many"), [(1, FEW), (2, FEW), *(swept(d, MANY) for d in DIMENSIONS)])
def test_special_positions(dimension: int, many: int) -> None:
    """On a small grid: velocities by the exact rank; at most so much freedom, by each engine."""
    rng = random.Random(f"grid {dimension}")
    undecided = 0
    for _ in range(many):
        drawn = coarse(rng, graph(rng, dimension, rng.randrange(3, 7)))
        first = drawn.by_rank()
        reports = [classified(drawn.scene(), method) for method in BY_ENGINES]
        assert [r.instantaneous_dof for r in reports] == [first] * len(reports)
        known = {r.dof for r in reports if r.dof is not None}
        assert len(known) <= 1
        undecided += reports[0].dof is None
        for dof in known:
            assert 0 <= dof <= first  # over the reals one equation may remove several freedoms: three points in line
            assert dof == first or dependent(drawn)
    assert undecided <= many // 6


def agrees(bodies: RandomBodies) -> None:
    report = classified(bodies.scene)
    assert report.instantaneous_dof == bodies.first
    assert report.count is not None
    assert report.count.naive_dof == bodies.coordinates - bodies.equations
    if bodies.dof is not None:
        assert (report.dof, report.singular) == (bodies.dof, False)
        assert report.redundant_equations == bodies.equations - (bodies.coordinates - bodies.dof)
    elif report.dof is not None:
        assert bodies.coordinates - bodies.equations <= report.dof <= bodies.first


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("make", [tree, loop])
@pytest.mark.parametrize("many", [FEW, swept(MANY)])
def test_trees_and_loops_of_bodies(make: Draw, dimension: int, many: int) -> None:
    rng = random.Random(f"{make.__name__} {dimension}")
    for _ in range(many):
        agrees(make(rng, dimension, rng.randrange(1, 7)))
