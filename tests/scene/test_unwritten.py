"""Equations of joints that are written out later: as many, and of the coordinates, as was said before."""

from __future__ import annotations

import pickle
from typing import Any

import networkx as nx
import pytest

import dofkit
from dofkit.expressions.unwritten import Unwritten
from dofkit.scene.lowering import lower
from dofkit.system import Constraint

AXES = ([0, 1, 0], [1, 2, 2], [3, 0, 4])
PLACES = ([0, 0, 0], [1, 2, 3], [0, 0, 5])
TYPES = ("revolute", "prismatic", "cylindrical", "universal", "spherical", "planar", "weld")


def joint(kind: str, ends: list[str], at: list[int], axis: list[int]) -> dict[str, Any]:
    found: dict[str, Any] = {"type": kind, "between": ends}
    if kind not in ("prismatic", "weld"):
        found["at"] = at
    if kind == "universal":
        found["axes"] = [[1, 0, 0], [0, 3, 4]]
    elif kind not in ("spherical", "weld"):
        found["axis"] = axis
    return found


def lowered(entry: dict[str, Any]) -> Constraint:
    where = {"x_b": 1, "y_b": 2, "z_b": 3}
    return lower(dofkit.load({"bodies": ["a", "b"], "configuration": where, "constraints": [entry]})).constraints[0]


@pytest.mark.parametrize("ends", [["a", "b"], ["b", "a"], ["ground", "a"], ["a", "ground"], ["ground", "b"]])
@pytest.mark.parametrize("kind", TYPES)
def test_what_is_said_of_equations_before_they_are_written(kind: str, ends: list[str]) -> None:
    for at, axis in zip(PLACES, AXES, strict=True):
        told = lowered(joint(kind, ends, at, axis)).relations
        if not isinstance(told, Unwritten):
            continue
        mentioned = [{str(s.args[1]) for s in relation.expr.symbols} for relation in told]
        assert len(told) == len(mentioned) == told.number
        assert set().union(*mentioned) == told.mentioned
        graph = nx.Graph((i, name) for i, own in enumerate(mentioned) for name in own)
        assert nx.is_connected(graph)


def test_hinges_between_bodies_are_not_written_and_come_out_of_a_pickle_written() -> None:
    told = lowered(joint("revolute", ["a", "b"], [1, 2, 3], [0, 0, 1])).relations
    assert isinstance(told, Unwritten)
    assert "written" not in vars(told)
    again = pickle.loads(pickle.dumps(told))
    assert again == tuple(told) == told
    assert len(again) == 5


def test_what_is_driven_is_written() -> None:
    driven = joint("revolute", ["a", "b"], [1, 2, 3], [0, 0, 1]) | {"drive": "t"}
    assert not isinstance(lowered(driven).relations, Unwritten)
