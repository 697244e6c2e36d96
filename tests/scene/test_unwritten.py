"""Equations of joints that are written out later: as many, and of the coordinates, as was said before."""

from __future__ import annotations

from typing import Any

import networkx as nx
import pytest

import dofkit
from dofkit.expressions.renaming import Unwritten
from dofkit.scene.lowering import lower
from dofkit.system import Constraint, Relation

AXES = ([0, 1, 0], [1, 2, 2], [3, 0, 4])
PLACES = ([0, 0, 0], [1, 2, 3], [0, 0, 5])
TYPES = ("revolute", "prismatic", "cylindrical", "universal", "spherical", "planar", "weld")
ENDS = (["a", "b"], ["b", "a"], ["ground", "a"], ["a", "ground"], ["ground", "b"])
FLAT = ("revolute", "prismatic", "weld")
FLAT_PLACES = ([0, 0], [1, 2], [1, 0], [0, 5])


def joint(kind: str, ends: list[str], at: list[int], axis: list[int]) -> dict[str, Any]:
    found: dict[str, Any] = {"type": kind, "between": ends}
    if kind not in ("prismatic", "weld"):
        found["at"] = at
    if kind == "universal":
        found["axes"] = [[1, 0, 0], [0, 3, 4]]
    elif kind not in ("spherical", "weld"):
        found["axis"] = axis
    return found


def flat_joint(kind: str, ends: list[str], at: list[int]) -> dict[str, Any]:
    more = {"revolute": {"at": at}, "prismatic": {"axis": [at[1], at[0] + 1]}, "weld": {}}
    return {"type": kind, "between": ends, **more[kind]}


def lowered(entry: dict[str, Any]) -> Constraint:
    where = {"x_b": 1, "y_b": 2, "z_b": 3}
    return lower(dofkit.load({"bodies": ["a", "b"], "configuration": where, "constraints": [entry]})).constraints[0]


def flat(entry: dict[str, Any], **configuration: Any) -> Constraint:
    scene = {"dimension": 2, "bodies": ["a", "b"], "configuration": configuration, "constraints": [entry]}
    return lower(dofkit.load(scene)).constraints[0]


def is_as_told(told: Unwritten[Relation]) -> None:
    """As many equations, of those coordinates, and none that shares none with the others."""
    mentioned = [{str(s.args[1]) for s in relation.expr.symbols} for relation in told]
    assert len(told) == len(mentioned) == told.number
    assert set().union(*mentioned) == told.mentioned
    assert nx.is_connected(nx.Graph((i, name) for i, own in enumerate(mentioned) for name in own))


@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("kind", TYPES)
def test_what_is_said_of_equations_before_they_are_written(kind: str, ends: list[str]) -> None:
    for at, axis in zip(PLACES, AXES, strict=True):
        told = lowered(joint(kind, ends, at, axis)).relations
        if isinstance(told, Unwritten):
            is_as_told(told)


@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("kind", FLAT)
def test_the_same_in_the_plane(kind: str, ends: list[str]) -> None:
    for at in FLAT_PLACES:
        for drawn in ({}, {"x_b": 1, "y_b": 2}, {"x_b": 1, "theta_b": "1/2"}):
            told = flat(flat_joint(kind, ends, at), **drawn).relations
            if isinstance(told, Unwritten):
                is_as_told(told)


def test_hinges_of_the_plane_are_not_written_but_where_they_fall_into_parts() -> None:
    """At both origins it is x_b = x_a and y_b = y_a, which share nothing; angles in roots or pi are put in at once."""
    pin = flat_joint("revolute", ["a", "b"], [0, 0])
    assert not isinstance(flat(pin).relations, Unwritten)
    assert isinstance(flat(pin, x_b=1).relations, Unwritten)
    assert not isinstance(flat(pin, x_b=1, theta_b="pi/6").relations, Unwritten)
    assert not isinstance(flat({**pin, "drive": "t"}, x_b=1).relations, Unwritten)
